#include "io/history_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "io/files.hpp"

namespace thawslide::io {

namespace {

int open_or_throw(const std::filesystem::path& file, int flags) {
  const int descriptor = open(file.c_str(), flags | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    throw WriteError("cannot write {}: {}", file.string(), std::strerror(errno));
  }
  return descriptor;
}

// True for a header and the rows of this extent, by their number and the time of the last.
bool are_rows(const std::string& text, const std::string& header, const HistoryExtent& then) {
  const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n'));
  if (text.rfind(header + "\n", 0) != 0 || text.back() != '\n' || lines != then.rows + 1) {
    return false;
  }
  const std::string last = "\n" + shortest(then.last_time);
  return then.rows == 0 || text.compare(text.rfind('\n', text.size() - 2), last.size(), last) == 0;
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

std::string header_of(const HistoryWriter::Row& row) {
  std::string header;
  for (const auto& [name, value] : row) {
    header += (header.empty() ? "" : ",") + name;
  }
  return header;
}

std::optional<double> last_time_in_history(const std::filesystem::path& file) {
  const std::string text = std::filesystem::exists(file) ? read_file(file) : "";
  const std::size_t end = text.rfind('\n');
  const std::size_t before = end == 0 || end == std::string::npos ? std::string::npos : text.rfind('\n', end - 1);
  if (before == std::string::npos) {
    return std::nullopt;  // at most the header
  }
  double time = 0.0;
  const auto parsed = std::from_chars(text.data() + before + 1, text.data() + end, time);
  return parsed.ec == std::errc() && std::isfinite(time) ? std::optional(time) : std::nullopt;
}

HistoryWriter::HistoryWriter(const std::filesystem::path& file, int descriptor, std::string header)
    : file_(file), descriptor_(descriptor), header_(std::move(header)) {}

HistoryWriter::HistoryWriter(const std::filesystem::path& file)
    : HistoryWriter(file, open_or_throw(file, O_CREAT | O_TRUNC), "") {}

HistoryWriter HistoryWriter::start_in_run(const std::filesystem::path& file) {
  remove_or_throw(file);
  return {file, open_or_throw(file, O_CREAT | O_EXCL), ""};
}

HistoryWriter HistoryWriter::continue_after(const std::filesystem::path& file, const std::string& header,
                                            const HistoryExtent& then, std::vector<std::string>& warnings) {
  const bool is_present = std::filesystem::exists(file);
  const std::string text = is_present ? read_file(file) : "";
  std::string kept = text.substr(0, then.bytes);
  HistoryExtent extent = then;
  if (kept.size() != then.bytes || !are_rows(kept, header, then)) {
    std::string warning =
        fmt::format("{} {}: it starts again, without the {} rows up to t = {:g} s", file.filename().string(),
                    is_present ? "is damaged or was changed" : "was missing", then.rows, then.last_time);
    if (is_present) {
      const std::filesystem::path aside = name_for_damaged(file);
      write_file_atomically(aside, text);
      warning += fmt::format("; what there was is kept as {}", aside.filename().string());
    }
    warnings.push_back(std::move(warning));
    kept = header + "\n";
    extent = {0, kept.size(), 0.0};
  }
  write_file_atomically(file, kept);
  HistoryWriter writer(file, open_or_throw(file, O_NOFOLLOW), header);
  writer.extent_ = extent;
  return writer;
}

HistoryWriter::HistoryWriter(HistoryWriter&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      header_(std::move(other.header_)),
      extent_(other.extent_) {}

HistoryWriter::~HistoryWriter() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

void HistoryWriter::add(const Row& row) {
  const std::string header = header_of(row);
  std::string line;
  for (const auto& [name, value] : row) {
    line += (line.empty() ? "" : ",") + shortest(value);
  }
  if (header_.empty()) {
    header_ = header;
    append(header + "\n");
  }
  THAWSLIDE_ASSERT(header == header_, "columns changed from {} to {}", header_, header);
  append(line + "\n");
  ++extent_.rows;
  extent_.last_time = row.front().second;
}

void HistoryWriter::synchronize() const {
  if (fsync(descriptor_) != 0 && errno != EINVAL) {  // EINVAL: not a file, such as a terminal
    throw WriteError("cannot write {}: {}", file_.string(), std::strerror(errno));
  }
}

void HistoryWriter::append(const std::string& text) {
  const ssize_t written = write(descriptor_, text.data(), text.size());
  if (written != static_cast<ssize_t>(text.size())) {
    throw WriteError("cannot write {}: {}. The disk may be full.", file_.string(),
                     written < 0 ? std::strerror(errno) : "only part of a row was written");
  }
  extent_.bytes += text.size();
}

void write_profile_csv(const std::filesystem::path& file, const config::ProfileTable& profile,
                       const std::vector<std::string>& comments) {
  THAWSLIDE_ASSERT(profile.distance.size() == profile.terrain.size() &&
                       (profile.surface.empty() || profile.surface.size() == profile.terrain.size()),
                   "{} distances, {} elevations, {} of a surface", profile.distance.size(), profile.terrain.size(),
                   profile.surface.size());
  std::string text;
  for (const std::string& comment : comments) {
    text += "# " + comment + "\n";
  }
  text += profile.surface.empty() ? "distance_m,terrain_elevation_m\n"
                                  : "distance_m,terrain_elevation_m,surface_elevation_m\n";
  for (std::size_t k = 0; k < profile.distance.size(); ++k) {
    text += shortest(profile.distance[k]) + "," + shortest(profile.terrain[k]);
    text += profile.surface.empty() ? "\n" : "," + shortest(profile.surface[k]) + "\n";
  }
  write_file_atomically(file, text);
}

}  // namespace thawslide::io
