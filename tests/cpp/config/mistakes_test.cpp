// Error messages for mistakes in the case file, compared completely, with their location.
#include <algorithm>

#include "case_messages.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;

const std::string all_tables =
    "[case], [time], [grid], [grid.boundary], [guards], [terrain], [checkpoint], [maps], [probe.NAME], [report], "
    "[phases], [freezing], [material.NAME], [body.NAME], [frame.NAME], [initial], [mechanics], [basal], "
    "[substrate.NAME], "
    "[bed], [contact], [contact_pair.NAME], [mechanisms], [band], "
    "[heat], [heat.boundary], [pressure], [block].";

TEST(Mistakes, ValidCaseHasNone) { EXPECT_EQ(error_of_text(valid_case), "no error"); }

TEST(Mistakes, NoSuchFile) {
  const fs::path folder = folder_of_this_test();
  write_next_to_the_case("case.toml", valid_case);
  EXPECT_EQ(error_of([&] { read_case(folder / "lamplugh"); }),
            "FOLDER/lamplugh: there is no such file or folder. Give a case file, or a folder with a case.toml.");
  EXPECT_EQ(error_of([&] { read_case(folder / "cas.toml"); }),
            "FOLDER/cas.toml: there is no such file or folder; did you mean 'case.toml'? Give a case file, or a folder "
            "with a case.toml.");
}

TEST(Mistakes, FolderWithoutCaseFile) {
  const fs::path folder = folder_of_this_test();
  fs::remove_all(folder);
  fs::create_directories(folder);
  EXPECT_EQ(error_of([&] { read_case(folder); }),
            "FOLDER: the folder has no case.toml. Give a case file, or a folder with a case.toml.");
  write_next_to_the_case("DLP.toml", valid_case);
  write_next_to_the_case("DL.toml", valid_case);
  write_next_to_the_case("README.md", "");
  EXPECT_EQ(error_of([&] { read_case(folder); }),
            "FOLDER: the folder has no case.toml. Give one of its case files: DL.toml, DLP.toml.");
  EXPECT_EQ(read_case(folder / "DLP.toml").name, "Mistakes.FolderWithoutCaseFile-DLP");
}

TEST(Mistakes, EmptyFile) {
  const std::string message =
      "FOLDER/case.toml:1:1: the file is empty; a case has at least [time], [grid], [material.NAME] and [body.NAME].";
  EXPECT_EQ(error_of_text(""), message);
  EXPECT_EQ(error_of_text("# a remark only\n"), message);
}

TEST(Mistakes, NotToml) {
  const std::string remedy = ". Correct the line; see https://toml.io for the syntax.";
  EXPECT_EQ(
      error_of_changed({{"cell = 5.0", "cell = = 5.0"}}),
      "FOLDER/case.toml:5:8: this is not TOML: Error while parsing value: could not determine value type" + remedy);
  EXPECT_EQ(error_of_changed({{"cell = 5.0", "cell = 5.0\ncell = 6.0"}}),
            "FOLDER/case.toml:6:8: this is not TOML: Error while parsing key-value pair: cannot redefine existing "
            "floating-point 'cell'. A table contains a key only once" +
                remedy);
  EXPECT_EQ(error_of_changed({{"cell = 5.0", "cell = 5,0"}}),
            "FOLDER/case.toml:5:9: this is not TOML: Error while parsing key-value pair: expected a comment or "
            "whitespace, saw ','. Write a decimal point, not a comma" +
                remedy);
  EXPECT_EQ(error_of_changed({{"cell = 5.0", "cell = 5.0 m"}}),
            "FOLDER/case.toml:5:12: this is not TOML: Error while parsing key-value pair: expected a comment or "
            "whitespace, saw 'm'. Write numbers without units, and text in quotes" +
                remedy);
  const std::string found = error_of_changed({{"cell = 5.0", "cell = f\x02\x1d"}});
  EXPECT_NE(found.find(":5:9: this is not TOML: "), std::string::npos) << found;
  EXPECT_TRUE(std::none_of(found.begin(), found.end(), [](char letter) { return letter > 0 && letter < ' '; }))
      << found;
}

TEST(Mistakes, NumbersInLikelyUnits) {
  const auto with_block = [](const std::string& line) {
    return error_of_changed({{"[body.block]", "[body.block]\n" + line}});
  };
  EXPECT_NE(with_block("porosity = 37.5").find("; if it is in percent, it is 0.375. Correct it"), std::string::npos);
  EXPECT_NE(with_block("temperature = 263.15").find("; if it is in kelvin, it is -10 C. Correct it"),
            std::string::npos);
  for (const char* line : {"porosity = 1.5", "porosity = -1", "porosity = 150", "temperature = 120"}) {
    EXPECT_EQ(with_block(line).find("; if it is in"), std::string::npos) << line;
  }
}

TEST(Mistakes, NumberExpected) {
  const auto with_cell = [](const std::string& value) { return error_of_changed({{"cell = 5.0", "cell = " + value}}); };
  const std::string start = "FOLDER/case.toml:5:8: grid.cell is ";
  const std::string allowed = "; allowed: a number, > 0 [m]";
  EXPECT_EQ(with_cell("\"five\""), start + "the text \"five\"" + allowed + ".");
  EXPECT_EQ(with_cell("\"5.0\""), start + "the text \"5.0\"" + allowed + "; remove the quotes.");
  EXPECT_EQ(with_cell("true"), start + "true" + allowed + ".");
  EXPECT_EQ(with_cell("[5.0]"), start + "an array of 1" + allowed + ".");
  EXPECT_EQ(with_cell("{ size = 5.0 }"), start + "a table" + allowed + ".");
  EXPECT_EQ(with_cell("2016-06-28"), start + "a date or time" + allowed + ".");
  for (const std::string value : {"nan", "inf", "-5", "0"}) {
    EXPECT_EQ(with_cell(value), start + value + "; allowed: > 0 m (side length of a grid cell).");
  }
}

TEST(Mistakes, OtherTypesExpected) {
  EXPECT_EQ(error_of_changed({{"shape = \"box\"", "shape = \"box\"\nparticles_per_axis = 2.0"}}),
            "FOLDER/case.toml:18:22: body.block.particles_per_axis is 2.0; allowed: a whole number, between 1 and 16, "
            "ends included. Correct it, or leave it out for the default 2.");
  EXPECT_EQ(error_of_changed({{"[basal]", "[heat]\nlatent = 1\n[basal]"}}),
            "FOLDER/case.toml:21:10: heat.latent is 1; allowed: true or false. Correct it, or leave it out for the "
            "default true.");
  EXPECT_EQ(error_of_changed({{"max = [40.0, 20.0]", "max = [40.0, 20.0, 1.0]"}}),
            "FOLDER/case.toml:19:7: body.block.max is an array of 3 numbers; allowed: 2 numbers, as case.dimension is "
            "2.");
  EXPECT_EQ(error_of_changed({{"max = [40.0, 20.0]", "max = 40.0"}}),
            "FOLDER/case.toml:19:7: body.block.max is 40.0; allowed: an array of 2 numbers, x and y (3 in three "
            "dimensions) [m].");
  EXPECT_EQ(error_of_changed({{"[basal]", "[report]\ntimes = [0.0, 2.0, 1.0]\n[basal]"}}),
            "FOLDER/case.toml:21:20: report.times holds 1 after 2; allowed: ascending numbers. Correct it, or leave it "
            "out for the default [].");
  EXPECT_EQ(
      error_of_changed({{"[basal]", "[heat.boundary]\nx_min = { temperature = -300 }\n[basal]"}}),
      "FOLDER/case.toml:21:25: heat.boundary.x_min has the temperature -300; allowed: > -273.15 C. Correct it, or "
      "leave it out for the default \"insulated\".");
}

TEST(Mistakes, TablesOverDepth) {
  const auto with_porosity = [](const std::string& value) {
    return error_of_changed({{"shape = \"box\"", "shape = \"box\"\nporosity = " + value}});
  };
  const std::string remedy = " Correct it, or leave it out for the default 0.375.";
  EXPECT_EQ(with_porosity("{ depth = [0.0, 5.0], value = [0.3] }"),
            "FOLDER/case.toml:18:12: body.block.porosity has 2 entries of depth and 1 of value; allowed: as many of "
            "both, at least one." +
                remedy);
  EXPECT_EQ(with_porosity("{ depth = [5.0, 0.0], value = [0.3, 0.4] }"),
            "FOLDER/case.toml:18:28: body.block.porosity holds depth 0 after 5; allowed: ascending, and a jump as two "
            "equal entries." +
                remedy);
  EXPECT_EQ(with_porosity("{ deep = [0.0, 5.0], value = [0.3, 0.4] }"),
            "FOLDER/case.toml:18:12: body.block.porosity is a table with the keys deep, value; allowed: a number, { "
            "depth = [...], value = [...] }, { x = [...], value = [...] }, { attribute = \"NAME\" } or { raster = "
            "\"FILE\" }, "
            "> 0 and <= 0.95." +
                remedy);
  EXPECT_EQ(with_porosity("{ depth = [0.0, 5.0], value = [0.3, 1.0] }"),
            "FOLDER/case.toml:18:48: body.block.porosity is 1; allowed: > 0 and <= 0.95 (porosity n at t = 0: volume "
            "fraction of ice and water)." +
                remedy);
}

TEST(Mistakes, OutOfRange) {
  for (const std::string density : {"-1", "0", "nan", "inf"}) {
    const std::string found =
        ": phases.rock_density is " + density +
        "; allowed: > 0 kg/m3 (intrinsic density of the rock grains). Correct it, or leave it out "
        "for the default 2750.0.";
    EXPECT_EQ(error_of_changed({{"[basal]", "[phases]\nrock_density = " + density + "\n[basal]"}}),
              "FOLDER/case.toml:21:16" + found);
    EXPECT_EQ(error_of_text(valid_case, {"phases.rock_density=" + density}),
              "--set phases.rock_density=" + density + found);
  }
  EXPECT_EQ(error_of_changed({{"shape = \"box\"", "shape = \"box\"\nporosity = 1.0"}}),
            "FOLDER/case.toml:18:12: body.block.porosity is 1; allowed: > 0 and <= 0.95 (porosity n at t = 0: volume "
            "fraction of ice and water). Correct it, or leave it out for the default 0.375.");
}

TEST(Mistakes, UnknownKey) {
  const std::string here = " Allowed here: cell, min, max, leaving, follows_terrain, boundary.";
  const auto with_key = [](const std::string& key) {
    return error_of_changed({{"cell = 5.0", "cell = 5.0\n" + key + " = 1.0"}});
  };
  EXPECT_EQ(with_key("cels"),
            "FOLDER/case.toml:6:1: key 'grid.cels' is not known in [grid]; did you mean 'cell'?" + here);
  EXPECT_EQ(with_key("colour"), "FOLDER/case.toml:6:1: key 'grid.colour' is not known in [grid]." + here);
  EXPECT_EQ(with_key("cohesion"),
            "FOLDER/case.toml:6:1: key 'grid.cohesion' is not known in [grid]; it belongs in [material.NAME] or "
            "[basal] or [substrate.NAME]." +
                here);
  EXPECT_EQ(error_of_changed({{"cell = 5.0", "cel = 5.0"}}),
            "FOLDER/case.toml:4:1: key 'grid.cell' is missing: it has no default. Add 'cell = ...' to [grid]: side "
            "length of a grid cell, a number, > 0 [m].\n"
            "FOLDER/case.toml:5:1: key 'grid.cel' is not known in [grid]; did you mean 'cell'?" +
                here);
}

TEST(Mistakes, UnknownTable) {
  EXPECT_EQ(error_of_changed({{"[basal]", "[frictoin]\n[bandd]\n[basal]"}}),
            "FOLDER/case.toml:20:2: table [frictoin] is not known. Allowed: " + all_tables +
                "\nFOLDER/case.toml:21:2: table [bandd] is not known; did you mean 'band'? Allowed: " + all_tables);
  EXPECT_EQ(error_of_changed({{"[time]", "friction_angle = 3.0\n[time]"}}),
            "FOLDER/case.toml:1:1: key 'friction_angle' outside of a table is not known; it belongs in [material.NAME] "
            "or [basal] or [substrate.NAME] or [bed] or [contact] or [contact_pair.NAME]. Allowed: " +
                all_tables);
}

TEST(Mistakes, TableExpected) {
  EXPECT_EQ(error_of_changed({{"[basal]", "[[heat]]\n[basal]"}}),
            "FOLDER/case.toml:20:1: 'heat' is an array of 1; allowed: one table. Write [heat] on a line of its own and "
            "its keys below.");
  EXPECT_EQ(error_of_changed({{"[body.block]", "[body]\nmass = 1.0\n[body.block]"}}),
            "FOLDER/case.toml:16:1: 'mass' stands in [body], which needs a name; write [body.NAME] with a name of your "
            "choice above it.");
  EXPECT_EQ(error_of_changed({{"[material.rock]", "[material.'a rock']\n[material.rock]"}}),
            "FOLDER/case.toml:11:1: 'a rock' cannot name a material; allowed: letters a to z, digits, '_' and '-'. "
            "Rename it.");
}

TEST(Mistakes, UnknownKeyword) {
  const std::string remedy =
      "\"elastic\", \"mohr_coulomb\". Correct it, or leave it out for the default \"mohr_coulomb\".";
  EXPECT_EQ(error_of_changed({{"\"elastic\"", "\"elastik\""}}),
            "FOLDER/case.toml:12:7: material.rock.law is \"elastik\"; did you mean 'elastic'? Allowed: " + remedy)
      << "keys of the default law are not reported as missing";
  EXPECT_EQ(error_of_changed({{"\"elastic\"", "\"rubber\""}}),
            "FOLDER/case.toml:12:7: material.rock.law is \"rubber\"; allowed: " + remedy);
}

TEST(Mistakes, MissingKey) {
  EXPECT_EQ(error_of_changed({{"step = 0.001\n", ""}}),
            "FOLDER/case.toml:1:1: key 'time.step' is missing: it is needed when time.stepping is \"fixed\". Add 'step "
            "= ...' to [time]: fixed time step, or upper limit of the adaptive time step, a number, > 0 [s].");
  EXPECT_EQ(error_of_changed({{"[basal]\nfriction_angle = 20.0\n", ""}}),
            "FOLDER/case.toml: key 'basal.friction_angle' is missing: it is needed when there is a terrain and "
            "basal.friction is \"constant\" or \"lubricated\". Add 'friction_angle = ...' to [basal]: basal friction "
            "angle phi_f, a number, >= 0 and < 90 [degrees].");
  EXPECT_EQ(error_of_changed({{"[basal]", "[basal]\ncohesion = 1.0"}}),
            "FOLDER/case.toml:20:1: key 'basal.slip_distance' is missing: it is needed when basal.cohesion > 0 and "
            "basal.cohesion_law is \"slip\" or \"bonds\". Add 'slip_distance = ...' to [basal]: slip d_c over which "
            "the cohesion decreases to 1/e with the laws \"slip\" and \"bonds\", a number, > 0 [m].");
}

TEST(Mistakes, KeyOfAnotherDimension) {
  EXPECT_EQ(error_of_changed({{"[basal]", "[grid.boundary]\nz_min = \"open\"\n[basal]"}}),
            "FOLDER/case.toml:21:9: grid.boundary.z_min has a meaning only in three dimensions, and case.dimension is "
            "2. Remove it.");
}

TEST(Mistakes, SeveralInOrderOfTheirLocations) {
  EXPECT_EQ(error_of_changed({{"end = 2.0", "ende = 2.0"}, {"cell = 5.0", "cell = -5.0\ncolour = 1"}},
                             {"basal.friction_angle=95", "band.thicknes=0.1"}),
            "FOLDER/case.toml:1:1: key 'time.end' is missing: it has no default. Add 'end = ...' to [time]: simulated "
            "time at which the run ends, a number, > 0 [s].\n"
            "FOLDER/case.toml:2:1: key 'time.ende' is not known in [time]; did you mean 'end'? Allowed here: end, "
            "stepping, step, safety, output_interval, history_interval, stop_at_rest, rest_time.\n"
            "FOLDER/case.toml:5:8: grid.cell is -5; allowed: > 0 m (side length of a grid cell).\n"
            "FOLDER/case.toml:6:1: key 'grid.colour' is not known in [grid]. Allowed here: cell, min, max, leaving, "
            "follows_terrain, boundary.\n"
            "--set basal.friction_angle=95: basal.friction_angle is 95; allowed: >= 0 and < 90 degrees (basal friction "
            "angle phi_f).\n"
            "--set band.thicknes=0.1: key 'band.thicknes' is not known in [band]; did you mean 'thickness'? Allowed "
            "here: model, thickness, region, cut_cells, thickness_change, growth, grain_size, inertial_number, "
            "growth_per_slip, mixing_slip, load_time, column_step, ground_temperature.");
}

TEST(Mistakes, SeveralInconsistencies) {
  EXPECT_EQ(
      error_of_changed({{"step = 0.001", "step = 3"},
                        {"max = [100.0, 50.0]", "max = [101.0, 50.0]"},
                        {"poisson_ratio = 0.2", "poisson_ratio = 0.5"},
                        {"material = \"rock\"", "material = \"rok\""},
                        {"min = [0.0, 0.0]", "min = [0.0, -5.0]"}}),
      "FOLDER/case.toml:3:8: time.step is 3 s, longer than the run, which ends at time.end = 2 s; allowed: at most "
      "that. Make the step smaller, or the run longer.\n"
      "FOLDER/case.toml:7:7: the domain is 101 m long along x, which is 20.2 cells of 5 m; allowed: a whole "
      "number. Move grid.max along x to 100.\n"
      "FOLDER/case.toml:14:17: material.rock.poisson_ratio is 0.5; allowed: between -1 and 0.5, ends excluded "
      "(Poisson's ratio).\n"
      "FOLDER/case.toml:16:12: body.block.material is 'rok', and there is no [material.rok]; did you mean 'rock'? "
      "Allowed: rock.\n"
      "FOLDER/case.toml:18:7: body.block is below the terrain: at x = 0 m its elevation is -5 m and the ground's "
      "0 m; allowed: on the ground or above it. Lift the body, or lower the terrain.");
}

}  // namespace
}  // namespace thawslide::config
