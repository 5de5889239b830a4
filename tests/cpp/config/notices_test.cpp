// What a user is told of values that are sound but unusual.
#include "config/notices.hpp"

#include <array>

#include "case_messages.hpp"
#include "config/changed_defaults.hpp"
#include "config/declaration.hpp"
#include "config/describe.hpp"
#include "config/strips.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

std::vector<std::string> without_folder(std::vector<std::string> notices) {
  const std::string folder = testing_support::folder_of_this_test().string();
  for (std::string& notice : notices) {
    if (const std::size_t at = notice.find(folder); at != std::string::npos) {
      notice.replace(at, folder.size(), "FOLDER");
    }
  }
  return notices;
}

std::vector<std::string> notices_of(const std::string& of_material) {
  const Case found = testing_support::case_from_text(changed(
      {{"law = \"elastic\"", "friction_angle = 40.0\ncohesion = 1e6\n" + of_material + "\ngaps_close_first = true"},
       {"[basal]", "[block]\nbends = true\n[heat]\nenabled = false\n[basal]"}}));
  return without_folder(notices(found));
}

TEST(Notices, WarnOfUnusualBrokenMaterial) {
  EXPECT_EQ(
      notices_of("residual_cohesion = 6e4\nresidual_friction_angle = 12.0\nsoftening_strain = 0.5"),
      (std::vector<std::string>{
          "FOLDER/case.toml:14:21: material.rock.residual_cohesion is 60000 Pa, outside the usual 0 to 50000 Pa of "
          "broken rock and ice (not checked)",
          "FOLDER/case.toml:15:27: material.rock.residual_friction_angle is 12 degrees, outside the usual 20 to 35 "
          "degrees of broken rock and ice (not checked)",
          "FOLDER/case.toml:16:20: material.rock.softening_strain is 0.5, outside the usual 0.005 to 0.05 of broken "
          "rock and ice (not checked)"}));
}

TEST(Notices, AcceptUsualBrokenMaterialAndThePaper) {
  const std::vector<std::string> none;
  EXPECT_EQ(notices_of("residual_cohesion = 1e4\nresidual_friction_angle = 25.0\nsoftening_strain = 0.02"), none);
  EXPECT_EQ(notices_of("residual_cohesion = 1e4\nresidual_friction_angle = 25.0\nsoftening_slip = 3.0"), none);
  EXPECT_EQ(notices_of("residual_cohesion = 1e5\nsoftening_strain = 1.0"), none) << "the paper's";
  EXPECT_EQ(notices_of("softening_strain = 0.5"), none) << "nothing softens";
}

// A base with band columns, bonds and a glacier, all of usual numbers.
const std::vector<Change> with_columns{
    {"law = \"elastic\"", "law = \"elastic\"\nhydraulic_conductivity = 1e-7"},
    {"[basal]",
     "[band]\nthickness = 0.5\n[substrate.ice]\nx_min = 50.0\nfriction = \"coefficient\"\nfriction_coefficient = "
     "0.1\n[basal]\ncohesion = 1e5\ncohesion_law = \"bonds\"\nslip_distance = 20.0"}};

TEST(Notices, TellOfAnUnusualBase) {
  const std::vector<std::string> none;
  // Key, what is given, and what the notice says after "KEY is ".
  const std::vector<std::array<std::string, 3>> unusual{
      {"band.thickness", "5.0", "5 m, outside the usual 0.01 to 2 m (not checked)"},
      {"band.thickness", "60", "60 m, outside the usual 0.01 to 2 m (not checked)"},
      {"band.thickness", "{time = [0, 1], value = [0.5, 3]}", "3 m, outside the usual 0.01 to 2 m (not checked)"},
      {"band.load_time", "1000.0", "1000 s, outside the usual 0.1 to 10 s (not checked)"},
      {"band.column_step", "100.0", "100 s, outside the usual 0.001 to 0.5 s (not checked)"},
      {"basal.heat_fraction", "0.1", "0.1, outside the usual 0.8 to 1 (not checked)"},
      {"basal.slip_distance", "5000.0", "5000 m, outside the usual 1 to 100 m of bonds (not checked)"},
      {"material.rock.hydraulic_conductivity", "1e-2",
       "0.01 m/s, outside the usual 1e-08 to 1e-05 m/s of a base (not checked)"},
      {"pressure.skeleton_compressibility", "1e-3", "0.001 1/Pa, outside the usual 1e-09 to 1e-07 1/Pa (not checked)"},
      {"substrate.ice.friction_coefficient", "0.6", "0.6, outside the usual 0.05 to 0.15 on a glacier (not checked)"}};
  const std::string known = "pressure.frozen=none";  // else one of defaults that have moved joins
  const std::string text = changed(with_columns);
  EXPECT_EQ(notices(testing_support::case_from_text(text, {known})), none);
  for (const auto& [key, value, said] : unusual) {
    const std::string set = key + "=" + value;
    EXPECT_EQ(notices(testing_support::case_from_text(text, {known, set})),
              std::vector<std::string>{"--set " + set + ": " + key + " is " + said});
  }
}

TEST(Notices, LeaveOutWhatTheBaseDoesNotHave) {
  const std::vector<std::string> none;
  const std::string text = changed(with_columns);
  const auto notices_with = [&](std::vector<std::string> sets) {
    sets.emplace_back("pressure.frozen=none");
    return notices(testing_support::case_from_text(text, sets));
  };
  EXPECT_EQ(notices_with({"basal.cohesion=0", "basal.slip_distance=5000"}), none) << "nothing to lose";
  EXPECT_EQ(notices_with({"basal.cohesion_law=slip", "basal.slip_distance=5000"}), none) << "not of bonds";
  EXPECT_EQ(notices_with({"band.model=scaled", "band.thickness=5", "basal.heat_fraction=0.35",
                          "basal.slip_distance=300", "pressure.skeleton_compressibility=0",
                          "material.rock.hydraulic_conductivity=1e-4", "substrate.ice.friction_coefficient=0.6"}),
            none)
      << "the paper's band is no column";
}

TEST(Notices, DoubtTheNumbersOfVoellmyFriction) {
  const auto found = [](const std::string& key, const std::string& value) {
    std::vector<std::string> sets{"pressure.frozen=none", "basal.friction=voellmy", "basal.friction_coefficient=0.6",
                                  "basal.turbulent_friction=500", "basal.friction_angle=0.6"};
    if (!key.empty()) {
      sets.push_back("basal." + key + "=" + value);
    }
    return notices(testing_support::case_from_text(changed(with_columns), sets));
  };
  using List = std::vector<std::string>;
  EXPECT_EQ(found("", ""), List()) << "0.6 is no glacier's, and the angle is not that of this law";
  EXPECT_EQ(
      found("turbulent_friction", "0.5"),
      List{"--set basal.turbulent_friction=0.5: basal.turbulent_friction is 0.5 m/s2: calibrated values of xi are "
           "100 to 10000 m/s2."});
  EXPECT_EQ(found("turbulent_friction", "1e5").size(), 1U);
  EXPECT_EQ(
      found("friction_coefficient", "25"),
      List{"--set basal.friction_coefficient=25: basal.friction_coefficient is 25: was an angle in degrees meant? "
           "A coefficient is its tangent: 25 degrees are 0.466."});
}

TEST(Notices, DoubtWhatIsMostLikelyNotMeant) {
  // Key, what is given, and what the notice says after "KEY is ".
  const std::vector<std::array<std::string, 3>> questionable{
      {"material.rock.youngs_modulus", "0.5",
       "0.5 Pa: too soft: the slide collapses under its own weight. Broken rock and ice have 1e7 Pa and more."},
      {"material.rock.youngs_modulus", "1e12",
       "1000000000000 Pa: stiffer than any rock, which shortens the time step. Usual for slides are 1e8 to 1e10 Pa."},
      {"basal.friction_angle", "0.6",
       "0.6 degrees: was a coefficient meant? Angles are in degrees; for a coefficient set friction = \"coefficient\" "
       "and friction_coefficient."},
      {"body.block.temperature", "5.0",
       "5 C: its pores hold water from the start, no ice. Was a temperature below 0 meant?"},
      {"time.output_interval", "1000",
       "1000 s: longer than the run of 1 s, which leaves a snapshot of its start and one of its end."},
      {"phases.rock_density", "2.7", "2.7 kg/m3: if it is in g/cm3, it is 2700 kg/m3."},
      {"phases.rock_density", "27000", "27000 kg/m3: the grains of rock have 2000 to 3600 kg/m3."},
      {"phases.ice_density", "0.9", "0.9 kg/m3: if it is in g/cm3, it is 900 kg/m3."},
      {"phases.water_density", "100", "100 kg/m3: water has 950 to 1300 kg/m3."},
      {"case.gravity", "98.1", "98.1 m/s2: on Earth it is 9.81 m/s2."},
      {"time.step", "1e-12",
       "1e-12 s: that is 1e+12 steps, from days to years of computing. `thawslide check` estimates the time and prints "
       "the limit of the step."},
      {"checkpoint.interval", "50",
       "50 s: longer than the run of 1 s, which leaves the checkpoints of checkpoint.wall_interval."},
      {"checkpoint.interval", "1e-8",
       "1e-08 s: no longer than the step of 0.001 s: a checkpoint every step takes longer than the step. "
       "Set checkpoint.wall_interval to write them by wall-clock time."},
      {"checkpoint.wall_interval", "1e-9",
       "1e-09 s: so often most of the time goes into checkpoints; usual is a minute to an hour."},
      {"time.history_interval", "2",
       "2 s: longer than the run of 1 s: history.csv gets a row of its start and one of its end."}};
  const std::string known = "pressure.frozen=none", text = changed(with_columns);
  for (const auto& [key, value, said] : questionable) {
    const std::string set = key + "=" + value;
    EXPECT_EQ(notices(testing_support::case_from_text(text, {known, "time.end=1", set})),
              std::vector<std::string>{"--set " + set + ": " + key + " is " + said});
  }
}

// A time at rest that no run of that length has, be it given or its default.
TEST(Notices, DoubtARestThatNeverCounts) {
  const std::string text = changed(with_columns);
  const std::vector<std::string> stops{"pressure.frozen=none", "time.end=5", "time.stop_at_rest=0.1"};
  const auto said = [&](const std::string& rest) {
    std::vector<std::string> sets = stops;
    sets.insert(sets.end(), rest.empty() ? 0 : 1, rest);
    return without_folder(notices(testing_support::case_from_text(text, sets)));
  };
  EXPECT_EQ(said("time.rest_time=2"), std::vector<std::string>{});
  EXPECT_EQ(said("time.rest_time=6"),
            std::vector<std::string>{"--set time.rest_time=6: time.rest_time is 6 s: longer than the run of 5 s, which "
                                     "then never stops at rest."});
  EXPECT_EQ(said(""),
            std::vector<std::string>{"FOLDER/case.toml: time.rest_time is 10 s: longer than the run of 5 s, which then "
                                     "never stops at rest."});
}

// A short trial of a case that stops at rest causes no warning. An end in the file that is too early causes one.
TEST(Notices, LeaveAShortTrialOfACaseThatStopsAtRestAlone) {
  const Change rests{"end = 2.0", "end = 2.0\nstop_at_rest = 0.1\nrest_time = 20.0"};
  const std::string text = changed({with_columns[0], with_columns[1], rests});
  const auto said = [&](const std::string& set) {
    return notices(testing_support::case_from_text(text, {"pressure.frozen=none", set}));
  };
  EXPECT_EQ(said("time.end=5"), std::vector<std::string>{});
  EXPECT_EQ(said("time.step=0.001").size(), 1U) << "the file's own end is too early";
}

// A default that is hardly ever meant; whoever writes 0 has thought of it.
TEST(Notices, DoubtADefaultWithoutDrainage) {
  const std::string known = "pressure.frozen=none";
  const std::string text =
      changed({with_columns[1], {"law = \"elastic\"", "law = \"elastic\"\ngaps_close_first = true"}});
  const std::string file = "FOLDER/case.toml";
  EXPECT_EQ(
      without_folder(notices(testing_support::case_from_text(text, {known}))),
      std::vector<std::string>{
          file + ": material.rock.hydraulic_conductivity is 0 m/s, its default: pore water cannot drain, and the "
                 "avalanche may never stop. Typical values at the base are 1e-8 to 1e-5 m/s. Set a value, or set 0 "
                 "explicitly to silence this warning."});
  const std::vector<std::string> none;
  EXPECT_EQ(notices(testing_support::case_from_text(text, {known, "material.rock.hydraulic_conductivity=0"})), none);
  EXPECT_EQ(notices(testing_support::case_from_text(text, {known, "mechanisms.pressurization=false"})), none)
      << "nothing is under pressure";
}

// Nothing is written more than once a step.
TEST(Notices, CountSnapshotsByTheStepsThereAre) {
  const std::string text = changed(with_columns);
  const std::vector<std::string> sets{"pressure.frozen=none", "time.end=1", "time.output_interval=1e-6"};
  const std::vector<std::string> none;
  EXPECT_EQ(notices(testing_support::case_from_text(text, sets)), none) << "1001 steps";
  std::vector<std::string> finer = sets;
  finer.emplace_back("time.step=5e-5");
  EXPECT_EQ(notices(testing_support::case_from_text(text, finer)),
            std::vector<std::string>{"--set time.output_interval=1e-6: time.output_interval is 1e-06 s: that is 20000 "
                                     "snapshots, each a file, too many for a folder or an animation."});
}

TEST(Notices, DoubtWaterInTheGroundOfACaseWithoutHeatToo) {
  const std::string text = changed(with_columns);
  EXPECT_EQ(notices(testing_support::case_from_text(
                text, {"heat.enabled=false", "band.model=scaled", "body.block.temperature=5"})),
            std::vector<std::string>{"--set body.block.temperature=5: body.block.temperature is 5 C: its pores hold "
                                     "water from the start, no ice. Was a temperature below 0 meant?"});
}

// The case of a run's folder has every default written out, and says which were given.
TEST(Notices, DoubtADefaultOfAResolvedCaseToo) {
  const std::string known = "pressure.frozen=none";
  const std::string text =
      changed({with_columns[1], {"law = \"elastic\"", "law = \"elastic\"\ngaps_close_first = true"}});
  for (const std::string given : {"", "hydraulic_conductivity = 0.0\n"}) {
    const std::string first = changed({{"gaps_close_first", given + "gaps_close_first"}}, text);
    const std::string resolved = resolved_toml(testing_support::case_from_text(first, {known}), "inputs");
    const Case again = testing_support::case_from_text(resolved);
    EXPECT_EQ(resolved_toml(again, "inputs"), resolved);
    const std::vector<std::string> found = notices(again);
    ASSERT_EQ(found.size(), given.empty() ? 1U : 0U);
    if (given.empty()) {
      EXPECT_NE(found[0].find("material.rock.hydraulic_conductivity is 0 m/s, its default: pore water cannot drain"),
                std::string::npos);
    }
  }
}

TEST(Notices, DoubtABaseWithoutABand) {
  const std::string text = changed({{"law = \"elastic\"", "law = \"elastic\"\nhydraulic_conductivity = 1e-7"}});
  const std::string known = "pressure.frozen=none";
  EXPECT_EQ(without_folder(notices(testing_support::case_from_text(text, {known}))),
            std::vector<std::string>{
                "FOLDER/case.toml: band.thickness is not given: friction then heats the lowest cells as a whole, 5 m "
                "thick, which barely warm or melt. Give the thickness of what shears at the base: usual is 0.01 to 2 "
                "m. If nothing is to melt, set heat.enabled = false."});
  const std::vector<std::string> none;
  EXPECT_EQ(notices(testing_support::case_from_text(text, {"heat.enabled=false"})), none);
  EXPECT_EQ(notices(testing_support::case_from_text(text, {known, "basal.heat_fraction=0"})), none);
}

TEST(Notices, DoubtABed) {
  const std::string text = changed(with_columns) +
                           "[bed]\nlaw = \"momentum\"\ndepth = 1.0\nstrength = 1e3\n"
                           "depth_per_slip = 0.1\nmaterial = \"rock\"\n";
  EXPECT_EQ(notices(testing_support::case_from_text(text, {"pressure.frozen=none", "bed.temperature=4"})),
            std::vector<std::string>{"--set bed.temperature=4: bed.temperature is 4 C: the bed's pores hold water, no "
                                     "ice. Was a temperature below 0 meant?"});
  EXPECT_EQ(notices(testing_support::case_from_text(text, {"pressure.frozen=none", "bed.friction_angle=0.1"})),
            std::vector<std::string>{"--set bed.friction_angle=0.1: bed.friction_angle is 0.1 degrees: was a "
                                     "coefficient meant? Angles are in degrees; 6 is a coefficient of 0.1."});
}

TEST(Notices, TellOfGapsBetweenSubstrates) {
  const Case found = testing_support::case_from_text(
      changed({{"[basal]",
                "[substrate.ice]\nx_max = 50.0\nfriction_angle = 5.0\n[substrate.snow]\nx_min = 60.0\nfriction_angle = "
                "5.0\n[basal]"}}),
      {"block.bends=true", "heat.enabled=false"});
  EXPECT_EQ(notices(found), warnings_of_gaps(found));
  EXPECT_EQ(notices(found).size(), 1U);
}

const std::vector<Change> with_band{{"[basal]", "[band]\nthickness = 0.1\n[basal]"},
                                    {"law = \"elastic\"",
                                     "friction_angle = 35.0\ncohesion = 1e6\nresidual_cohesion = 1e4\nsoftening_strain "
                                     "= 0.05\nhydraulic_conductivity = 1e-7"}};

TEST(Notices, OneTellsAFileOfEarlierVersionsWhatChanged) {
  const Case found = testing_support::case_from_text(changed(with_band));
  EXPECT_EQ(
      without_folder(notices(found)),
      (std::vector<std::string>{
          "FOLDER/case.toml: defaults of these keys have changed, and the file sets none of them:\n"
          "  band.model = \"columns\"  # was \"scaled\"\n"
          "  band.thickness_change = \"conserving\"  # was \"as_printed\"\n"
          "  heat.advection_form = \"conservative\"  # was \"as_printed\"\n"
          "  pressure.frozen = \"none\"  # was \"ice_pressure\"\n"
          "  pressure.frozen_rows = \"sealed\"  # was \"draining\"\n"
          "  pressure.melt_contraction = true  # was false\n"
          "  pressure.skeleton_compressibility = 2e-09  # was 0.0\n"
          "  phases.water_expansion_law = \"by_temperature\"  # was \"constant\"\n"
          "  material.NAME.gaps_close_first = true  # was false\n"
          "  The comments show the earlier values; setting them restores the earlier results. Set one of the keys to "
          "silence this warning (docs/choosing-the-base.md)."}));
}

TEST(Notices, SayNothingOfDefaultsWhereOneIsGivenOrNoneIsFelt) {
  const std::vector<std::string> none;
  for (const ChangedDefault& moved : changed_defaults()) {
    const std::string table = moved.table == "material.NAME" ? "material.rock" : moved.table;
    const Case found = testing_support::case_from_text(changed(with_band), {table + "." + moved.key + "=" + moved.now});
    EXPECT_EQ(notices(found), none) << moved.key;
  }
  EXPECT_EQ(notices(testing_support::case_from_text(sound, {"heat.enabled=false"})), none);
}

// What the notice says of the present is what the declarations say.
TEST(Notices, NameThePresentDefaults) {
  for (const ChangedDefault& moved : changed_defaults()) {
    bool is_found = false;
    for (const auto& table : tables()) {
      for (const Entry& entry : table->entries()) {
        if ((table->is_named() ? table->name + ".NAME" : table->name) == moved.table && entry.rule->key == moved.key) {
          is_found = true;
          EXPECT_TRUE(entry.default_text == moved.now || entry.otherwise.rfind(moved.now, 0) == 0) << moved.key;
        }
      }
    }
    EXPECT_TRUE(is_found) << moved.table << "." << moved.key;
  }
}

}  // namespace
}  // namespace thawslide::config
