#include "base/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/error.hpp"

namespace thawslide {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view unfinished = ".thawslide-part";

// The file system allows 255 characters for the whole name.
fs::path temporary_name(const fs::path& file) {
  constexpr std::size_t longest_stem = 200, longest_extension = 20;
  return file.parent_path() / fmt::format(".{}.{}{}{}", file.stem().string().substr(0, longest_stem), getpid(),
                                          unfinished, file.extension().string().substr(0, longest_extension));
}

// Synchronizes a file, or the entries of a folder, to disk. Not every file system supports it for folders.
bool synchronize(const fs::path& path, int kind) {
  const int descriptor = open(path.empty() ? "." : path.c_str(), O_RDONLY | O_CLOEXEC | kind);
  if (descriptor < 0) {
    return false;
  }
  const bool done = fsync(descriptor) == 0 || (kind == O_DIRECTORY && errno == EINVAL);
  const int reason = errno;
  close(descriptor);
  errno = reason;
  return done;
}

bool keep_previous(const fs::path& file, const fs::path& previous) {
  return previous.empty() || rename(file.c_str(), previous.c_str()) == 0 || errno == ENOENT;
}

bool write_all(int descriptor, const char* next, std::size_t left) {
  while (left > 0) {
    const ssize_t written = ::write(descriptor, next, left);
    if (written < 0 && errno != EINTR) {
      return false;
    }
    if (written > 0) {
      next += written;
      left -= static_cast<std::size_t>(written);
    }
  }
  return true;
}

}  // namespace

AtomicFile::AtomicFile(fs::path file) : file_(std::move(file)), temporary_(temporary_name(file_)) {
  unlink(temporary_.c_str());
}

AtomicFile::~AtomicFile() { unlink(temporary_.c_str()); }

void AtomicFile::write(const void* data, std::size_t bytes) {
  const int descriptor = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    fail(std::strerror(errno));
  }
  const bool written = write_all(descriptor, static_cast<const char*>(data), bytes);
  const int reason = errno;
  const bool closed = close(descriptor) == 0;
  if (!written || !closed) {
    fail(std::strerror(written ? errno : reason));
  }
}

void AtomicFile::publish(const fs::path& previous) {
  if (!synchronize(temporary_, O_NOFOLLOW) || !keep_previous(file_, previous) ||
      rename(temporary_.c_str(), file_.c_str()) != 0 || !synchronize(file_.parent_path(), O_DIRECTORY)) {
    fail(std::strerror(errno));
  }
}

void AtomicFile::fail(const std::string& reason) const {
  throw WriteError(
      "cannot write {}: {}. Check that the folder exists and is writable, and that the disk has free space.",
      file_.string(), reason);
}

void write_file_atomically(const fs::path& file, const void* data, std::size_t bytes, const fs::path& previous) {
  AtomicFile whole(file);
  whole.write(data, bytes);
  whole.publish(previous);
}

void write_file_atomically(const fs::path& file, std::string_view text, const fs::path& previous) {
  write_file_atomically(file, text.data(), text.size(), previous);
}

bool is_unfinished(const fs::path& file) {
  const std::string name = file.filename().string();
  const std::size_t mark = name.rfind(unfinished);
  if (mark == std::string::npos || mark == 0 || name.front() != '.') {
    return false;
  }
  const std::size_t end = mark + unfinished.size();
  const std::size_t before_number = name.find_last_not_of("0123456789", mark - 1);
  return (end == name.size() || name[end] == '.') && before_number > 0 && before_number + 1 < mark &&
         name[before_number] == '.';
}

}  // namespace thawslide
