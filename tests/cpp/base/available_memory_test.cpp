// Available memory as reported by the operating system.
#include "base/available_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace thawslide {
namespace {

namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();

fs::path folder_of_this_test() {
  const fs::path folder = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

TEST(AvailableMemory, IsTheFreeMemoryWithoutSwapping) {
  EXPECT_EQ(available_in("MemTotal:       24000000 kB\nMemFree:         1000000 kB\nMemAvailable:   21000000 kB\n"),
            21000000.0 * 1024.0);
  EXPECT_TRUE(std::isnan(available_in("MemTotal: 24000000 kB\n"))) << "kernels before 3.14 do not report it";
}

TEST(AvailableMemory, OfControlGroupsIsLimitedByTheTightest) {
  const fs::path mount = folder_of_this_test();
  write(mount / "batch/job/memory.max", "8000\n");
  write(mount / "batch/job/memory.current", "3000\n");
  write(mount / "batch/job/memory.stat", "anon 2000\ninactive_file 500\n");
  EXPECT_EQ(left_by_control_groups("0::/batch/job\n", mount), 8000.0 - 3000.0 + 500.0);
  write(mount / "batch/memory.max", "10000\n");
  write(mount / "batch/memory.current", "9000\n");
  EXPECT_EQ(left_by_control_groups("0::/batch/job\n", mount), 1000.0) << "the enclosing group has less left";
  write(mount / "batch/memory.max", "max\n");
  EXPECT_EQ(left_by_control_groups("0::/batch/job\n", mount), 5500.0) << "max is no limit";
  EXPECT_EQ(left_by_control_groups("0::/elsewhere\n", mount), infinity);
  EXPECT_EQ(left_by_control_groups("", mount), infinity);
}

// In a container, the folder of its own group is not visible; the root of the mount is that group.
TEST(AvailableMemory, OfAControlGroupCountsAtTheMountToo) {
  const fs::path mount = folder_of_this_test();
  write(mount / "memory.max", "4000\n");
  write(mount / "memory.current", "5000\n");
  EXPECT_EQ(left_by_control_groups("0::/not/to/be/seen\n", mount), 0.0) << "never negative";
}

TEST(AvailableMemory, IsKnownOnThisMachine) {
  const AvailableMemory available = available_memory();
  EXPECT_GT(available.bytes, 1e6);
  EXPECT_FALSE(available.bound.empty());
}

}  // namespace
}  // namespace thawslide
