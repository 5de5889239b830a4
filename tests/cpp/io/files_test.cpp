// Files of a run: complete or absent, exact numbers, damaged files refused.
#include "io/files.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/atomic_file.hpp"
#include "folder_of_test.hpp"
#include "io/checkpoint.hpp"
#include "io/hdf5_file.hpp"
#include "io/history_writer.hpp"
#include "io/provenance.hpp"
#include "io/snapshot.hpp"
#include "io/snapshot_series.hpp"

namespace thawslide::io {
namespace {

namespace fs = std::filesystem;

class Files : public FolderOfTest {};

TEST_F(Files, AreWholeOrAbsent) {
  write_file_atomically(folder_ / "a.txt", "first");
  write_file_atomically(folder_ / "a.txt", "second, longer");
  EXPECT_EQ(read_file(folder_ / "a.txt"), "second, longer");
  const fs::path lost = folder_ / "none" / "a.txt";
  const std::string message = failure_of([&] { write_file_atomically(lost, "x"); });
  EXPECT_NE(message.find("cannot write " + lost.string() + ": No such file or directory"), std::string::npos)
      << message;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "no temporary file remains";
}

TEST_F(Files, EmptyOnesAreReadAndMissingOnesAreRefused) {
  write_file_atomically(folder_ / "empty.txt", "");
  EXPECT_EQ(read_file(folder_ / "empty.txt"), "");
  const fs::path missing = folder_ / "missing.txt";
  EXPECT_EQ(
      failure_of([&] { read_file(missing); }),
      missing.string() + ": cannot be read: No such file or directory. Check that the file is whole and may be read.");
}

TEST_F(Files, ProvenanceIsWrittenForTextsThatAreNotUnicode) {
  Provenance provenance;
  provenance.parts.push_back(part_of_this_process());
  provenance.parts.back().command = "thawslide run caf\xE9";
  write_provenance(folder_ / "run.json", provenance);
  EXPECT_NE(read_file(folder_ / "run.json").find("\"thawslide run caf\xEF\xBF\xBD\""), std::string::npos);
}

TEST_F(Files, Sha256GivesItsStandardResult) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // FIPS 180-4
}

TEST_F(Files, NumbersAreReadBackBitwise) {
  std::mt19937_64 random(9);
  for (int k = 0; k < 10000; ++k) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value)) {
      EXPECT_EQ(std::strtod(shortest(value).c_str(), nullptr), value);
    }
  }
  EXPECT_EQ(shortest(20000.0), "20000");
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(std::nan("")), "nan");
}

TEST_F(Files, HistoryContinuesAfterATime) {
  const fs::path file = folder_ / "history.csv";
  HistoryExtent then;
  {
    HistoryWriter writer(file);
    for (int k = 0; k < 5; ++k) {
      writer.add({{"time_s", 0.5 * k}, {"speed", k * k}});
      then = k == 2 ? writer.extent() : then;
    }
  }
  std::ofstream(file, std::ios::app) << "2.5,3";  // a truncated row
  {
    std::vector<std::string> warnings;
    HistoryWriter writer = HistoryWriter::continue_after(file, "time_s,speed", then, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(writer.extent().bytes, then.bytes);
    writer.add({{"time_s", 1.5}, {"speed", 7.0}});
  }
  EXPECT_EQ(read_file(file), "time_s,speed\n0,0\n0.5,1\n1,4\n1.5,7\n");
}

void fill(mpm::Particles<2>& particles) {
  particles.resize(37);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.id(p) = static_cast<std::int64_t>(p);
    particles.body(p) = static_cast<std::int32_t>(p % 3);
    for (int c = 0; c < 4; ++c) {
      particles.stress(p, c) = normal(random);
    }
    particles.position(p, 0) = normal(random);
    particles.position(p, 1) = normal(random);
    particles.temperature(p) = normal(random);
  }
}

std::vector<std::uint32_t> another_order(std::size_t count) {
  std::vector<std::uint32_t> order(count);
  for (std::size_t k = 0; k < count; ++k) {
    order[k] = static_cast<std::uint32_t>((k * 10 + 3) % count);
  }
  return order;
}

TEST_F(Files, CheckpointIsReadBackForAnyStorageOrder) {
  mpm::Particles<2> particles, loaded;
  fill(particles);
  loaded.resize(particles.size());
  const std::vector<double> scalars{1.5, -2.0, 1e300};
  const NamedNumbers blocks{{"maps", {1.0, 2.0, 3.0}}, {"none", {}}};
  write_checkpoint<2>(folder_, particles, particles.size(), scalars, blocks);
  std::vector<double> back;
  const NamedNumbers blocks_back = read_checkpoint<2>(newest_checkpoint(folder_), loaded, back);
  EXPECT_EQ(back, scalars);
  EXPECT_EQ(blocks_back, blocks);
  for (std::size_t f = 0; f < particles.fields.all().size(); ++f) {
    EXPECT_EQ(particles.fields.all()[f]->bytes(), loaded.fields.all()[f]->bytes())
        << particles.fields.all()[f]->info().name;
  }
  particles.reorder(another_order(particles.size()));
  write_checkpoint<2>(folder_, particles, particles.size(), scalars, blocks);
  EXPECT_EQ(read_file(folder_ / checkpoint_name), read_file(folder_ / previous_checkpoint_name));
}

TEST_F(Files, AFolderWithoutACheckpointIsReported) {
  EXPECT_NE(failure_of([&] { (void)newest_checkpoint(folder_); }).find("holds no checkpoint.bin"), std::string::npos);
}

TEST_F(Files, ACheckpointOfAnotherRunIsRefused) {
  mpm::Particles<2> particles, loaded;
  fill(particles);
  write_checkpoint<2>(folder_, particles, particles.size(), {1.0});
  loaded.resize(36);
  std::vector<double> scalars;
  const std::string message = failure_of([&] { read_checkpoint<2>(newest_checkpoint(folder_), loaded, scalars); });
  EXPECT_NE(message.find("has particles at t = 0: 37; this run needs 36"), std::string::npos) << message;
}

TEST_F(Files, SnapshotsAreSortedByIdAndReproducible) {
  mpm::Particles<2> particles;
  fill(particles);
  const Vector<double, 2> origin(100.0, -50.0);
  const Snapshot first = make_snapshot<2>(particles, origin, 2.5, 250);
  particles.reorder(another_order(particles.size()));
  const Snapshot second = make_snapshot<2>(particles, origin, 2.5, 250);
  EXPECT_EQ(snapshot_bytes(first), snapshot_bytes(second));
  ASSERT_EQ(first.particles(), 37U);
  EXPECT_EQ(first.points[2], 0.0) << "z in the plane";
  for (const SnapshotField& field : first.fields) {
    if (field.name == "id") {
      EXPECT_EQ(field.values[5], 5);
    }
    if (field.name == "stress") {
      EXPECT_EQ(field.components, 6U);
      EXPECT_EQ(field.values[4], 0.0) << "yz";
    }
  }
  // The local origin is added back.
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto id = static_cast<std::size_t>(particles.id(p));
    EXPECT_DOUBLE_EQ(first.points[3 * id + 1], particles.position(p, 1) - 50.0);
  }
}

TEST_F(Files, SnapshotContainsTheBaseAndTheParticles) {
  Snapshot snapshot{0.0, 0, {1.0, 2.0, 0.0}, {}, {}};
  const auto has_base = [&] {
    SnapshotSeries series(folder_);
    series.add(snapshot);
    series.finish_writing();
    const hdf5::Handle file(H5Fopen((folder_ / "snapshots" / "000000.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                            H5Fclose, "snapshot");
    if (H5Lexists(file, "basal_segments", H5P_DEFAULT) <= 0) {
      return false;
    }
    const hdf5::Handle places(H5Dopen2(file, "basal_segments/position_m", H5P_DEFAULT), H5Dclose, "position_m");
    std::vector<double> read(6);
    EXPECT_GE(H5Dread(places, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0);
    EXPECT_EQ(read, snapshot.base.at("position_m"));
    return true;
  };
  EXPECT_FALSE(has_base());
  snapshot.base = {{"position_m", {1.0, 2.0, 0.0, 3.0, 4.0, 0.0}}, {"area_m2", {5.0, 6.0}}};
  EXPECT_TRUE(has_base());
}

TEST_F(Files, SnapshotThatCouldNotBeWrittenIsReportedByTheNextCall) {
  const Snapshot snapshot{0.0, 0, {1.0, 2.0, 0.0}, {}, {}};
  SnapshotSeries series(folder_);
  series.add(snapshot);
  series.finish_writing();
  EXPECT_TRUE(fs::exists(folder_ / "snapshots" / "000000.vtkhdf"));
  fs::remove_all(folder_ / "snapshots");
  series.add(snapshot);
  EXPECT_NE(failure_of([&] { series.add(snapshot); }).find("cannot write"), std::string::npos);
}

}  // namespace
}  // namespace thawslide::io
