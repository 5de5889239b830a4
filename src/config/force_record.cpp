#include "config/force_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "base/error.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"
#include "config/table_csv.hpp"

namespace thawslide::config {

namespace {

const std::vector<std::string> needed{"time_s", "up_N", "north_N", "east_N"};
const std::vector<std::string> parts{"up", "north", "east"};
const std::vector<std::string> of_range{"up_low_N",     "up_high_N",  "north_low_N",
                                        "north_high_N", "east_low_N", "east_high_N"};

bool is_among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Throws UserError for an unknown column, a row of another length, or an incomplete range.
void check_columns(const TableCsv& table, const std::string& file) {
  std::vector<std::string> allowed = needed, absent;
  allowed.insert(allowed.end(), of_range.begin(), of_range.end());
  require_known_columns(table, file, allowed);
  for (const TableCsv::Row& row : table.rows) {
    if (row.cells.size() != table.columns.size()) {
      throw UserError(
          fmt::format("{}:{}: {} values for {} columns", file, row.line, row.cells.size(), table.columns.size()));
    }
  }
  std::copy_if(of_range.begin(), of_range.end(), std::back_inserter(absent),
               [&](const std::string& name) { return !is_among(name, table.columns); });
  if (!absent.empty() && absent.size() < of_range.size()) {
    throw UserError(
        fmt::format("{}:{}: the range is not complete (found no {}; allowed: all of {}, or none). Add what is missing.",
                    file, table.line, comma_list(absent), comma_list(of_range)));
  }
}

using Cells = std::map<std::string, std::string>;

// Returns the numbers of a row by column; throws UserError for a cell without a number.
std::map<std::string, double> numbers_of(const Cells& cells, const std::vector<std::string>& columns,
                                         const std::string& location) {
  std::map<std::string, double> numbers;
  for (const std::string& name : columns) {
    if (const std::string mistake = read_finite_number(cells.at(name), numbers[name]); !mistake.empty()) {
      throw UserError(location + mistake);
    }
  }
  return numbers;
}

}  // namespace

std::string mistake_in_force_record(const std::filesystem::path& file) {
  const std::string name = file.string();
  try {
    const TableCsv table = read_table_csv(file, needed, largest_targets_file);
    check_columns(table, name);
    if (table.rows.size() < 2) {
      return fmt::format("{}: too few rows (found {}; allowed: 2 or more). Add the history.", name, table.rows.size());
    }
    const bool has_range = is_among(of_range.front(), table.columns);
    double last_time = -std::numeric_limits<double>::infinity();
    std::string last_text;
    for (const TableCsv::Row& row : table.rows) {
      Cells cells;
      for (std::size_t k = 0; k < row.cells.size(); ++k) {
        cells[table.columns[k]] = row.cells[k];
      }
      const std::string location = fmt::format("{}:{}: ", name, row.line);
      const std::map<std::string, double> numbers = numbers_of(cells, table.columns, location);
      if (!(numbers.at("time_s") > last_time)) {
        return fmt::format(
            "{}time_s does not rise (found {} after {}; allowed: more than that). Sort the rows by time.", location,
            cells.at("time_s"), last_text);
      }
      last_time = numbers.at("time_s");
      last_text = cells.at("time_s");
      for (const std::string& part : has_range ? parts : std::vector<std::string>{}) {
        const std::string low = part + "_low_N", high = part + "_high_N", best = part + "_N";
        if (numbers.at(best) < numbers.at(low) || numbers.at(best) > numbers.at(high)) {
          return fmt::format("{}{} is outside its range (found {}; allowed: {} to {}). Correct one of the three.",
                             location, best, cells.at(best), cells.at(low), cells.at(high));
        }
      }
    }
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

}  // namespace thawslide::config
