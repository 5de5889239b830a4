// CSV files: history.csv and probes.csv, whose rows are appended with a single write each, and profiles.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/profile_csv.hpp"

namespace thawslide::io {

// Extent of a history at a given time.
struct HistoryExtent {
  std::size_t rows = 0, bytes = 0;  // bytes: including the header
  double last_time = 0.0;           // of the last row [s]
};

class HistoryWriter {
 public:
  using Row = std::vector<std::pair<std::string, double>>;  // column, value

  // Creates a file specified by the user, maybe a link or a terminal. Throws WriteError if it cannot be written.
  explicit HistoryWriter(const std::filesystem::path& file);
  // Creates a file in a run folder: an existing file, link or pipe is replaced, and the target of a link is kept.
  static HistoryWriter start_in_run(const std::filesystem::path& file);
  // Continues a file that once had the extent `then` and these columns. Otherwise, it starts again, with a warning.
  static HistoryWriter continue_after(const std::filesystem::path& file, const std::string& header,
                                      const HistoryExtent& then, std::vector<std::string>& warnings);

  HistoryWriter(HistoryWriter&& other) noexcept;
  HistoryWriter& operator=(HistoryWriter&&) = delete;
  ~HistoryWriter();

  // Adds a row; the first row defines the header, and all rows must have its columns.
  void add(const Row& row);
  // Returns after all rows have reached the disk. Throws WriteError.
  void synchronize() const;
  [[nodiscard]] const HistoryExtent& extent() const { return extent_; }

 private:
  HistoryWriter(const std::filesystem::path& file, int descriptor, std::string header);
  void append(const std::string& text);

  std::filesystem::path file_;
  int descriptor_;
  std::string header_;
  HistoryExtent extent_;
};

// Header line with the columns of a row.
std::string header_of(const HistoryWriter::Row& row);

// Time of the last complete row of a file; empty if there is none. Throws UserError if it cannot be read.
std::optional<double> last_time_in_history(const std::filesystem::path& file);

// Shortest decimal text that reads back to the same number.
std::string shortest(double value);

// Columns distance_m, terrain_elevation_m, and surface_elevation_m if there is one, after the comments.
void write_profile_csv(const std::filesystem::path& file, const config::ProfileTable& profile,
                       const std::vector<std::string>& comments = {});

}  // namespace thawslide::io
