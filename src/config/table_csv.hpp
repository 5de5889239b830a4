// CSV table in raw form: encodings, line ends, quotes, and the line number of every row.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace thawslide::config {

struct TableCsv {
  struct Row {
    int line;
    std::vector<std::string> cells;
  };
  std::vector<std::string> columns;
  int line = 0;  // of the header
  std::vector<Row> rows;
};

// Skips empty lines and those that begin with #. Throws UserError, with the line, if the file is not UTF-8 text, lacks
// a column that is `needed`, or has one twice. Rows may have more or fewer cells than there are columns.
TableCsv read_table_csv(const std::filesystem::path& file, const std::vector<std::string>& needed, double max_bytes);

// Throws UserError for a column that is not allowed.
void require_known_columns(const TableCsv& table, const std::string& file, const std::vector<std::string>& allowed);
// Text such as "; did you mean value?", or ".".
[[nodiscard]] std::string hint_of(const std::string& word, const std::vector<std::string>& known);

// Reads the finite number of a cell; returns the problem, "" if there is none.
std::string read_finite_number(const std::string& cell, double& value);

}  // namespace thawslide::config
