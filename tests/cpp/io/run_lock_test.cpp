#include "io/run_lock.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/error.hpp"

namespace thawslide::io {
namespace {

namespace fs = std::filesystem;

class RunLockTest : public testing::Test {
 protected:
  RunLockTest() : folder_(fs::path(testing::TempDir()) / ("lock" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~RunLockTest() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(RunLockTest, OneAtATime) {
  {
    const RunLock lock(folder_);
    ASSERT_TRUE(process_at_work(folder_).is_known);
    EXPECT_EQ(process_at_work(folder_).process.find("process " + std::to_string(getpid()) + " on "), 0U);
    EXPECT_THROW(RunLock{folder_}, UserError);
  }
  EXPECT_EQ(process_at_work(folder_).process, "");
  const RunLock again(folder_);
  EXPECT_NE(process_at_work(folder_).process, "");
}

TEST_F(RunLockTest, StaysAsASignOfAStartAndGoesWithARun) {
  { const RunLock lock(folder_); }
  EXPECT_TRUE(fs::exists(folder_ / lock_name));
  std::ofstream(folder_ / "run.json") << "{}";
  { const RunLock lock(folder_); }
  EXPECT_FALSE(fs::exists(folder_ / lock_name));
}

TEST_F(RunLockTest, MovesWithItsOwner) {
  RunLock lock(folder_);
  {
    const RunLock other(std::move(lock));
    EXPECT_NE(process_at_work(folder_).process, "");
  }
  EXPECT_EQ(process_at_work(folder_).process, "");
}

TEST_F(RunLockTest, AFolderThatIsNotThereIsTold) { EXPECT_THROW(RunLock{folder_ / "none"}, WriteError); }

}  // namespace
}  // namespace thawslide::io
