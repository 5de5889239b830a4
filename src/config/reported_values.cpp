#include "config/reported_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "base/error.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"
#include "config/reported_quantities.hpp"
#include "config/table_csv.hpp"

namespace thawslide::config {

namespace {

const std::vector<std::string> needed{"quantity", "value", "unit"};
const std::map<std::string, double> seconds_of{{"time_s", 1.0}, {"time_min", 60.0}, {"time_h", 3600.0}};
const std::vector<std::string> allowed{"quantity", "value", "unit", "time_s", "time_min", "time_h", "source", "kind"};
const std::vector<std::string> kinds{"observation", "model", "assumption"};

std::string format_unit(const std::string& unit) {
  return unit.empty() || unit == "-" || unit == "1" ? "" : " " + unit;
}

std::string hint(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest(shown(word), known);
  return near.empty() ? "." : "; did you mean " + near + "?";
}

class TargetsReader {
 public:
  explicit TargetsReader(std::string file) : file_(std::move(file)) {}

  ReportedValues read() {
    try {
      const TableCsv table = read_table_csv(file_, needed, largest_targets_file);
      set_columns(table);
      for (const TableCsv::Row& row : table.rows) {
        read_row(row);
      }
    } catch (const UserError& error) {
      found_.mistakes.emplace_back(error.what());
      return std::move(found_);
    }
    refuse_times_before_the_run();
    return std::move(found_);
  }

 private:
  void add(int line, const std::string& words) {
    found_.mistakes.push_back(fmt::format("{}:{}: {}", file_, line, words));
  }

  void set_columns(const TableCsv& table) {
    std::vector<std::string> times;
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const std::string& name = table.columns[k];
      if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
        throw UserError(fmt::format("{}:{}: no column is called {}{} allowed are {}", file_, table.line,
                                    in_quotes(name), hint(name, allowed), comma_list(allowed)));
      }
      if (seconds_of.count(name) > 0) {
        times.push_back(name);
      }
      column_[name] = k;
    }
    if (times.size() != 1) {
      throw UserError(fmt::format("{}:{}: give one column of times, time_s, time_min, time_h; found {}", file_,
                                  table.line, times.empty() ? "none" : fmt::format("{}", fmt::join(times, " and "))));
    }
    time_ = times.front();
  }

  void read_row(const TableCsv::Row& row) {
    if (row.cells.size() != column_.size()) {
      add(row.line, fmt::format("{} values for {} columns", row.cells.size(), column_.size()));
      return;
    }
    const std::string& name = row.cells[column_.at("quantity")];
    const std::string source = column_.count("source") > 0 ? row.cells[column_.at("source")] : "";
    double time = 0.0;
    const std::string mistake = mistake_in(row, name, time);
    if (!mistake.empty()) {
      add(row.line, mistake);
      return;
    }
    const auto [first, is_new] = lines_.emplace(std::tuple(name, time, source), row.line);
    if (!is_new) {
      add(row.line, fmt::format("{} at this time from this source is in line {} already; keep one of the two, or give "
                                "them different sources",
                                name, first->second));
      return;
    }
    if (name == sets_clock) {
      if (found_.has_clock) {
        add(row.line, fmt::format("{} is in line {} already; one row sets the clock", sets_clock, clock_line_));
      }
      found_.has_clock = true;
      clock_line_ = row.line;
    }
    found_.values.push_back({name, time, row.line, reported_quantity(name)->is_of_a_time});
  }

  // Returns an empty text if there is no mistake, and sets `time` [s].
  std::string mistake_in(const TableCsv::Row& row, const std::string& name, double& time) const {
    if (const std::string mistake = mistake_in_periods(name); !mistake.empty()) {
      return mistake;
    }
    const ReportedQuantity* quantity = reported_quantity(name);
    if (quantity == nullptr) {
      std::vector<std::string> known;
      for (const ReportedQuantity& each : reported_quantities()) {
        known.emplace_back(each.name);
      }
      return fmt::format(
          "no quantity is called {}{} There are: {}; and {}_35_150_s for a force between periods of 35 and 150 s",
          in_quotes(name), hint(name, known), comma_list(known), reported_force);
    }
    const std::string& unit_name = row.cells[column_.at("unit")];
    const auto& units = *quantity->units;
    const auto unit =
        std::find_if(units.begin(), units.end(), [&](const auto& each) { return unit_name == each.name; });
    if (unit == units.end()) {
      std::vector<std::string> known;
      for (const ReportedUnit& each : units) {
        if (*each.name != '\0') {
          known.emplace_back(each.name);
        }
      }
      return fmt::format("{} for {}; allowed: {}", unit_name.empty() ? "no unit" : "the unit " + in_quotes(unit_name),
                         name, comma_list(known));
    }
    if (const auto column = column_.find("kind"); column != column_.end()) {
      const std::string& kind = row.cells[column->second];
      if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
        return fmt::format("{} for {}; allowed: {}", kind.empty() ? "no kind" : "the kind " + in_quotes(kind), name,
                           comma_list(kinds));
      }
    }
    double given = 0.0;
    for (const auto& [column, number] : {std::pair(std::string("value"), &given), std::pair(time_, &time)}) {
      if (const std::string mistake = read_finite_number(row.cells[column_.at(column)], *number); !mistake.empty()) {
        return mistake;
      }
    }
    time *= seconds_of.at(time_);
    const double value = unit->factor * given + unit->offset;
    if (!std::isfinite(value) || !std::isfinite(time)) {
      return name + ": a number that large cannot be converted";
    }
    if (value < quantity->low || value > quantity->high) {
      return fmt::format("{} is {:g}{}; allowed: {}", name, given, format_unit(unit_name), range_of(*quantity));
    }
    return "";
  }

  static std::string range_of(const ReportedQuantity& quantity) {
    const std::string unit = format_unit(quantity.units->front().name);
    std::vector<std::string> ends;
    if (std::isfinite(quantity.low)) {
      ends.push_back(fmt::format("at least {:g}{}", quantity.low, unit));
    }
    if (std::isfinite(quantity.high)) {
      ends.push_back(fmt::format("at most {:g}{}", quantity.high, unit));
    }
    return comma_list(ends);
  }

  // With a separate clock, only the run can determine when the times are.
  void refuse_times_before_the_run() {
    for (const ReportedValue& value : found_.values) {
      if (value.is_of_a_time && value.time < 0.0 && !found_.has_clock) {
        add(value.line,
            fmt::format("{} is of {:g} s, before the run; allowed: 0 s and later, or a row {} that sets their clock",
                        value.quantity, value.time, sets_clock));
      }
    }
  }

  std::string file_, time_;
  std::map<std::string, std::size_t> column_;
  std::map<std::tuple<std::string, double, std::string>, int> lines_;
  int clock_line_ = 0;
  ReportedValues found_;
};

}  // namespace

std::string warning_of_late_values(const Case& parameters) {
  if (parameters.report.targets.empty()) {
    return "";
  }
  const std::filesystem::path file = parameters.report.targets;
  const ReportedValues reported = read_reported_values(file);
  std::vector<ReportedValue> late;
  std::copy_if(reported.values.begin(), reported.values.end(), std::back_inserter(late), [&](const auto& value) {
    return value.is_of_a_time && value.time > parameters.time.end && !reported.has_clock;
  });
  return late.empty() ? ""
                      : fmt::format(
                            "{}: report.targets is {}: {} of its values {} later than the run, which ends at {} s: "
                            "{} of {} s in line {}. The run is not compared with {}.",
                            location_of(parameters, "report.targets"), file.filename().string(), late.size(),
                            late.size() == 1 ? "is" : "are", parameters.time.end, late.front().quantity,
                            late.front().time, late.front().line, late.size() == 1 ? "it" : "them");
}

ReportedValues read_reported_values(const std::filesystem::path& file) { return TargetsReader(file.string()).read(); }

}  // namespace thawslide::config
