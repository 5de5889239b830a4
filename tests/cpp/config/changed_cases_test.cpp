// Changed cases: `--set KEY=VALUE`, case files based on others, differences between two cases.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.hpp"
#include "case_messages.hpp"
#include "config/case_changes.hpp"
#include "config/describe.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;
using testing_support::case_from_text;

TEST(Set, ReplacesValuesOfEveryTypeByTheLastOne) {
  const Case found = case_from_text(
      valid_case,
      {"time.end=4", "time.end=3", " grid.cell = 2.5", "body.block.temperature=-3.5", "body.block.particles_per_axis=3",
       "material.rock.youngs_modulus=1e9", "mechanics.shape_function=quadratic", "heat.boundary.x_min=\"insulated\"",
       "case.title=Two words = one title", "heat.enabled=false", "grid.max=[200.0, 60]", "report.times=[0, 0.5, 2]",
       "band.thickness={time=[0.0, 1.0], value=[0.05, 0.5]}", "body.block.porosity={depth=[0, 10], value=[0.4, 0.2]}",
       "heat.boundary.x_max={flux=60}", "band.model=scaled"});
  EXPECT_EQ(found.time.end, 3.0);
  EXPECT_EQ(found.grid.cell, 2.5);
  EXPECT_EQ(found.bodies.at("block").temperature.at(7.0, 0.0), -3.5);
  EXPECT_EQ(found.bodies.at("block").particles_per_axis, 3);
  EXPECT_EQ(found.materials.at("rock").youngs_modulus, 1e9);
  EXPECT_EQ(found.mechanics.shape_function, ShapeFunction::quadratic);
  EXPECT_EQ(found.general.title, "Two words = one title");
  EXPECT_FALSE(found.heat.enabled);
  EXPECT_EQ(found.grid.max, (Point{200.0, 60.0, 0.0}));
  EXPECT_EQ(found.report.times, (std::vector<double>{0.0, 0.5, 2.0}));
  EXPECT_DOUBLE_EQ(found.band.thickness.at(0.5), 0.275);
  EXPECT_DOUBLE_EQ(found.bodies.at("block").porosity.at(5.0, 0.0), 0.3);
  EXPECT_EQ(found.heat.boundary[1].kind, HeatBoundaryKind::flux);
  EXPECT_EQ(found.heat.boundary[1].value, 60.0);
}

TEST(Set, AddsKeysToTheFile) {
  EXPECT_EQ(error_of_changed({{"cell = 5.0\n", ""}}, {"grid.cell=5"}), "no error");
  const Case lossy = case_from_text(valid_case, {"basal.cohesion=1", "basal.slip_distance=2"});
  EXPECT_EQ(lossy.basal.numbers(physics::basal::slip_distance), 2.0);
}

TEST(Set, NeedsAKeyAndAValue) {
  for (const std::string set : {"grid.cell", "=3", "grid..cell=3", ".cell=3", ""}) {
    EXPECT_EQ(error_of_text(valid_case, {set}),
              "--set " + set + ": allowed: TABLE.KEY=VALUE, for example --set band.thickness=0.1.");
  }
  for (const std::string value : {"[1", "", "{a=", "1\ntime.end=2"}) {
    EXPECT_EQ(error_of_text(valid_case, {"grid.cell=" + value}),
              "--set grid.cell=" + value + ": '" + value +
                  "' is not one TOML value. Write for example --set band.thickness=0.1, --set grid.min='[0, 0]' or "
                  "--set terrain.type=flat.");
  }
}

TEST(Set, CreatesATableByAKeyWithoutDefault) {
  const Case two = case_from_text(valid_case, {"body.second.min=[60, 0]", "body.second.max=[70, 10]",
                                               "body.second.temperature=-2", "body.second.material=rock"});
  EXPECT_EQ(two.bodies.at("second").min[0], 60.0);
  EXPECT_EQ(two.bodies.at("second").temperature.at(65.0, 0.0), -2.0);
  const Case icy = case_from_text(valid_case, {"substrate.ice.friction=coefficient",
                                               "substrate.ice.friction_coefficient=0.1", "substrate.ice.x_min=50"});
  EXPECT_EQ(icy.substrates.at("ice").x_min, 50.0);
  write_map_files();
  const Case gauged = case_from_text(valid_case_on_dem, {"probe.front.point=[50, 20]"});
  EXPECT_EQ(gauged.probes.at("front").point[0], 50.0);
  EXPECT_NE(error_of_text(valid_case, {"body.blok.material=rock"}), "no error") << "it has no position";
  EXPECT_EQ(error_of_text(valid_case, {"substrate.ice.friction_coefficient=0.1"}),
            "--set substrate.ice.friction_coefficient=0.1: there is no substrate 'ice'. In the case file: none.");
}

TEST(Set, ResolvesPathsFromTheWorkingDirectory) {
  const fs::path folder = folder_of_this_test();
  fs::create_directories(folder);
  write_next_to_the_case("profile.csv", "distance_m,terrain_elevation_m\n0,0\n100,0\n");
  const fs::path here = fs::current_path();
  const Case found = case_from_text(
      valid_case, {"terrain.type=profile", "terrain.file=" + fs::relative(folder / "profile.csv", here).string()});
  EXPECT_TRUE(fs::equivalent(found.terrain.file, folder / "profile.csv"));
  EXPECT_TRUE(fs::path(found.terrain.file).is_absolute());
  EXPECT_EQ(error_of_text(valid_case, {"terrain.type=profile", "terrain.file=no_profile.csv"}),
            "--set terrain.file=no_profile.csv: terrain.file is \"no_profile.csv\": no such file (" + here.string() +
                "); allowed: a file, relative to the current folder.");
}

Case read(const std::string& name, const std::vector<std::string>& sets = {}) {
  return read_case(folder_of_this_test() / name, sets);
}

// A case based on another, with keys of its own.
void write_variant(const std::string& name, const std::string& base, const std::string& lines = "") {
  write_next_to_the_case(name, one_key_per_line("[case] based_on = \"" + base + "\" | " + lines + "\n"));
}

std::string mistake(const std::string& name) {
  return error_of([&] { read(name); });
}

TEST(BasedOn, KeysAreInheritedUnlessGiven) {
  write_next_to_the_case("case.toml", valid_case);
  write_variant("steep.toml", "case.toml", "[basal] friction_angle = 35.0 | [body.block] max = [60.0, 30.0]");
  write_variant("steeper.toml", "steep.toml", "[basal] friction_angle = 40.0");
  const Case base = read("case.toml"), steep = read("steep.toml"), steeper = read("steeper.toml");
  EXPECT_EQ(base.basal.numbers(physics::basal::friction_angle), 20.0);
  EXPECT_EQ(steep.basal.numbers(physics::basal::friction_angle), 35.0);
  EXPECT_EQ(steep.bodies.at("block").max[0], 60.0);
  EXPECT_EQ(steep.bodies.at("block").material, "rock");
  EXPECT_EQ(steep.time.end, base.time.end);
  EXPECT_EQ(steeper.basal.numbers(physics::basal::friction_angle), 40.0);
  EXPECT_EQ(steeper.bodies.at("block").max[0], 60.0);
  EXPECT_EQ(steeper.case_files.size(), 3U);
  EXPECT_EQ(read("steep.toml", {"basal.friction_angle=5"}).basal.numbers(physics::basal::friction_angle), 5.0);
}

TEST(Domain, GrowsToWholeCells) {
  const Case padded = case_from_text(valid_case, {"grid.cell=8"});
  EXPECT_EQ(padded.grid.max, (Point{104.0, 54.0, 0.0}));
  EXPECT_EQ(padded.notes, (std::vector<std::string>{
                              "note: --set grid.cell=8: grid.max is [104.0, 54.0] for whole cells of 8 m, in place "
                              "of [100.0, 50.0]"}));
  const Case whole = case_from_text(valid_case, {"grid.cell=10"});
  EXPECT_EQ(whole.grid.max, (Point{100.0, 50.0, 0.0}));
  EXPECT_TRUE(whole.notes.empty());
}

TEST(BasedOn, ACellOfTheVariantMovesTheDomainToWholeCells) {
  write_next_to_the_case("case.toml", valid_case);
  write_variant("coarse.toml", "case.toml", "[grid] cell = 8.0");
  EXPECT_EQ(read("coarse.toml").grid.max, (Point{104.0, 54.0, 0.0}));
  write_variant("odd.toml", "case.toml", "[grid] cell = 8.0 | max = [100.0, 50.0]");
  EXPECT_EQ(read("odd.toml").grid.max, (Point{104.0, 54.0, 0.0}));
}

// The ground is known inside the domain only.
TEST(BasedOn, ACellOfTheVariantShrinksADomainOnADem) {
  write_map_files();
  write_next_to_the_case("case.toml", valid_case_on_dem);
  const Grid before = read("case.toml").grid;
  const double cell = 0.9 * before.cell;
  const Grid after = read("case.toml", {fmt::format("grid.cell={}", cell)}).grid;
  for (std::size_t a = 0; a < 2; ++a) {
    const double cells = (after.max[a] - after.min[a]) / cell;
    EXPECT_NEAR(cells, std::round(cells), 1e-9);
    EXPECT_EQ(after.min[a], before.min[a]);
    EXPECT_LT(std::abs(after.max[a] - before.max[a]), cell);
    EXPECT_LE(after.max[a], before.max[a]);
  }
  EXPECT_EQ(after.max[2], before.max[2]) << "cells begin at the terrain";
}

TEST(BasedOn, AValueThatIsATableIsReplacedAsAWhole) {
  write_map_files();
  write_next_to_the_case(
      "case.toml",
      changed({{"thickness = 10.0",
                "thickness = { attribute = \"depth\" }\nporosity = { depth = [0, 9], value = [0.3, 0.4] }"}},
              valid_case_on_dem) +
          "[heat.boundary]\ny_min = { temperature = -2.0 }\nx_min = { flux = 1.0 }\n");
  write_variant("maps.toml", "case.toml",
                "[body.slide] thickness = { raster = \"map.tif\" } | porosity = { x = [0, 9], value = [0.3, 0.4] } | "
                "[heat.boundary] y_min = { flux = 0.06 }");
  const Case found = read("maps.toml");
  EXPECT_EQ(found.bodies.at("slide").thickness.from, MapValue::From::raster);
  EXPECT_EQ(found.bodies.at("slide").porosity.over, InitialField::Over::x);
  EXPECT_EQ(found.bodies.at("slide").material, "rock") << "the enclosing table is merged";
  EXPECT_EQ(found.heat.boundary[2].kind, HeatBoundaryKind::flux);
  EXPECT_EQ(found.heat.boundary[0].value, 1.0) << "and a table inside a table";
}

TEST(BasedOn, TheResolvedCaseNeedsNoBaseCase) {
  write_next_to_the_case("case.toml", valid_case);
  write_variant("steep.toml", "case.toml", "[basal] friction_angle = 35.0");
  const std::string resolved = resolved_toml(read("steep.toml"), "inputs");
  write_next_to_the_case("alone.toml", resolved);
  std::filesystem::remove(folder_of_this_test() / "case.toml");
  EXPECT_EQ(read("alone.toml").basal.numbers(physics::basal::friction_angle), 35.0);
}

TEST(BasedOn, MistakesAreReportedAtTheirLocation) {
  write_next_to_the_case("case.toml", changed({{"end = 2.0", "end = -2.0"}}));
  write_variant("odd.toml", "case.toml", "[basal] friction_angel = 35.0");
  const std::string text = mistake("odd.toml");
  EXPECT_NE(text.find("FOLDER/case.toml:2:7: time.end is -2;"), std::string::npos) << text;
  EXPECT_NE(text.find("FOLDER/odd.toml:4:1: "), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean 'friction_angle'?"), std::string::npos) << text;
}

TEST(BasedOn, ABaseCaseMustExistWithoutACycle) {
  write_variant("lost.toml", "nowhere.toml");
  EXPECT_EQ(
      mistake("lost.toml"),
      "FOLDER/lost.toml:2:12: case.based_on is \"nowhere.toml\": no such file; allowed: the name of a case file of "
      "the same folder.");
  write_variant("away.toml", "../case.toml");
  EXPECT_NE(mistake("away.toml").find("which is a path; allowed: the name of a case file of the same folder."),
            std::string::npos);
  write_variant("one.toml", "two.toml");
  write_variant("two.toml", "one.toml");
  EXPECT_NE(mistake("one.toml").find("two.toml:2:12: case.based_on is \"one.toml\": the chain of files forms a cycle."),
            std::string::npos)
      << mistake("one.toml");
}

TEST(CaseChanges, NamesEachKeyThatDiffersWithBothValues) {
  const std::string before =
      "[time]\nend = 0.2\n[grid]\nmin = [0.0, -2.5]\nleaving = \"stop\"\n[case]\ntitle = \"a\"\n";
  const std::string now =
      "[time]\nend = 0.3\nstep = 1e-3\n[grid]\nmin = [0.0, -2.0]\n[case]\ntitle = \"b\"\n[report]\ntimes = [1.0]\n";
  EXPECT_EQ(differences(now, before),
            (std::vector<std::string>{"grid.leaving is missing, was 'stop'", "grid.min is [0.0, -2.0], was [0.0, -2.5]",
                                      "time.end is 0.3, was 0.2", "time.step is 0.001, was not given"}));
  EXPECT_TRUE(differences(before, before).empty());
  EXPECT_TRUE(differences("# one\n[b]\nx = 1.50\n[a]\ny = true", "[a]\ny = true\n[b]\nx = 1.5 # m").empty());
  const std::vector<std::string> found = differences("[time]\nend = \n", "[time]\nend = 1.0\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].substr(0, 18), "line 2 is not TOML");
}

TEST(CaseChanges, AreLimitedToKeysThatEveryStepReads) {
  EXPECT_NO_THROW(require_changeable({"time.end=3", "time.stepping=adaptive", "checkpoint.interval=2",
                                      "grid.leaving=remove", "basal.friction_angle=12", "basal.turbulent_friction=400",
                                      "basal.heat_fraction=0.5", "mechanics.fmpm_interval=0.1",
                                      "mechanics.split_limit=16", "substrate.ice.friction_coefficient=0.1"}));
  for (const char* set : {"grid.cell=3", "time=3", "material.rock.cohesion=3", "band.thickness=0.1", "substrate.ice={}",
                          "substrate.ice.x_min=3", "body.slide.temperature.y=3", "substrate.basal.cohesion_law=bonds",
                          "mechanics.split_stretched=true"}) {
    EXPECT_THROW(require_changeable({"time.end=3", set}), UserError) << set;
  }
}

TEST(CoarseChanges, DoubleCellsFixedStepsAndGivenMapCells) {
  Case parameters;
  parameters.grid.cell = 5.0;
  parameters.time.step = 0.01;
  EXPECT_EQ(coarse_changes(parameters), std::vector<std::string>{"grid.cell=10"}) << "the step is its default";
  parameters.locations["time.step"] = "case.toml:3:1";
  parameters.maps.cell = 15.0;
  EXPECT_EQ(coarse_changes(parameters), (std::vector<std::string>{"grid.cell=10", "time.step=0.02", "maps.cell=30"}));
}

}  // namespace
}  // namespace thawslide::config
