#include "io/run_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

enum class Lock { ours, of_another, unknown };

// A file system may have no locks.
Lock ask(int descriptor, int kind) {
  if (flock(descriptor, kind | LOCK_NB) == 0) {
    return Lock::ours;
  }
  return errno == EWOULDBLOCK ? Lock::of_another : Lock::unknown;
}

// Who only asks holds the lock for a moment, so one refusal tells nothing. Where there are no locks nobody is refused.
bool take(int descriptor) {
  constexpr int attempts = 20;
  constexpr useconds_t pause = 5000;  // microseconds
  for (int k = 0; k < attempts; ++k) {
    if (ask(descriptor, LOCK_EX) != Lock::of_another) {
      return true;
    }
    usleep(pause);
  }
  return false;
}

// Whether the file is still that of the name: whoever gives the lock back removes it.
bool is_of_name(int descriptor, const fs::path& file) {
  struct stat opened {};
  struct stat named {};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

// What the holder has written into the file, which it may have removed since.
std::string holder_of(int descriptor) {
  char text[512];
  const ssize_t length = pread(descriptor, text, sizeof text, 0);
  std::string words(text, length > 0 ? static_cast<std::size_t>(length) : 0);
  while (!words.empty() && words.back() == '\n') {
    words.pop_back();
  }
  return words.empty() ? "another process" : words;
}

std::string this_process() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format("process {} on {}\n", getpid(), host);
}

}  // namespace

RunLock::RunLock(const fs::path& folder) : file_(folder / lock_name), descriptor_(-1) {
  do {
    if (descriptor_ >= 0) {
      close(descriptor_);
    }
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw WriteError(fmt::format("cannot write {}: {}", file_.string(), std::strerror(errno)));
    }
    if (!take(descriptor_)) {
      const std::string holder = holder_of(descriptor_);
      close(descriptor_);
      throw UserError(
          fmt::format("{} is being written by {}. Wait until that has ended, or stop it.", folder.string(), holder));
    }
  } while (!is_of_name(descriptor_, file_));
  const std::string text = this_process();
  if (ftruncate(descriptor_, 0) != 0 || write(descriptor_, text.data(), text.size()) < 0) {
    const int reason = errno;
    close(descriptor_);
    throw WriteError(fmt::format("cannot write {}: {}", file_.string(), std::strerror(reason)));
  }
}

RunLock::RunLock(RunLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

RunLock::~RunLock() {
  if (descriptor_ >= 0) {
    std::error_code ignored;
    if (fs::exists(file_.parent_path() / "run.json", ignored)) {
      fs::remove(file_, ignored);
    }
    close(descriptor_);
  }
}

AtWork process_at_work(const fs::path& folder) {
  const fs::path file = folder / lock_name;
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return {};
  }
  const Lock lock = ask(descriptor, LOCK_SH);
  const AtWork found{lock != Lock::unknown, lock == Lock::of_another ? holder_of(descriptor) : ""};
  close(descriptor);
  return found;
}

}  // namespace thawslide::io
