// Snapshots that no run has written are reported as unreadable, whatever their contents.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <vector>

#include "folder_of_test.hpp"
#include "io/hdf5_file.hpp"
#include "io/snapshot_series.hpp"

namespace thawslide::io {
namespace {

namespace fs = std::filesystem;

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

TEST_F(HostileSnapshots, ATimeOfManyNumbers) {
  change_second([](hid_t root, hid_t, hid_t) {
    const std::vector<double> times(4000, 1.0);
    write_array(root, "time", H5T_NATIVE_DOUBLE, times.size(), times.data());
  });
  expect_left_out();
}

TEST_F(HostileSnapshots, ATimeThatIsAString) {
  change_second([](hid_t root, hid_t, hid_t) {
    const hdf5::Handle type = text_type(3);
    write_value(root, "time", type, "now");
  });
  expect_left_out();
}

TEST_F(HostileSnapshots, AUnitOfManyStrings) {
  change_second([](hid_t, hid_t, hid_t mass) {
    const hdf5::Handle type = text_type(2);
    const std::string texts(8000, 'k');
    write_array(mass, "unit", type, 4000, texts.data());
  });
  expect_left_out();
}

TEST_F(HostileSnapshots, AUnitOfVariableLength) {
  change_second([](hid_t, hid_t, hid_t mass) {
    const hdf5::Handle type = text_type(H5T_VARIABLE);
    const char* text = "kg";
    write_value(mass, "unit", type, &text);
  });
  expect_left_out();
}

TEST_F(HostileSnapshots, FieldsWithOtherNumbersOfRows) {
  change_second([](hid_t, hid_t data, hid_t) { claim_rows(data, "volume", 3); });
  expect_left_out();
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
