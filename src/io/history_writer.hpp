// history.csv: one row a moment, appended with one write each, so that a killed run keeps whole rows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thawslide::io {

// How much a history held at a moment.
struct HistoryExtent {
  std::size_t rows = 0, bytes = 0;  // bytes: with the header
  double last_time = 0.0;           // of its last row [s]
};

class HistoryWriter {
 public:
  using Row = std::vector<std::pair<std::string, double>>;  // column, value

  // Starts the file anew, which a user has named: a link is followed, and it may be a terminal. Throws WriteError if it
  // cannot be written.
  explicit HistoryWriter(const std::filesystem::path& file);
  // The same for a file of a run: what stands in its place, be it a link or a pipe, is replaced, and what a link leads
  // to stays.
  static HistoryWriter start_in_run(const std::filesystem::path& file);
  // Goes on with a file that once held `then`, with these columns: keeps whole rows up to there and appends. Where some
  // of them are not there any more the file is kept beside, and a note says which.
  static HistoryWriter continue_after(const std::filesystem::path& file, const std::string& header,
                                      const HistoryExtent& then, std::vector<std::string>& warnings);

  HistoryWriter(HistoryWriter&& other) noexcept;
  HistoryWriter& operator=(HistoryWriter&&) = delete;
  ~HistoryWriter();

  // The first row brings the header; all rows must have its columns.
  void add(const Row& row);
  // Returns when all rows are on the disk. Throws WriteError.
  void synchronise() const;
  [[nodiscard]] const HistoryExtent& extent() const { return extent_; }

 private:
  HistoryWriter(const std::filesystem::path& file, int descriptor, std::string header);
  void append(const std::string& text);

  std::filesystem::path file_;
  int descriptor_;
  std::string header_;
  HistoryExtent extent_;
};

// Its columns, as the first line of the file names them.
std::string header_of(const HistoryWriter::Row& row);

// The time of the last whole row of a file; nothing before there is one. Throws UserError if it cannot be read.
std::optional<double> last_time_in_history(const std::filesystem::path& file);

// The shortest decimal text that reads back as the same number.
std::string shortest(double value);

}  // namespace thawslide::io
