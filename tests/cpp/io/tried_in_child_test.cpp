#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "folder_of_test.hpp"
#include "io/probe_in_subprocess.hpp"
#include "io/snapshot_series.hpp"

namespace thawslide::io {
namespace {

using Reported = std::vector<bool>;

TEST(TriedInChild, TellsWhatCanBeDone) {
  int done_here = 0;
  EXPECT_EQ(probe_in_subprocess(3,
                                [&](std::size_t k) {
                                  ++done_here;
                                  return k != 1;
                                }),
            (Reported{true, false, true}));
  EXPECT_EQ(done_here, 0);  // it was done elsewhere
  EXPECT_EQ(probe_in_subprocess(0, [](std::size_t /*k*/) { return true; }), Reported{});
}

TEST(TriedInChild, GoesOnBehindWhatEndsItsProcess) {
  const auto work = [](std::size_t k) {
    if (k == 0 || k == 3) {
      raise(SIGKILL);
    } else if (k == 1) {
      _exit(0);
    } else if (k == 4) {
      throw std::runtime_error("no");
    }
    return true;
  };
  EXPECT_EQ(probe_in_subprocess(6, work), (Reported{false, false, true, false, false, true}));
}

class DamagedSnapshot : public FolderOfTest {};

// HDF5 crashes for some of these: each is read, or told as one that cannot be.
TEST_F(DamagedSnapshot, WithAnyByteFlippedEndsNoResume) {
  constexpr std::size_t stride = 37;
  {
    SnapshotSeries series(folder_);
    Snapshot snapshot{0.5, 0, {1.0, 2.0, 0.0}, {}, {}};
    snapshot.fields.push_back({"mass", "kg", 1, false, {5.0}, {}});
    series.add(std::move(snapshot));
    series.finish_writing();
  }
  const std::filesystem::path file = folder_ / "snapshots" / "000000.vtkhdf";
  std::ifstream stream(file, std::ios::binary);
  const std::string sound((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  ASSERT_GT(sound.size(), 1000u);
  std::size_t specified = 0;
  for (std::size_t place = 0; place < sound.size(); place += stride) {
    std::string damaged = sound;
    damaged[place] = static_cast<char>(damaged[place] ^ (1 << place % 8));
    std::ofstream(file, std::ios::binary) << damaged;
    std::vector<std::string> warnings;
    SnapshotSeries series = SnapshotSeries::continue_after(folder_, 1, warnings);
    series.write_index();
    specified += warnings.size();
    EXPECT_EQ(warnings.empty(), std::filesystem::exists(folder_ / "particles.vtkhdf")) << place;
    std::filesystem::remove(folder_ / "particles.vtkhdf");
  }
  EXPECT_GT(specified, sound.size() / stride / 100);
}

}  // namespace
}  // namespace thawslide::io
