#include "io/run_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "config/input_limits.hpp"
#include "io/files.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

enum class Lock { acquired, of_another, unknown };

// The file system may not support locks.
Lock try_lock(int descriptor, int kind) {
  if (flock(descriptor, kind | LOCK_NB) == 0) {
    return Lock::acquired;
  }
  return errno == EWOULDBLOCK ? Lock::of_another : Lock::unknown;
}

// A process that only tests the lock holds it briefly, so a single refusal is not conclusive.
Lock acquire(int descriptor) {
  constexpr int attempts = 20;
  constexpr useconds_t pause = 5000;  // microseconds
  Lock lock = try_lock(descriptor, LOCK_EX);
  for (int k = 1; k < attempts && lock == Lock::of_another; ++k) {
    usleep(pause);
    lock = try_lock(descriptor, LOCK_EX);
  }
  return lock;
}

int open_lock(const fs::path& file, int flags) {
  return open(file.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
}

// True if the name still refers to the open file, because the holder of the lock removes it on release.
bool is_of_name(int descriptor, const fs::path& file) {
  struct stat opened {};
  struct stat named {};
  return fstat(descriptor, &opened) == 0 && lstat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

// Text written by the holder of the lock, which may have been removed since.
std::string line_in(int descriptor) {
  char text[512];
  const ssize_t length = pread(descriptor, text, sizeof text, 0);
  std::string words(text, length > 0 ? static_cast<std::size_t>(length) : 0);
  while (!words.empty() && words.back() == '\n') {
    words.pop_back();
  }
  return config::shown(words);
}

std::string format_process(pid_t number) { return fmt::format("process {} on {}", number, host_name()); }

// Number in "process 123 on HOST" if HOST is this machine; 0 for another machine or another text.
pid_t process_of_this_machine(const std::string& line) {
  constexpr std::string_view begin = "process ";
  pid_t number = 0;
  if (line.rfind(begin, 0) == 0) {
    std::from_chars(line.data() + begin.size(), line.data() + line.size(), number);
  }
  return number > 0 && line == config::shown(format_process(number)) ? number : 0;
}

// Process at work according to the file, on file systems without locks; one with our own number has ended.
std::string named_process(const std::string& line) {
  const pid_t number = process_of_this_machine(line);
  const bool has_ended = number > 0 && (number == getpid() || (kill(number, 0) != 0 && errno != EPERM));
  return has_ended ? "" : line;
}

std::string process_of(int descriptor, Lock lock) {
  const std::string line = lock == Lock::acquired ? "" : line_in(descriptor);
  if (lock == Lock::unknown) {
    return named_process(line);
  }
  return lock == Lock::of_another && line.empty() ? "another process" : line;
}

// Returns a descriptor that holds the lock, or -1 if the file was unlinked after opening.
int acquire_lock(const fs::path& file) {
  const int descriptor = open_lock(file, O_RDWR | O_CREAT);
  if (descriptor < 0) {
    throw WriteError("cannot write {}: {}", file.string(), std::strerror(errno));
  }
  const Lock lock = acquire(descriptor);
  const std::string process = process_of(descriptor, lock);
  if (process.empty() && is_of_name(descriptor, file)) {
    return descriptor;
  }
  close(descriptor);
  if (!process.empty()) {
    throw UserError(
        "{} is being written by {}. Wait until that has ended, or stop it.{}", file.parent_path().string(), process,
        lock == Lock::unknown
            ? " Its file system has no locks: if that process is no run any more, remove " + file.string() + "."
            : "");
  }
  return -1;
}

}  // namespace

RunLock::RunLock(const fs::path& folder) : file_(folder / lock_name), descriptor_(-1) {
  while (descriptor_ < 0) {
    descriptor_ = acquire_lock(file_);
  }
  const std::string text = format_process(getpid()) + "\n";
  if (ftruncate(descriptor_, 0) != 0 || write(descriptor_, text.data(), text.size()) < 0) {
    const int reason = errno;
    close(descriptor_);
    throw WriteError("cannot write {}: {}", file_.string(), std::strerror(reason));
  }
}

RunLock::RunLock(RunLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

RunLock::~RunLock() {
  if (descriptor_ >= 0) {
    std::error_code ignored;
    (void)!ftruncate(descriptor_, 0);  // without locks, the entry alone would exclude others
    if (fs::exists(file_.parent_path() / "run.json", ignored) && is_of_name(descriptor_, file_)) {
      fs::remove(file_, ignored);
    }
    close(descriptor_);
  }
}

OwnFolder::OwnFolder(const fs::path& folder) : lock_(folder / lock_name) {
  struct stat facts {};
  if (lstat(lock_.c_str(), &facts) == 0) {
    device_ = facts.st_dev;
    inode_ = facts.st_ino;
  }
}

// A file system may change the file number over time; the contents then decide.
bool OwnFolder::is_own() const {
  struct stat facts {};
  if (lstat(lock_.c_str(), &facts) != 0) {
    return false;
  }
  if (facts.st_dev == device_ && facts.st_ino == inode_) {
    return true;
  }
  const int descriptor = open_lock(lock_, O_RDONLY);
  const bool is_own = descriptor >= 0 && line_in(descriptor) == config::shown(format_process(getpid()));
  if (descriptor >= 0) {
    close(descriptor);
  }
  return is_own;
}

void OwnFolder::require() const {
  if (!is_own()) {
    throw WriteError(
        "{} is no longer the folder in which this run began: that folder was moved or removed, its {} was, or another "
        "run has taken its place. Nothing more is written there. From where the folder is now, `thawslide resume` "
        "continues from the last checkpoint.",
        lock_.parent_path().string(), lock_name);
  }
}

std::string process_at_work(const fs::path& folder) {
  const fs::path file = folder / lock_name;
  const int descriptor = open_lock(file, O_RDONLY);
  if (descriptor < 0) {
    if (errno != ENOENT && errno != ENOTDIR) {
      throw UserError("cannot read {}: {}. It shows whether a run is active there.", file.string(),
                      std::strerror(errno));
    }
    return "";
  }
  const std::string found = process_of(descriptor, try_lock(descriptor, LOCK_SH));
  close(descriptor);
  return found;
}

}  // namespace thawslide::io
