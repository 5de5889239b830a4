// Error messages for mistakes in the case file, compared completely, with their location.
#include <algorithm>

#include "case_messages.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;

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

TEST(Mistakes, NotTomlWithControlCharacters) {
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

}  // namespace
}  // namespace thawslide::config
