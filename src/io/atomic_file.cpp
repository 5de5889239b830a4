#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "base/error.hpp"

namespace thawslide::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const fs::path& temporary, int reason) {
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw WriteError(
      fmt::format("cannot write {}: {}. Check that the folder exists, may be written to, and that the disk has "
                  "room.",
                  file.string(), std::strerror(reason)));
}

constexpr const char* unfinished = ".part";

// That a file has its name must reach the disk too.
bool synchronise_folder(const fs::path& folder) {
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  const bool done = descriptor >= 0 && (fsync(descriptor) == 0 || errno == EINVAL);  // some file systems have no such
  return (descriptor < 0 || close(descriptor) == 0) && done;
}

}  // namespace

void write_file_atomically(const fs::path& file, const void* data, std::size_t bytes, const fs::path& previous) {
  const fs::path temporary = file.string() + fmt::format(".{}{}", getpid(), unfinished);
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW, 0666);
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
  // Files of maps keep their own ending, by which they are told: NAME.123.part.tif.
  const fs::path part = file.extension() == unfinished ? file.stem() : file.stem().stem();
  const bool is_part = file.extension() == unfinished || file.stem().extension() == unfinished;
  const std::string process = part.extension().string();
  return is_part && process.size() > 1 && process.find_first_not_of("0123456789", 1) == std::string::npos;
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
    fs::remove(file);
  }
}

void copy_file_atomically(const fs::path& file, const fs::path& copy, std::string_view content) {
  const fs::path temporary = copy.string() + fmt::format(".{}{}", getpid(), unfinished);
  const int from = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const int to = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
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
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  const bool is_empty = stream.peek() == std::ifstream::traits_type::eof() && stream.eof() && !stream.bad();
  if (!is_empty && !(stream && text << stream.rdbuf())) {
    throw UserError(fmt::format("cannot read {}: {}", file.string(), std::strerror(errno)));
  }
  return text.str();
}

}  // namespace thawslide::io
