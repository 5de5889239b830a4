// A table of comma-separated cells as it comes: encodings, line ends, quotes, and the line of every row.
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
  int line = 0;  // of the columns
  std::vector<Row> rows;
};

// Empty lines and those that begin with # are left out. Throws UserError, with the line, where the file is no text in
// UTF-8, lacks a column that is `needed`, or has one twice. Rows may have more or fewer cells than there are columns.
TableCsv read_table_csv(const std::filesystem::path& file, const std::vector<std::string>& needed, double most_bytes);

// Reads the finite number of a cell; returns what is wrong with it, "" for nothing.
std::string read_finite_number(const std::string& cell, double& value);

}  // namespace thawslide::config
