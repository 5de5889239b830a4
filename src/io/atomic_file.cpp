#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "base/error.hpp"
#include "config/input_limits.hpp"

namespace thawslide::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const fs::path& temporary, int reason) {
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw WriteError(fmt::format(
      "cannot write {}: {}. Check that the folder exists and is writable, and that the disk has free space.",
      file.string(), std::strerror(reason)));
}

constexpr std::string_view unfinished = ".thawslide-part";

// Temporary name of a file until it is complete: .NAME.PROCESS.thawslide-part in the same folder.
fs::path temporary_name(const fs::path& file) {
  constexpr std::size_t longest_name = 200;  // characters: file systems allow 255 for the whole name
  return file.parent_path() /
         fmt::format(".{}.{}{}", file.filename().string().substr(0, longest_name), getpid(), unfinished);
}

// A file of that name belongs to a dead process, or could redirect the output: a link, or a pipe without a reader.
int create_file(const fs::path& file) {
  unlink(file.c_str());
  return open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

// Synchronizes the directory entry of a new or renamed file to disk.
bool synchronise_folder(const fs::path& folder) {
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  const bool done = descriptor >= 0 && (fsync(descriptor) == 0 || errno == EINVAL);  // EINVAL: not supported there
  return (descriptor < 0 || close(descriptor) == 0) && done;
}

// Appends the rest of a file of approximately `bytes`. Returns the system's error number on failure, 0 otherwise.
int read_to_end(int descriptor, std::size_t bytes, std::string& text) {
  constexpr std::size_t segment = 65536;
  std::size_t length = 0;
  text.resize(bytes + 1);  // detects the end of the file without another segment
  while (true) {
    const ssize_t got = read(descriptor, text.data() + length, text.size() - length);
    if (got == 0 || (got < 0 && errno != EINTR)) {
      text.resize(length);
      return got == 0 ? 0 : errno;
    }
    length += got > 0 ? static_cast<std::size_t>(got) : 0;
    if (length == text.size()) {
      text.resize(length + std::max(segment, length / 2));
    }
  }
}

}  // namespace

void write_file_atomically(const fs::path& file, const void* data, std::size_t bytes, const fs::path& previous) {
  const fs::path temporary = temporary_name(file);
  const int descriptor = create_file(temporary);
  if (descriptor < 0) {
    fail(file, temporary, errno);
  }
  const char* next = static_cast<const char*>(data);
  std::size_t left = bytes;
  while (left > 0) {
    const ssize_t written = write(descriptor, next, left);
    if (written < 0 && errno != EINTR) {
      const int reason = errno;
      close(descriptor);
      fail(file, temporary, reason);
    }
    if (written > 0) {
      next += written;
      left -= static_cast<std::size_t>(written);
    }
  }
  const auto keep_previous = [&] { return rename(file.c_str(), previous.c_str()) == 0 || errno == ENOENT; };
  if (fsync(descriptor) != 0 || close(descriptor) != 0 || (!previous.empty() && !keep_previous()) ||
      rename(temporary.c_str(), file.c_str()) != 0 || !synchronise_folder(file.parent_path())) {
    fail(file, temporary, errno);
  }
}

void write_file_atomically(const fs::path& file, std::string_view text, const fs::path& previous) {
  write_file_atomically(file, text.data(), text.size(), previous);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw WriteError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  }
}

bool is_unfinished(const fs::path& file) {
  const std::string name = file.filename().string();
  const std::size_t mark = name.rfind(unfinished);
  if (mark == std::string::npos || mark == 0 || name.front() != '.') {
    return false;
  }
  // Temporary map files keep their extension, which identifies the format: .NAME.123.thawslide-part.tif.
  const std::size_t end = mark + unfinished.size();
  const std::size_t before_number = name.find_last_not_of("0123456789", mark - 1);
  return (end == name.size() || name[end] == '.') && before_number > 0 && before_number + 1 < mark &&
         name[before_number] == '.';
}

fs::path name_for_damaged(const fs::path& file) {
  const std::string stem = (file.parent_path() / file.stem()).string(), extension = file.extension().string();
  fs::path free = stem + ".damaged" + extension;
  for (int number = 2; fs::exists(free); ++number) {
    free = fmt::format("{}.damaged.{}{}", stem, number, extension);
  }
  return free;
}

void remove_unfinished_files(const fs::path& folder) {
  if (fs::is_symlink(folder) || !fs::is_directory(folder)) {
    return;
  }
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_unfinished(entry.path()) && entry.symlink_status().type() == fs::file_type::regular) {
      found.push_back(entry.path());
    }
  }
  for (const fs::path& file : found) {
    remove_or_throw(file);
  }
}

void remove_or_throw(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) {
    throw WriteError(
        fmt::format("cannot remove {}: {}. Check that the folder may be written to.", file.string(), error.message()));
  }
}

void copy_file_atomically(const fs::path& file, const fs::path& copy, std::string_view content) {
  const fs::path temporary = temporary_name(copy);
  const int from = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const int to = create_file(temporary);
  bool is_cloned = from >= 0 && to >= 0 && ioctl(to, FICLONE, from) == 0 && fsync(to) == 0;
  for (const int descriptor : {from, to}) {
    is_cloned = (descriptor < 0 || close(descriptor) == 0) && is_cloned;
  }
  if (is_cloned && rename(temporary.c_str(), copy.c_str()) == 0 && synchronise_folder(copy.parent_path())) {
    return;
  }
  std::error_code ignored;
  fs::remove(temporary, ignored);
  write_file_atomically(copy, content);
}

std::string read_file(const fs::path& file) {
  const auto fail_to_read = [&file](int reason) {
    throw UserError(fmt::format("cannot read {}: {}", file.string(), std::strerror(reason)));
  };
  require_regular(file);
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    fail_to_read(errno);
  }
  struct stat facts {};
  const bool is_regular = fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode);
  std::string text;
  const int reason = is_regular ? read_to_end(descriptor, static_cast<std::size_t>(facts.st_size), text) : EINVAL;
  close(descriptor);
  if (reason != 0) {
    fail_to_read(reason);
  }
  return text;
}

void require_regular(const fs::path& file) {
  if (const std::string found = config::what_stands_at(file); !found.empty()) {
    throw UserError(fmt::format(
        "{} is {}, where a regular file is needed. Put the file itself there, or remove what stands in its place.",
        file.string(), found));
  }
}

}  // namespace thawslide::io
