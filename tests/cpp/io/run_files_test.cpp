// Ownership of files in a folder: a run that is replaced is removed with its files, and no others.
#include <gtest/gtest.h>

#include <iterator>
#include <sstream>
#include <vector>

#include "folder_of_test.hpp"
#include "io/run_folder.hpp"

namespace thawslide::io {
namespace {

namespace fs = std::filesystem;

class RunFiles : public FolderOfTest {
 protected:
  fs::path run() const { return folder_ / "run"; }
  // `names`: parted by spaces.
  static std::vector<std::string> parted(const std::string& names) {
    std::istringstream stream(names);
    return {std::istream_iterator<std::string>(stream), {}};
  }
  void put_all(const std::string& names) const {
    for (const std::string& name : parted(names)) {
      put(run() / name, "text of " + name);
    }
  }
  void put_run_json() const {
    put(run() / "run.json", R"({"program": "thawslide", "inputs": [{"copy": "inputs/valley.1.part.csv"}]})");
  }
  std::vector<std::string> left() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(run())) {
      names.push_back(entry.path().lexically_relative(run()).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(RunFiles, ARunThatIsReplacedIsRemovedWithItsFiles) {
  put_run_json();
  put_all(
      "history.csv probes.csv case.toml terrain.csv particles.vtkhdf checkpoint.bin checkpoint.previous.bin "
      "report.html contours-max_thickness.gpkg history.damaged.csv probes.damaged.12.csv checkpoint.damaged.bin "
      ".run.json.7.thawslide-part snapshots/000000.vtkhdf snapshots/1000000.vtkhdf "
      "snapshots/.000001.vtkhdf.7.thawslide-part inputs/valley.1.part.csv maps/max_speed.tif maps/max_speed.qml "
      "maps/max_pressure.hazard.qml maps/max_speed.tif.aux.xml maps/results.gpkg figures/motion.png "
      "figures/animation.mp4 figures/.motion.7.thawslide-part.png");
  make_run_folder(run(), true);
  EXPECT_EQ(left(), std::vector<std::string>{"run.lock"});
}

TEST_F(RunFiles, FilesOfOthersAreKept) {
  const std::string foreign =
      "figures/motion.svg figures/photo.jpg history.damaged.xlsx history.damaged.old.csv inputs/notes.txt "
      "inputs/x.7.part maps/alps.tif maps/max_speed.pdf notes.txt snapshots/mine.vtkhdf snapshots/photo.jpg "
      "thesis/maps/max_speed.tif";
  put_run_json();
  put_all(foreign);
  // two names of a run, but one file of somebody else
  const std::vector<std::string> with_blanks{"figures/energy water.png", "report.html comparison.html"};
  for (const std::string& file : with_blanks) {
    put(run() / file, "mine");
  }
  put_all("maps/max_speed.tif snapshots/000000.vtkhdf history.csv");
  make_run_folder(run(), true);
  std::vector<std::string> expected = parted(foreign);
  expected.insert(expected.end(), with_blanks.begin(), with_blanks.end());
  expected.insert(expected.end(), {"figures", "inputs", "maps", "run.lock", "snapshots", "thesis", "thesis/maps"});
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(left(), expected);
}

TEST_F(RunFiles, LinksAreRemovedAndTheirTargetsKept) {
  put_run_json();
  put(folder_ / "elsewhere" / "max_speed.tif", "mine");
  fs::create_symlink(folder_ / "elsewhere", run() / "maps");
  fs::create_symlink(folder_ / "elsewhere" / "max_speed.tif", run() / "history.csv");
  make_run_folder(run(), true);
  EXPECT_EQ(left(), std::vector<std::string>{"run.lock"});
  EXPECT_EQ(content(folder_ / "elsewhere" / "max_speed.tif"), "mine");
}

TEST_F(RunFiles, ARunJsonOfAnotherProgramIsNotARun) {
  for (const char* text : {"", "{", "[]", "3", R"({"program": 3})", R"({"program": "jogger"})", R"({"km": 12})"}) {
    put(run() / "run.json", text);
    EXPECT_EQ(failure_of([&] { make_run_folder(run(), true); }),
              "cannot determine whether " + run().string() +
                  " is the folder of a run: its run.json is damaged, or was written by another program. Specify "
                  "another --output, or delete the folder.")
        << text;
    EXPECT_EQ(content(run() / "run.json"), text);
  }
}

// Inputs, resolved case and an empty history are written before run.json (run/run_output.cpp).
TEST_F(RunFiles, AnUnstartedRunIsReplacedAndOtherFoldersAreRefused) {
  { const RunLock lock = make_run_folder(run(), false); }
  put_all("inputs/dem.tif case.toml .case.toml.7.thawslide-part snapshots/.000000.vtkhdf.7.thawslide-part");
  put(run() / "history.csv", "");
  EXPECT_EQ(failure_of([&] { make_run_folder(run(), false); }), "no failure");
  EXPECT_EQ(left(), (std::vector<std::string>{"inputs", "inputs/dem.tif", "run.lock"})) << "their owner is unknown";
  for (const char* name : {"maps/alps.tif", "snapshots/photo.jpg", "notes.txt", "history.csv", "checkpoint.bin"}) {
    put(run() / name, "mine");
    EXPECT_NE(failure_of([&] { make_run_folder(run(), true); }).find("contains other files, and no run"),
              std::string::npos)
        << name;
    EXPECT_EQ(content(run() / name), "mine");
    fs::remove_all(run() / *fs::path(name).begin());
  }
}

}  // namespace
}  // namespace thawslide::io
