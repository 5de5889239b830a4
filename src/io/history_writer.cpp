#include "io/history_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

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

// First number of a row with `columns` numbers; empty for a damaged row.
std::optional<double> time_of(std::string_view row, std::size_t columns) {
  std::optional<double> time;
  for (std::size_t k = 0; k < columns; ++k) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(row.data(), row.data() + row.size(), number);
    const bool is_last = k + 1 == columns;
    if (error != std::errc() || (end == row.data() + row.size()) != is_last || (!is_last && *end != ',')) {
      return std::nullopt;
    }
    time = time.value_or(number);
    row.remove_prefix(is_last ? row.size() : static_cast<std::size_t>(end - row.data()) + 1);
  }
  return time;
}

// Complete rows of a file up to a time, in ascending order.
class KeptRows {
 public:
  KeptRows(std::string_view file, const std::string& header, double last_time)
      : text_(header + "\n"), has_header_(file.substr(0, text_.size()) == text_) {
    const auto columns = static_cast<std::size_t>(std::ranges::count(header, ',')) + 1;
    for (std::size_t line = has_header_ ? text_.size() : file.find('\n') + 1; line < file.size();) {
      const std::size_t end = std::min(file.find('\n', line), file.size());
      const std::optional<double> time = time_of(file.substr(line, end - line), columns);
      if (time && end < file.size() && *time <= last_time && (times_.empty() || *time > times_.back())) {
        times_.push_back(*time);
        text_ += file.substr(line, end + 1 - line);
      }
      line = end + 1;
    }
  }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] HistoryExtent extent() const {
    return {times_.size(), text_.size(), times_.empty() ? 0.0 : times_.back()};
  }
  [[nodiscard]] bool lacks_any(const HistoryExtent& then) const { return times_.size() < then.rows; }
  // Warning if the file differs from what the run wrote; empty otherwise.
  [[nodiscard]] std::string warning(const std::filesystem::path& file, bool is_present,
                                    const HistoryExtent& then) const {
    const std::string name = file.filename().string();
    if (!is_present) {
      return fmt::format("{} was missing: it starts again, without the {} rows up to t = {:g} s", name, then.rows,
                         then.last_time);
    }
    if (lacks_any(then)) {
      return fmt::format("{} lacks {} of the {} rows up to t = {:g} s, which are missing or damaged", name,
                         then.rows - times_.size(), then.rows, then.last_time);
    }
    return has_header_ && times_.size() == then.rows && text_.size() == then.bytes
               ? ""
               : fmt::format("{} is not as the run wrote it; its rows are complete and are kept", name);
  }

 private:
  std::string text_;  // including the header
  bool has_header_;
  std::vector<double> times_;
};

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
  if (!std::filesystem::exists(file)) {
    return std::nullopt;
  }
  const std::string text = read_file(file);
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos || end == 0) {
    return std::nullopt;
  }
  const std::size_t before = text.rfind('\n', end - 1);
  if (before == std::string::npos) {
    return std::nullopt;  // only the header
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
  const KeptRows kept(text, header, then.last_time);
  if (std::string warning = kept.warning(file, is_present, then); !warning.empty()) {
    if (is_present && kept.lacks_any(then)) {
      const std::filesystem::path aside = name_for_damaged(file);
      write_file_atomically(aside, text);
      warning += fmt::format("; what there was is kept as {}", aside.filename().string());
    }
    warnings.push_back(std::move(warning));
  }
  write_file_atomically(file, kept.text());
  HistoryWriter writer(file, open_or_throw(file, O_NOFOLLOW), header);
  writer.extent_ = kept.extent();
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
