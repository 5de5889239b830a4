#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/error.hpp"

namespace thawslide::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const fs::path& temporary, int reason) {
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw UserError(
      fmt::format("cannot write {}: {}. Check that the folder exists, may be written to, and that the disk has "
                  "room.",
                  file.string(), std::strerror(reason)));
}

}  // namespace

void write_file_atomically(const fs::path& file, const void* data, std::size_t bytes) {
  const fs::path temporary = file.string() + fmt::format(".{}.part", getpid());
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
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
  if (fsync(descriptor) != 0 || close(descriptor) != 0 || rename(temporary.c_str(), file.c_str()) != 0) {
    fail(file, temporary, errno);
  }
}

void write_file_atomically(const fs::path& file, std::string_view text) {
  write_file_atomically(file, text.data(), text.size());
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
