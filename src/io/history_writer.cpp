#include "io/history_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "io/atomic_file.hpp"

namespace thawslide::io {

namespace {

int open_or_throw(const std::filesystem::path& file, int flags) {
  const int descriptor = open(file.c_str(), flags | O_WRONLY | O_APPEND, 0666);
  if (descriptor < 0) {
    throw WriteError(fmt::format("cannot write {}: {}", file.string(), std::strerror(errno)));
  }
  return descriptor;
}

}  // namespace

std::string shortest(double value) {
  if (std::isnan(value)) {
    return "nan";
  }
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  THAWSLIDE_ASSERT(error == std::errc(), "{} does not fit", value);
  return {buffer, end};
}

HistoryWriter::HistoryWriter(const std::filesystem::path& file, int descriptor, std::string header)
    : file_(file), descriptor_(descriptor), header_(std::move(header)) {}

HistoryWriter::HistoryWriter(const std::filesystem::path& file)
    : HistoryWriter(file, open_or_throw(file, O_CREAT | O_TRUNC), "") {}

HistoryWriter HistoryWriter::continue_after(const std::filesystem::path& file, double time) {
  const std::string text = read_file(file);
  const std::size_t header_end = text.find('\n');
  if (header_end == std::string::npos) {
    throw UserError(fmt::format("{} has no header line; the run cannot be continued", file.string()));
  }
  std::size_t kept = header_end + 1;
  for (std::size_t line = kept; line < text.size();) {
    const std::size_t end = text.find('\n', line);
    double at = 0.0;
    const auto parsed = std::from_chars(text.data() + line, text.data() + text.size(), at);
    if (end == std::string::npos || parsed.ec != std::errc() || at > time * (1.0 + 1e-12)) {
      break;
    }
    kept = line = end + 1;
  }
  write_file_atomically(file, std::string_view(text).substr(0, kept));
  return {file, open_or_throw(file, 0), text.substr(0, header_end)};
}

HistoryWriter::HistoryWriter(HistoryWriter&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      header_(std::move(other.header_)) {}

HistoryWriter::~HistoryWriter() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

void HistoryWriter::add(const Row& row) {
  std::string header;
  std::string line;
  for (const auto& [name, value] : row) {
    header += (header.empty() ? "" : ",") + name;
    line += (line.empty() ? "" : ",") + shortest(value);
  }
  if (header_.empty()) {
    header_ = header;
    append(header + "\n");
  }
  THAWSLIDE_ASSERT(header == header_, "columns changed from {} to {}", header_, header);
  append(line + "\n");
}

void HistoryWriter::synchronise() const {
  if (fsync(descriptor_) != 0 && errno != EINVAL) {  // EINVAL: what is no file, such as a terminal
    throw WriteError(fmt::format("cannot write {}: {}", file_.string(), std::strerror(errno)));
  }
}

void HistoryWriter::append(const std::string& text) {
  const ssize_t written = write(descriptor_, text.data(), text.size());
  if (written != static_cast<ssize_t>(text.size())) {
    throw WriteError(fmt::format("cannot write {}: {}. The disk may be full.", file_.string(),
                                 written < 0 ? std::strerror(errno) : "only part of a row was written"));
  }
}

}  // namespace thawslide::io
