#include "io/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "config/input_limits.hpp"

namespace thawslide::io {

namespace {

namespace fs = std::filesystem;

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

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw WriteError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  }
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
