// `--set KEY=VALUE`: accepted values and error messages.
#include "case_messages.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;
using testing_support::case_from_text;

TEST(Set, ReplacesNumbers) {
  const Case found =
      case_from_text(valid_case, {"time.end=3", " grid.cell = 2.5", "body.block.temperature=-3.5",
                                  "body.block.particles_per_axis=3", "material.rock.youngs_modulus=1e9"});
  EXPECT_EQ(found.time.end, 3.0);
  EXPECT_EQ(found.grid.cell, 2.5);
  EXPECT_EQ(found.bodies.at("block").temperature.at(7.0, 0.0), -3.5);
  EXPECT_EQ(found.bodies.at("block").particles_per_axis, 3);
  EXPECT_EQ(found.materials.at("rock").youngs_modulus, 1e9);
}

TEST(Set, ReplacesKeywordsAndTexts) {
  const Case found = case_from_text(valid_case, {"mechanics.shape_function=linear", "heat.boundary.x_min=\"insulated\"",
                                                 "case.title=Two words = one title", "heat.enabled=false"});
  EXPECT_EQ(found.mechanics.shape_function, ShapeFunction::linear);
  EXPECT_EQ(found.general.title, "Two words = one title");
  EXPECT_FALSE(found.heat.enabled);
}

TEST(Set, ReplacesArrays) {
  const Case found = case_from_text(valid_case, {"grid.max=[200.0, 60]", "report.times=[0, 0.5, 2]"});
  EXPECT_EQ(found.grid.max, (Point{200.0, 60.0, 0.0}));
  EXPECT_EQ(found.report.times, (std::vector<double>{0.0, 0.5, 2.0}));
}

TEST(Set, ReplacesTables) {
  const Case found = case_from_text(valid_case, {"band.thickness={time=[0.0, 1.0], value=[0.05, 0.5]}",
                                                 "body.block.porosity={depth=[0, 10], value=[0.4, 0.2]}",
                                                 "heat.boundary.y_min={flux=60}", "band.model=scaled"});
  EXPECT_DOUBLE_EQ(found.band.thickness.at(0.5), 0.275);
  EXPECT_DOUBLE_EQ(found.bodies.at("block").porosity.at(5.0, 0.0), 0.3);
  EXPECT_EQ(found.heat.boundary[2].kind, HeatBoundaryKind::flux);
  EXPECT_EQ(found.heat.boundary[2].value, 60.0);
}

TEST(Set, TheLastOneApplies) { EXPECT_EQ(case_from_text(valid_case, {"time.end=3", "time.end=4"}).time.end, 4.0); }

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

TEST(Set, OfAnUnknownKeyIsRefused) {
  EXPECT_EQ(error_of_text(valid_case, {"grid.cel=1"}),
            "--set grid.cel=1: key 'grid.cel' is not known in [grid]; did you mean 'cell'? Allowed here: cell, min, "
            "max, leaving, follows_terrain, boundary.");
  EXPECT_EQ(error_of_text(valid_case, {"body.blok.temperature=1"}),
            "--set body.blok.temperature=1: there is no body 'blok'; did you mean 'block'? In the case file: block.");
  EXPECT_EQ(error_of_text(valid_case, {"frame.wall.velocity=1"}),
            "--set frame.wall.velocity=1: there is no frame 'wall'. In the case file: none.");
  const std::string start = "--set gird.cell=1: table [gird] is not known; did you mean 'grid'? Allowed: [case], ";
  EXPECT_EQ(error_of_text(valid_case, {"gird.cell=1"}).substr(0, start.size()), start);
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

TEST(Set, OfANamedTableIsRefused) {
  EXPECT_EQ(error_of_text(valid_case, {"body.block=3"}),
            "--set body.block=3: [body.block] is a table, and 3 no table. Set one of its keys: --set "
            "body.block.KEY=VALUE.");
  EXPECT_EQ(error_of_text(valid_case, {"body.block=[1, 2]"}),
            "--set body.block=[1, 2]: [body.block] is a table, and [1, 2] no table. Set one of its keys: --set "
            "body.block.KEY=VALUE.");
  const std::string two_bodies = valid_case + "[body.other]\nmaterial = \"rock\"\nmin = [50, 0]\nmax = [60, 10]\n";
  EXPECT_EQ(error_of_text(two_bodies, {"body.block=3"}), error_of_text(valid_case, {"body.block=3"}));
}

TEST(Set, OfAWrongTypeIsRefused) {
  EXPECT_EQ(error_of_text(valid_case, {"grid.cell=five"}),
            "--set grid.cell=five: grid.cell is the text \"five\"; allowed: a number, > 0 [m].");
  EXPECT_EQ(error_of_text(valid_case, {"grid.cell='5'"}),
            "--set grid.cell='5': grid.cell is the text \"5\"; allowed: a number, > 0 [m]; write 5.");
  EXPECT_EQ(error_of_text(valid_case, {"grid.cell=.5"}),
            "--set grid.cell=.5: grid.cell is the text \".5\"; allowed: a number, > 0 [m]; write 0.5.");
  EXPECT_EQ(error_of_text(valid_case, {"grid.cell=[5.0]"}),
            "--set grid.cell=[5.0]: grid.cell is an array of 1; allowed: a number, > 0 [m].");
  EXPECT_EQ(error_of_text(valid_case, {"grid.max=100"}),
            "--set grid.max=100: grid.max is 100; allowed: an array of 2 numbers, x and y (3 in three dimensions) "
            "[m].");
  EXPECT_EQ(error_of_text(valid_case, {"terrain.type=plan"}),
            "--set terrain.type=plan: terrain.type is \"plan\"; did you mean 'plane'? Allowed: \"none\", \"flat\", "
            "\"plane\", \"profile\", \"dem\". Correct it, or leave it out for the default \"none\".");
  EXPECT_EQ(error_of_text(valid_case, {"band=1"}),
            "--set band=1: 'band' is 1; allowed: one table. Write [band] on a line of its own and its keys below.");
}

TEST(Set, IsNamedInErrorsOfAnArrayEntry) {
  EXPECT_EQ(error_of_text(valid_case, {"report.times=[0, 2, 1]"}),
            "--set report.times=[0, 2, 1]: report.times holds 1 after 2; allowed: ascending numbers. Correct it, or "
            "leave it out for the default [].");
  EXPECT_EQ(error_of_text(valid_case, {"grid.max=[100, nan]"}),
            "--set grid.max=[100, nan]: grid.max is nan; allowed: a finite number.");
}

TEST(Set, IsNamedInErrorsOfInconsistentValues) {
  EXPECT_EQ(error_of_text(valid_case, {"terrain.elevation=2"}),
            "--set terrain.elevation=2: body.block is below the terrain: at x = 0 m its elevation is 0 m and the "
            "ground's 2 m; allowed: on the ground or above it. Lift the body, or lower the terrain.");
  EXPECT_EQ(error_of_text(valid_case, {"body.block.min=[0, -5]"}),
            "--set body.block.min=[0, -5]: body.block is below the terrain: at x = 0 m its elevation is -5 m and the "
            "ground's 0 m; allowed: on the ground or above it. Lift the body, or lower the terrain.");
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

}  // namespace
}  // namespace thawslide::config
