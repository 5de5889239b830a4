// Warnings about values that are valid but unusual.
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
  EXPECT_EQ(notices_of("residual_cohesion = 6e4\nresidual_friction_angle = 12.0\nsoftening_strain = 0.5"),
            (std::vector<std::string>{"FOLDER/case.toml:14:21: material.rock.residual_cohesion is 60000 Pa, outside "
                                      "the usual 0 to 50000 Pa for broken rock and ice (not checked)",
                                      "FOLDER/case.toml:15:27: material.rock.residual_friction_angle is 12 degrees, "
                                      "outside the usual 20 to 35 degrees for broken rock and ice (not checked)",
                                      "FOLDER/case.toml:16:20: material.rock.softening_strain is 0.5, outside the "
                                      "usual 0.005 to 0.05 for broken rock and ice (not checked)"}));
}

TEST(Notices, AcceptUsualBrokenMaterialAndThePaper) {
  const std::vector<std::string> none;
  EXPECT_EQ(notices_of("residual_cohesion = 1e4\nresidual_friction_angle = 25.0\nsoftening_strain = 0.02"), none);
  EXPECT_EQ(notices_of("residual_cohesion = 1e4\nresidual_friction_angle = 25.0\nsoftening_slip = 3.0"), none);
  EXPECT_EQ(notices_of("residual_cohesion = 1e5\nsoftening_strain = 1.0"), none) << "the paper's";
  EXPECT_EQ(notices_of("softening_strain = 0.5"), none) << "no softening";
}

// A base with band columns, bonds and a glacier, with usual values only.
const std::vector<Change> with_columns{
    {"law = \"elastic\"", "law = \"elastic\"\nhydraulic_conductivity = 1e-7"},
    {"[basal]",
     "[band]\nthickness = 0.5\n[substrate.ice]\nx_min = 50.0\nfriction = \"coefficient\"\nfriction_coefficient = "
     "0.1\n[basal]\ncohesion = 1e5\ncohesion_law = \"bonds\"\nslip_distance = 20.0"}};

TEST(Notices, WarnOfAnUnusualBase) {
  const std::vector<std::string> none;
  // Key, given value, and the warning after "KEY is ".
  const std::vector<std::array<std::string, 3>> unusual{
      {"band.thickness", "5.0", "5 m, outside the usual 0.01 to 2 m (not checked)"},
      {"band.thickness", "60", "60 m, outside the usual 0.01 to 2 m (not checked)"},
      {"band.thickness", "{time = [0, 1], value = [0.5, 3]}", "3 m, outside the usual 0.01 to 2 m (not checked)"},
      {"band.load_time", "1000.0", "1000 s, outside the usual 0.1 to 10 s (not checked)"},
      {"band.column_step", "100.0", "100 s, outside the usual 0.001 to 0.5 s (not checked)"},
      {"basal.heat_fraction", "0.1", "0.1, outside the usual 0.8 to 1 (not checked)"},
      {"basal.slip_distance", "5000.0", "5000 m, outside the usual 1 to 100 m for ice bonds (not checked)"},
      {"material.rock.hydraulic_conductivity", "1e-2",
       "0.01 m/s, outside the usual 1e-08 to 1e-05 m/s at the base (not checked)"},
      {"pressure.skeleton_compressibility", "1e-3", "0.001 1/Pa, outside the usual 1e-09 to 1e-07 1/Pa (not checked)"},
      {"substrate.ice.friction_coefficient", "0.6", "0.6, outside the usual 0.05 to 0.15 on a glacier (not checked)"}};
  const std::string known = "pressure.frozen=none";  // otherwise the warning about changed defaults is added
  const std::string text = changed(with_columns);
  EXPECT_EQ(notices(testing_support::case_from_text(text, {known})), none);
  for (const auto& [key, value, expected] : unusual) {
    const std::string set = key + "=" + value;
    EXPECT_EQ(notices(testing_support::case_from_text(text, {known, set})),
              std::vector<std::string>{"--set " + set + ": " + key + " is " + expected});
  }
}

TEST(Notices, IgnoreMechanismsThatTheBaseLacks) {
  const std::vector<std::string> none;
  const std::string text = changed(with_columns);
  const auto notices_with = [&](std::vector<std::string> sets) {
    sets.emplace_back("pressure.frozen=none");
    return notices(testing_support::case_from_text(text, sets));
  };
  EXPECT_EQ(notices_with({"basal.cohesion=0", "basal.slip_distance=5000"}), none) << "without cohesion";
  EXPECT_EQ(notices_with({"basal.cohesion_law=slip", "basal.slip_distance=5000"}), none) << "does not apply to bonds";
  EXPECT_EQ(notices_with({"band.model=scaled", "band.thickness=5", "basal.heat_fraction=0.35",
                          "basal.slip_distance=300", "pressure.skeleton_compressibility=0",
                          "material.rock.hydraulic_conductivity=1e-4", "substrate.ice.friction_coefficient=0.6"}),
            none)
      << "the band of the paper has no columns";
}

TEST(Notices, WarnOfUnusualVoellmyFriction) {
  const auto found = [](const std::string& key, const std::string& value) {
    std::vector<std::string> sets{"pressure.frozen=none", "basal.friction=voellmy", "basal.friction_coefficient=0.6",
                                  "basal.turbulent_friction=500", "basal.friction_angle=0.6"};
    if (!key.empty()) {
      sets.push_back("basal." + key + "=" + value);
    }
    return notices(testing_support::case_from_text(changed(with_columns), sets));
  };
  using List = std::vector<std::string>;
  EXPECT_EQ(found("", ""), List()) << "0.6 is not on a glacier, and this law has no angle";
  EXPECT_EQ(
      found("turbulent_friction", "0.5"),
      List{"--set basal.turbulent_friction=0.5: basal.turbulent_friction is 0.5 m/s2: calibrated values of xi are "
           "100 to 10,000 m/s2."});
  EXPECT_EQ(found("turbulent_friction", "1e5").size(), 1U);
  EXPECT_EQ(
      found("friction_coefficient", "25"),
      List{"--set basal.friction_coefficient=25: basal.friction_coefficient is 25: was an angle in degrees meant? "
           "A coefficient is its tangent: 25 degrees are 0.466."});
}

TEST(Notices, WarnOfProbablyUnintendedValues) {
  // Key, given value, and the warning after "KEY is ".
  const std::vector<std::array<std::string, 3>> questionable{
      {"material.rock.youngs_modulus", "0.5",
       "0.5 Pa: too soft: the slide collapses under its own weight. Typical values for broken rock and ice are 1e7 Pa "
       "or more."},
      {"material.rock.youngs_modulus", "1e12",
       "1000000000000 Pa: stiffer than any rock, which shortens the time step. Typical values for slides are 1e8 to "
       "1e10 Pa."},
      {"basal.friction_angle", "0.6",
       "0.6 degrees: was a coefficient meant? Angles are in degrees; for a coefficient set friction = \"coefficient\" "
       "and friction_coefficient."},
      {"body.block.temperature", "5.0",
       "5 C: its pores contain water and no ice from the start. Was a temperature below 0 meant?"},
      {"time.output_interval", "1000",
       "1000 s: longer than the run of 1 s, which leaves only the first and the last snapshot."},
      {"phases.rock_density", "2.7", "2.7 kg/m3: if it is in g/cm3, it is 2,700 kg/m3."},
      {"phases.rock_density", "27000", "27000 kg/m3: the grains of rock have 2,000 to 3,600 kg/m3."},
      {"phases.ice_density", "0.9", "0.9 kg/m3: if it is in g/cm3, it is 900 kg/m3."},
      {"phases.water_density", "100", "100 kg/m3: water has 950 to 1,300 kg/m3."},
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
       "1e-09 s: checkpoints this frequent take most of the run time; typical values are a minute to an hour."},
      {"time.history_interval", "2",
       "2 s: longer than the run of 1 s: history.csv then contains only its first and last rows."}};
  const std::string known = "pressure.frozen=none", text = changed(with_columns);
  for (const auto& [key, value, expected] : questionable) {
    const std::string set = key + "=" + value;
    EXPECT_EQ(notices(testing_support::case_from_text(text, {known, "time.end=1", set})),
              std::vector<std::string>{"--set " + set + ": " + key + " is " + expected});
  }
}

// A rest time longer than the run, given or by default.
TEST(Notices, WarnOfARestTimeLongerThanTheRun) {
  const std::string text = changed(with_columns);
  const std::vector<std::string> stops{"pressure.frozen=none", "time.end=5", "time.stop_at_rest=0.1"};
  const auto notices_with = [&](const std::string& rest) {
    std::vector<std::string> sets = stops;
    sets.insert(sets.end(), rest.empty() ? 0 : 1, rest);
    return without_folder(notices(testing_support::case_from_text(text, sets)));
  };
  EXPECT_EQ(notices_with("time.rest_time=2"), std::vector<std::string>{});
  EXPECT_EQ(notices_with("time.rest_time=6"),
            std::vector<std::string>{"--set time.rest_time=6: time.rest_time is 6 s: longer than the run of 5 s, which "
                                     "then never stops at rest."});
  EXPECT_EQ(notices_with(""),
            std::vector<std::string>{"FOLDER/case.toml: time.rest_time is 10 s: longer than the run of 5 s, which then "
                                     "never stops at rest."});
}

// A short trial of a case that stops at rest causes no warning. An end in the file that is too early causes one.
TEST(Notices, IgnoreAShortTrialOfACaseThatStopsAtRest) {
  const Change rests{"end = 2.0", "end = 2.0\nstop_at_rest = 0.1\nrest_time = 20.0"};
  const std::string text = changed({with_columns[0], with_columns[1], rests});
  const auto notices_with = [&](const std::string& set) {
    return notices(testing_support::case_from_text(text, {"pressure.frozen=none", set}));
  };
  EXPECT_EQ(notices_with("time.end=5"), std::vector<std::string>{});
  EXPECT_EQ(notices_with("time.step=0.001").size(), 1U) << "the file's own end is too early";
}

// Default that is probably unintended; an explicit 0 is intended.
TEST(Notices, WarnOfADefaultWithoutDrainage) {
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
      << "without pore pressure";
}

// Output is written at most once per time step.
TEST(Notices, CountAtMostOneSnapshotPerStep) {
  const std::string text = changed(with_columns);
  const std::vector<std::string> sets{"pressure.frozen=none", "time.end=1", "time.output_interval=1e-6"};
  const std::vector<std::string> none;
  EXPECT_EQ(notices(testing_support::case_from_text(text, sets)), none) << "1001 steps";
  std::vector<std::string> finer = sets;
  finer.emplace_back("time.step=5e-5");
  EXPECT_EQ(notices(testing_support::case_from_text(text, finer)),
            std::vector<std::string>{"--set time.output_interval=1e-6: time.output_interval is 1e-06 s: that is 20,000 "
                                     "snapshots, each a file, too many for a folder or an animation."});
}

TEST(Notices, WarnOfInitialWaterInACaseWithoutHeat) {
  const std::string text = changed(with_columns);
  EXPECT_EQ(notices(testing_support::case_from_text(
                text, {"heat.enabled=false", "band.model=scaled", "body.block.temperature=5"})),
            std::vector<std::string>{"--set body.block.temperature=5: body.block.temperature is 5 C: its pores contain "
                                     "water and no ice from the start. Was a temperature below 0 meant?"});
}

// The case of a run folder contains every default and marks the given ones.
TEST(Notices, WarnOfADefaultOfAResolvedCase) {
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

TEST(Notices, WarnOfABaseWithoutABand) {
  const std::string text = changed({{"law = \"elastic\"", "law = \"elastic\"\nhydraulic_conductivity = 1e-7"}});
  const std::string known = "pressure.frozen=none";
  EXPECT_EQ(
      without_folder(notices(testing_support::case_from_text(text, {known}))),
      std::vector<std::string>{"FOLDER/case.toml: band.thickness is not given: friction then heats the lowest cells as "
                               "a whole, 5 m thick, which barely warm or melt. Set the thickness of the shear band: "
                               "typical values are 0.01 to 2 m. Without melting, set heat.enabled = false."});
  const std::vector<std::string> none;
  EXPECT_EQ(notices(testing_support::case_from_text(text, {"heat.enabled=false"})), none);
  EXPECT_EQ(notices(testing_support::case_from_text(text, {known, "basal.heat_fraction=0"})), none);
}

TEST(Notices, WarnOfAnUnusualBed) {
  const std::string text = changed(with_columns) +
                           "[bed]\nlaw = \"momentum\"\ndepth = 1.0\nstrength = 1e3\n"
                           "depth_per_slip = 0.1\nmaterial = \"rock\"\n";
  EXPECT_EQ(notices(testing_support::case_from_text(text, {"pressure.frozen=none", "bed.temperature=4"})),
            std::vector<std::string>{"--set bed.temperature=4: bed.temperature is 4 C: the bed's pores contain water "
                                     "and no ice. Was a temperature below 0 meant?"});
  EXPECT_EQ(notices(testing_support::case_from_text(text, {"pressure.frozen=none", "bed.friction_angle=0.1"})),
            std::vector<std::string>{"--set bed.friction_angle=0.1: bed.friction_angle is 0.1 degrees: was a "
                                     "coefficient meant? Angles are in degrees; 6 is a coefficient of 0.1."});
}

TEST(Notices, WarnOfGapsBetweenSubstrates) {
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

TEST(Notices, NameTheNewKeywordsOfFormerOnes) {
  const Case found = testing_support::case_from_text(
      changed({{"[basal]", "[heat]\nadvection_form = \"as_printed\"\n[basal]"}}), {"pressure.clapeyron=printed"});
  EXPECT_EQ(found.heat.advection_form, AdvectionForm::as_published);
  EXPECT_EQ(found.pressure.clapeyron, ClapeyronSign::published);
  const std::vector<std::string> all = without_folder(notices(found));
  ASSERT_GE(all.size(), 2U);
  EXPECT_EQ(all[0],
            "note: FOLDER/case.toml:21:18: heat.advection_form is \"as_printed\", whose name is now \"as_published\"");
  EXPECT_EQ(all[1],
            "note: --set pressure.clapeyron=printed: pressure.clapeyron is \"printed\", whose name is now "
            "\"published\"");
}

TEST(Notices, NameTheNewKeyOfAFormerOne) {
  const Case found = testing_support::case_from_text(changed({}), {"terrain.description=rigid_points"});
  EXPECT_EQ(found.terrain.form, TerrainForm::rigid_points);
  EXPECT_EQ(without_folder(notices(found)).at(0),
            "note: --set terrain.description=rigid_points: key 'terrain.description' is called "
            "'terrain.representation' now");
}

TEST(Notices, ReportAKeyThatIsGivenByBothNames) {
  const std::string found =
      error_of_text(valid_case, {"terrain.description=rigid_points", "terrain.representation=rigid_points"});
  const std::string expected =
      "key 'terrain.description' is not known in [terrain]; it is called 'terrain.representation' now.";
  EXPECT_NE(found.find(expected), std::string::npos) << found;
}

TEST(Notices, ListTheDefaultsThatHaveChangedSinceEarlierVersions) {
  const Case found = testing_support::case_from_text(changed(with_band));
  EXPECT_EQ(
      without_folder(notices(found)),
      (std::vector<std::string>{
          "FOLDER/case.toml: defaults of these keys have changed, and the file sets none of them:\n"
          "  band.model = \"columns\"  # was \"scaled\"\n"
          "  band.thickness_change = \"conserving\"  # was \"as_published\"\n"
          "  heat.advection_form = \"conservative\"  # was \"as_published\"\n"
          "  pressure.frozen = \"none\"  # was \"ice_pressure\"\n"
          "  pressure.frozen_rows = \"sealed\"  # was \"draining\"\n"
          "  pressure.melt_contraction = true  # was false\n"
          "  pressure.skeleton_compressibility = 2e-09  # was 0.0\n"
          "  phases.water_expansion_law = \"by_temperature\"  # was \"constant\"\n"
          "  material.NAME.gaps_close_first = true  # was false\n"
          "  The comments show the earlier values; setting them restores the earlier results. Set one of the keys to "
          "silence this warning (docs/choosing-the-base.md)."}));
}

TEST(Notices, OmitChangedDefaultsIfOneIsGivenOrNoneHasAnEffect) {
  const std::vector<std::string> none;
  for (const ChangedDefault& moved : changed_defaults()) {
    const std::string table = moved.table == "material.NAME" ? "material.rock" : moved.table;
    const Case found = testing_support::case_from_text(changed(with_band), {table + "." + moved.key + "=" + moved.now});
    EXPECT_EQ(notices(found), none) << moved.key;
  }
  EXPECT_EQ(notices(testing_support::case_from_text(valid_case, {"heat.enabled=false"})), none);
}

// The warning agrees with the declarations about the present defaults.
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
