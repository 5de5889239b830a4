// Links, pipes, devices and folders in place of a run's files are refused or replaced; they are never followed or
// waited for.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <vector>

#include "base/atomic_file.hpp"
#include "folder_of_test.hpp"
#include "io/checkpoint.hpp"
#include "io/files.hpp"
#include "io/history_writer.hpp"
#include "io/provenance.hpp"
#include "io/snapshot_series.hpp"

namespace thawslide::io {
namespace {

namespace fs = std::filesystem;

class HostileFiles : public FolderOfTest {};

TEST_F(HostileFiles, OnlyRegularFilesAreRead) {
  const fs::path pipe = folder_ / "pipe", endless = folder_ / "endless", damaged = folder_ / "damaged";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", endless);
  fs::create_symlink("/proc/self/mem", damaged);  // its first byte cannot be read
  const auto refusal = [](const fs::path& file, const std::string& found) {
    return file.string() + " is " + found + "; a regular file is needed. Replace it by the file itself, or remove it.";
  };
  EXPECT_EQ(failure_of([&] { read_file(pipe); }), refusal(pipe, "a pipe"));
  EXPECT_EQ(failure_of([&] { read_file(endless); }), refusal(endless, "a device"));
  EXPECT_EQ(failure_of([&] { read_file(folder_); }), refusal(folder_, "a folder"));
  EXPECT_EQ(failure_of([&] { read_file(damaged); }),
            damaged.string() + ": cannot be read: Invalid argument. Check that the file is whole and may be read.");
  EXPECT_EQ(failure_of([&] { (void)last_time_in_history(pipe); }), refusal(pipe, "a pipe"));
}

TEST_F(HostileFiles, UnfinishedOnesAreDistinguishedFromFilesOfTheUser) {
  for (const char* name :
       {".a.csv.12.thawslide-part", ".a.12.thawslide-part.tif", ".a.12.thawslide-part.gpkg-journal"}) {
    EXPECT_TRUE(is_unfinished(folder_ / name)) << name;
  }
  for (const char* name :
       {"valley.1.part.csv", "x.7.part", "a.csv.12.thawslide-part", ".a.thawslide-part", ".a.b.thawslide-part",
        ".12.thawslide-part", ".thawslide-part", ".a.12.thawslide-parts", ".a12.thawslide-part", ""}) {
    EXPECT_FALSE(is_unfinished(folder_ / name)) << name;
  }
}

TEST_F(HostileFiles, CopiesOfInputsAreNeverMistakenForUnfinishedOnes) {
  const fs::path valley = folder_ / "from" / "valley.1.part.csv", taken = folder_ / "from" / ".a.1.thawslide-part";
  put(valley, "0,1\n");
  put(taken, "0,1\n");
  copy_inputs(folder_, {valley});
  remove_unfinished_files(folder_ / "inputs");
  EXPECT_EQ(content(folder_ / "inputs" / "valley.1.part.csv"), "0,1\n");
  EXPECT_EQ(failure_of([&] { copy_inputs(folder_, {taken}); }),
            taken.string() +
                " has a name that the program gives to files while it writes them, and that it removes. "
                "Give the file another name.");
}

TEST_F(HostileFiles, FilesWithLongNamesAreWritten) {
  const fs::path file = folder_ / std::string(250, 'n');
  write_file_atomically(file, "text");
  EXPECT_EQ(content(file), "text");
}

TEST_F(HostileFiles, APipeInPlaceOfAnUnfinishedOneIsReplaced) {
  const fs::path adjacent = folder_ / fmt::format(".a.{}.thawslide-part.txt", getpid()), victim = folder_ / "victim";
  put(victim, "mine");
  const auto expect_replaced = [&] {
    write_file_atomically(folder_ / "a.txt", "text");
    EXPECT_EQ(content(folder_ / "a.txt"), "text");
    EXPECT_EQ(content(victim), "mine");
    EXPECT_FALSE(fs::exists(fs::symlink_status(adjacent)));
  };
  fs::create_symlink(victim, adjacent);
  expect_replaced();
  ASSERT_EQ(mkfifo(adjacent.c_str(), 0600), 0);
  expect_replaced();
}

TEST_F(HostileFiles, AHistoryReplacesLinksAndPipes) {
  const fs::path file = folder_ / "history.csv", victim = folder_ / "victim";
  put(victim, "mine");
  fs::create_symlink(victim, file);
  HistoryWriter::start_in_run(file).add({{"time_s", 0.0}});
  EXPECT_EQ(content(victim), "mine");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(file)));
  EXPECT_EQ(content(file), "time_s\n0\n");
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  HistoryWriter::start_in_run(file).add({{"time_s", 1.0}});
  EXPECT_EQ(content(file), "time_s\n1\n");
  // A history that is continued uses the rows of the link's target.
  fs::rename(file, victim);
  fs::create_symlink(victim, file);
  std::vector<std::string> warnings;
  HistoryWriter::continue_after(file, "time_s", {1, 9, 1.0}, warnings).add({{"time_s", 2.0}});
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(content(victim), "time_s\n1\n");
  EXPECT_EQ(content(file), "time_s\n1\n2\n");
}

TEST_F(HostileFiles, AHistoryNamedByAUserIsWrittenThroughALink) {
  const fs::path file = folder_ / "rows.csv", disk = folder_ / "disk.csv";
  fs::create_symlink(disk, file);
  HistoryWriter(file).add({{"time_s", 0.0}});
  EXPECT_TRUE(fs::is_symlink(file));
  EXPECT_EQ(content(disk), "time_s\n0\n");
}

class HostileCheckpoints : public HostileFiles {
 protected:
  void SetUp() override {
    HostileFiles::SetUp();
    for (const double number : {1.0, 2.0}) {
      write_checkpoint<2>(folder_, mpm::Particles<2>(), 0, {number});
    }
  }
  fs::path last() const { return folder_ / checkpoint_name; }
  fs::path before() const { return folder_ / previous_checkpoint_name; }
};

TEST_F(HostileCheckpoints, AnUnreadableOneIsReplacedByThePreviousOne) {
  const auto expect_passed_over = [&](const std::string& fault) {
    const WholeCheckpoint found = newest_checkpoint(folder_);
    EXPECT_EQ(found.file, before());
    EXPECT_EQ(found.warning, fault);
    EXPECT_EQ(found.damaged, last());
    EXPECT_EQ(read_file(before()), found.bytes);
    fs::remove(last());
  };
  fs::remove(last());
  fs::create_directory(last());
  expect_passed_over(last().string() + " is a folder, no file");
  ASSERT_EQ(mkfifo(last().c_str(), 0600), 0);
  expect_passed_over(last().string() + " is a pipe, no file");
  fs::create_symlink("/proc/self/mem", last());
  const std::string begin = last().string() + ": cannot be read: ",
                    advice = ". Check that the file is whole and may be read.";
  expect_passed_over(begin + "Invalid argument" + advice);
  fs::create_symlink("nothing", last());  // the next checkpoint must not replace the valid one by it
  expect_passed_over(begin + "No such file or directory" + advice);
}

TEST_F(HostileCheckpoints, AMissingOneIsReportedWithoutADamagedFile) {
  EXPECT_EQ(newest_checkpoint(folder_).damaged, "");
  fs::remove(last());
  const WholeCheckpoint found = newest_checkpoint(folder_);
  EXPECT_EQ(found.file, before());
  EXPECT_EQ(found.warning, last().string() + " is missing");
  EXPECT_EQ(found.damaged, "");
  put(before(), "torn");
  EXPECT_EQ(
      failure_of([&] { (void)newest_checkpoint(folder_); }),
      last().string() + " is missing; " + before().string() +
          " is damaged: its checksum does not fit its 4 bytes. Use another copy, or run the case from its start.");
}

// Root may remove everything: for the lifetime of this object, root is another user.
class Nobody {
 public:
  Nobody() : was_root_(geteuid() == 0) { EXPECT_TRUE(!was_root_ || seteuid(65534) == 0); }
  Nobody(const Nobody&) = delete;
  Nobody& operator=(const Nobody&) = delete;
  ~Nobody() { EXPECT_TRUE(!was_root_ || seteuid(0) == 0); }

 private:
  bool was_root_;
};

TEST_F(HostileFiles, AFileThatCannotBeRemovedIsAFailureToWrite) {
  const fs::path torn = folder_ / ".history.csv.17.thawslide-part";
  put(torn, "half");
  const auto all_may_read = static_cast<fs::perms>(0555);
  fs::permissions(folder_, all_may_read);
  std::string message;
  try {
    const Nobody nobody;
    remove_unfinished_files(folder_);
  } catch (const WriteError& error) {
    message = error.what();
  }
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_EQ(message,
            "cannot remove " + torn.string() + ": Permission denied. Check that the folder may be written to.");
}

Snapshot valid_snapshot(double time) {
  Snapshot snapshot{time, 0, {1.0, 2.0, 0.0, 3.0, 4.0, 0.0}, {}, {}};
  snapshot.fields.push_back({"mass", "kg", 1, false, {5.0, 6.0}});
  return snapshot;
}

class HostileSnapshots : public FolderOfTest {
 protected:
  void SetUp() override {
    FolderOfTest::SetUp();
    SnapshotSeries series(folder_);
    for (const double time : {0.0, 0.5, 1.0}) {
      series.add(valid_snapshot(time));
    }
    series.finish_writing();
    state_ = series.state();
  }

  void expect_left_out() const {
    std::vector<std::string> warnings;
    SnapshotSeries::continue_after(folder_, state_, valid_snapshot(0.0).fields, warnings).write_index();
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0],
              "of the 3 snapshots up to here these are missing or damaged: 000001; particles.vtkhdf omits them");
    EXPECT_TRUE(fs::exists(folder_ / "particles.vtkhdf"));
  }
  fs::path second() const { return folder_ / "snapshots" / "000001.vtkhdf"; }

  std::vector<double> state_;
};

TEST_F(HostileSnapshots, ValidOnesAreAccepted) {
  std::vector<std::string> warnings;
  SnapshotSeries::continue_after(folder_, state_, valid_snapshot(0.0).fields, warnings).write_index();
  EXPECT_TRUE(warnings.empty());
}

TEST_F(HostileSnapshots, TruncatedOnesPipesAndDevicesAreLeftOut) {
  fs::resize_file(second(), fs::file_size(second()) - 1);
  expect_left_out();
  fs::remove(second());
  ASSERT_EQ(mkfifo(second().c_str(), 0600), 0);
  expect_left_out();
  fs::remove(second());
  fs::create_symlink("/dev/zero", second());
  expect_left_out();
}

}  // namespace
}  // namespace thawslide::io
