// history.csv: one row a moment, appended with one write each, so that a killed run keeps whole rows.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace thawslide::io {

class HistoryWriter {
 public:
  using Row = std::vector<std::pair<std::string, double>>;  // column, value

  // Starts the file anew. Throws WriteError if it cannot be written.
  explicit HistoryWriter(const std::filesystem::path& file);
  // Goes on with a file: keeps its rows up to `time` (its first column) and appends.
  static HistoryWriter continue_after(const std::filesystem::path& file, double time);

  HistoryWriter(HistoryWriter&& other) noexcept;
  HistoryWriter& operator=(HistoryWriter&&) = delete;
  ~HistoryWriter();

  // The first row brings the header; all rows must have its columns.
  void add(const Row& row);
  // Returns when all rows are on the disk. Throws WriteError.
  void synchronise() const;

 private:
  HistoryWriter(const std::filesystem::path& file, int descriptor, std::string header);
  void append(const std::string& text);

  std::filesystem::path file_;
  int descriptor_;
  std::string header_;
};

// The shortest decimal text that reads back as the same number.
std::string shortest(double value);

}  // namespace thawslide::io
