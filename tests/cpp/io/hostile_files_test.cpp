// Links, pipes, devices and folders in place of a run's files are refused or replaced; they are never followed or
// waited for. Snapshots that no run has written are reported as unreadable, whatever their contents.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>
#include <vector>

#include "base/atomic_file.hpp"
#include "folder_of_test.hpp"
#include "io/checkpoint.hpp"
#include "io/files.hpp"
#include "io/hdf5_file.hpp"
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
  EXPECT_EQ(failure_of([&] { read_file(damaged); }), "cannot read " + damaged.string() + ": Invalid argument");
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
  expect_passed_over("cannot read " + last().string() + ": Invalid argument");
  fs::create_symlink("nothing", last());  // the next checkpoint must not replace the valid one by it
  expect_passed_over("cannot read " + last().string() + ": No such file or directory");
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
  snapshot.fields.push_back({"mass", "kg", 1, false, {5.0, 6.0}, {}});
  return snapshot;
}

hdf5::Handle text_type(std::size_t size) {
  hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a text type");
  H5Tset_size(type, size);
  return type;
}

void write_array(hid_t object, const char* name, hid_t type, hsize_t count, const void* values) {
  H5Adelete(object, name);
  const hdf5::Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, "a space");
  const hdf5::Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  H5Awrite(attribute, type, values);
}

void write_value(hid_t object, const char* name, hid_t type, const void* value) {
  H5Adelete(object, name);
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose, "a scalar");
  const hdf5::Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  H5Awrite(attribute, type, value);
}

void claim_rows(hid_t data, const char* name, hsize_t rows) {
  const hdf5::Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose, "a space");
  const hdf5::Handle dataset(H5Dcreate2(data, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Dclose, name);
  hdf5::write_attribute(dataset, "unit", std::string("kg"));
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
  }

  // Modifies the second of three snapshots: its groups VTKHDF and PointData, and the field mass.
  using Change = std::function<void(hid_t root, hid_t data, hid_t mass)>;
  void change_second(const Change& change) const {
    const hdf5::Handle file(H5Fopen(second().c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "the snapshot");
    const hdf5::Handle root(H5Gopen2(file, "VTKHDF", H5P_DEFAULT), H5Gclose, "VTKHDF");
    const hdf5::Handle data(H5Gopen2(root, "PointData", H5P_DEFAULT), H5Gclose, "PointData");
    const hdf5::Handle mass(H5Dopen2(data, "mass", H5P_DEFAULT), H5Dclose, "mass");
    change(root, data, mass);
  }
  void expect_left_out() const {
    std::vector<std::string> warnings;
    SnapshotSeries::continue_after(folder_, 3, warnings).write_index();
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0],
              "of the 3 snapshots up to here these are missing or cannot be read: 000001; particles.vtkhdf omits them");
    EXPECT_TRUE(fs::exists(folder_ / "particles.vtkhdf"));
  }
  fs::path second() const { return folder_ / "snapshots" / "000001.vtkhdf"; }
};

TEST_F(HostileSnapshots, ValidOnesAreAccepted) {
  std::vector<std::string> warnings;
  SnapshotSeries::continue_after(folder_, 3, warnings).write_index();
  EXPECT_TRUE(warnings.empty());
}

TEST_F(HostileSnapshots, DamagedOnesAreLeftOut) {
  const std::vector<std::pair<const char*, Change>> damages{
      {"a time of many numbers",
       [](hid_t root, hid_t, hid_t) {
         const std::vector<double> times(4000, 1.0);
         write_array(root, "time", H5T_NATIVE_DOUBLE, times.size(), times.data());
       }},
      {"a time that is a string", [](hid_t root, hid_t, hid_t) { write_value(root, "time", text_type(3), "now"); }},
      {"a unit of many strings",
       [](hid_t, hid_t, hid_t mass) { write_array(mass, "unit", text_type(2), 4000, std::string(8000, 'k').data()); }},
      {"a unit of variable length",
       [](hid_t, hid_t, hid_t mass) {
         const char* text = "kg";
         write_value(mass, "unit", text_type(H5T_VARIABLE), &text);
       }},
      {"fields with other numbers of rows", [](hid_t, hid_t data, hid_t) { claim_rows(data, "volume", 3); }}};
  for (const auto& [damage, change] : damages) {
    SCOPED_TRACE(damage);
    SetUp();
    change_second(change);
    expect_left_out();
  }
}

TEST_F(HostileSnapshots, PipesAndDevices) {
  fs::remove(second());
  ASSERT_EQ(mkfifo(second().c_str(), 0600), 0);
  expect_left_out();
  fs::remove(second());
  fs::create_symlink("/dev/zero", second());
  expect_left_out();
}

}  // namespace
}  // namespace thawslide::io
