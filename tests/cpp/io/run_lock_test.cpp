#include "io/run_lock.hpp"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <utility>

#include "base/error.hpp"

namespace {

bool has_locks = true;

}  // namespace

// Overrides the function of the system: some network disks have no locks.
extern "C" int flock(int descriptor, int kind) noexcept {
  if (!has_locks) {
    errno = ENOLCK;
    return -1;
  }
  return static_cast<int>(syscall(SYS_flock, descriptor, kind));
}

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
    EXPECT_EQ(process_at_work(folder_).find("process " + std::to_string(getpid()) + " on "), 0U);
    EXPECT_THROW(RunLock{folder_}, UserError);
  }
  EXPECT_EQ(process_at_work(folder_), "");
  const RunLock again(folder_);
  EXPECT_NE(process_at_work(folder_), "");
}

// The inode of the file may change on file systems without persistent numbers, or the file may be replaced.
TEST_F(RunLockTest, DetectsThatItNoLongerOwnsTheFolder) {
  const RunLock lock(folder_);
  const OwnFolder own(folder_);
  EXPECT_NO_THROW(own.require());
  const fs::path file = folder_ / lock_name, copy = folder_ / "copy";
  fs::copy_file(file, copy);
  fs::rename(copy, file);
  EXPECT_NO_THROW(own.require());
  std::ofstream(file) << "process 1 on another machine\n";
  EXPECT_THROW(own.require(), WriteError);
  fs::remove(file);
  EXPECT_THROW(own.require(), WriteError);
}

TEST_F(RunLockTest, IsKeptAfterAFailedStartAndRemovedWithARun) {
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
    EXPECT_NE(process_at_work(folder_), "");
  }
  EXPECT_EQ(process_at_work(folder_), "");
}

TEST_F(RunLockTest, AMissingFolderIsReported) { EXPECT_THROW(RunLock{folder_ / "none"}, WriteError); }

// As in a lock file.
std::string name_of(pid_t process) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format("process {} on {}", process, host);
}

// Another process, which waits until it is killed.
class Waiting {
 public:
  Waiting() : number_(fork()) {
    if (number_ == 0) {
      while (true) {
        pause();
      }
    }
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  ~Waiting() { kill_and_wait(); }
  void kill_and_wait() {
    if (number_ > 0) {
      kill(number_, SIGKILL);
      waitpid(std::exchange(number_, 0), nullptr, 0);
    }
  }
  [[nodiscard]] std::string name() const { return name_of(number_); }

 private:
  pid_t number_;
};

class WithoutLocks : public RunLockTest {
 protected:
  WithoutLocks() { has_locks = false; }
  ~WithoutLocks() override { has_locks = true; }

  void write(const std::string& line) const { std::ofstream(file()) << line << "\n"; }
  fs::path file() const { return folder_ / lock_name; }
  // Empty: the lock can be acquired.
  std::string refusal() const {
    try {
      const RunLock lock(folder_);
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(WithoutLocks, AProcessOfThisMachineExcludesOthersWhileItExists) {
  Waiting other;
  const std::string name = other.name();
  write(name);
  EXPECT_EQ(process_at_work(folder_), name);
  EXPECT_EQ(refusal(), folder_.string() + " is being written by " + name +
                           ". Wait until that has ended, or stop it. Its file system has no locks: if that process is "
                           "no run any more, remove " +
                           file().string() + ".");
  other.kill_and_wait();
  EXPECT_EQ(process_at_work(folder_), "");
  EXPECT_EQ(refusal(), "");
}

TEST_F(WithoutLocks, AProcessOfAnotherMachineIsAssumedToExist) {
  for (const char* line : {"process 12 on elsewhere", "proc"}) {
    write(line);
    EXPECT_EQ(process_at_work(folder_), line);
    EXPECT_EQ(refusal().rfind(folder_.string() + " is being written by " + line + ". Wait until that ", 0), 0U);
  }
  fs::remove(file());
  EXPECT_EQ(refusal(), "");
}

TEST_F(WithoutLocks, AProcessThatEndsRemovesItsName) {
  {
    const RunLock lock(folder_);
    EXPECT_GT(fs::file_size(file()), 0U);
  }
  EXPECT_EQ(fs::file_size(file()), 0U);
  EXPECT_EQ(process_at_work(folder_), "");
}

TEST_F(WithoutLocks, ANameWithTheOwnNumberIsOfAnEarlierProcess) {
  write(name_of(getpid()));
  EXPECT_EQ(refusal(), "");
}

TEST_F(RunLockTest, IfLocksExistTheNameAloneExcludesNobody) {
  std::ofstream(folder_ / lock_name) << "process 12 on elsewhere\n";
  EXPECT_EQ(process_at_work(folder_), "");
  EXPECT_NO_THROW(RunLock{folder_});
}

TEST_F(RunLockTest, TheFileOfAnotherProcessIsNotRemoved) {
  std::ofstream(folder_ / "run.json") << "{}";
  {
    const RunLock lock(folder_);
    fs::remove(folder_ / lock_name);  // by a user
    std::ofstream(folder_ / lock_name) << "process 12 on elsewhere\n";
  }
  EXPECT_TRUE(fs::exists(folder_ / lock_name));
}

}  // namespace
}  // namespace thawslide::io
