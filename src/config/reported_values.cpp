#include "config/reported_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"
#include "config/table_csv.hpp"

namespace thawslide::config {

namespace {

struct ReportedUnit {
  const char* name;
  double factor = 1.0;  // to the first unit of its quantity
  double offset = 0.0;
};

struct ReportedQuantity {
  const char* name;
  const std::vector<ReportedUnit>* units;
  double low, high;  // allowed, in the first unit
  bool is_of_a_time;
};

constexpr const char* sets_clock = "start_velocity";
constexpr const char* reported_force = "max_seismic_force";

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double absolute_zero = -273.15;                       // C
constexpr double shortest_period = 1e-3, longest_period = 1e5;  // s
constexpr double degrees_per_radian = 57.29577951308232;

// Number of digits with an optional decimal point between them, and nothing else.
std::optional<double> plain_decimal(const std::string& text) {
  constexpr const char* digits = "0123456789";
  const std::size_t point = text.find('.');
  const auto is_whole = [&](const std::string& part) {
    return !part.empty() && part.find_first_not_of(digits) == std::string::npos;
  };
  if (!is_whole(text.substr(0, point)) || (point != std::string::npos && !is_whole(text.substr(point + 1)))) {
    return std::nullopt;
  }
  double value = unbounded;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Periods [s] in NAME_35_150_s, a force between periods.
std::optional<std::pair<double, double>> periods_of(const std::string& name) {
  const std::string prefix = std::string(reported_force) + "_", suffix = "_s";
  if (name.size() <= prefix.size() + suffix.size() || name.compare(0, prefix.size(), prefix) != 0 ||
      name.compare(name.size() - suffix.size(), suffix.size(), suffix) != 0) {
    return std::nullopt;
  }
  const std::string between = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  const std::size_t parting = between.find('_');
  if (parting == std::string::npos) {
    return std::nullopt;
  }
  const auto shortest = plain_decimal(between.substr(0, parting)), longest = plain_decimal(between.substr(parting + 1));
  return shortest && longest ? std::optional(std::pair(*shortest, *longest)) : std::nullopt;
}

const std::vector<ReportedQuantity>& reported_quantities() {
  static const std::vector<ReportedUnit> length{{"m"}, {"km", 1e3}, {"cm", 1e-2}}, speed{{"m/s"}, {"km/h", 1.0 / 3.6}},
      temperature{{"C"}, {"degC"}, {"°C"}, {"K", 1.0, absolute_zero}},
      force{{"N"}, {"kN", 1e3}, {"MN", 1e6}, {"GN", 1e9}, {"TN", 1e12}},
      pressure{{"Pa"}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}},
      area{{"m2"}, {"m²"}, {"ha", 1e4}, {"km2", 1e6}, {"km²", 1e6}},
      volume{{"m3"}, {"m³"}, {"million m3", 1e6}, {"million m³", 1e6}, {"km3", 1e9}, {"km³", 1e9}},
      angle{{"degrees"}, {"deg"}, {"°"}, {"rad", degrees_per_radian}}, fraction{{"-"}, {"1"}, {""}, {"%", 1e-2}};
  static const std::vector<ReportedQuantity> all{
      {sets_clock, &speed, 0.0, unbounded, false},
      {"mean_velocity", &speed, 0.0, unbounded, true},
      {"mean_displacement", &length, 0.0, unbounded, true},
      {"front_distance", &length, 0.0, unbounded, true},
      {"band_SL", &fraction, 0.0, 1.0, true},
      {"band_saturation", &fraction, 0.0, 1.0, true},
      {"band_temperature", &temperature, absolute_zero, unbounded, true},
      {"band_pore_pressure", &pressure, -unbounded, unbounded, true},
      {"band_friction_coefficient", &fraction, 0.0, unbounded, true},
      {reported_force, &force, 0.0, unbounded, false},
      {"source_volume", &volume, 0.0, unbounded, false},
      {"source_mean_thickness", &length, 0.0, unbounded, false},
      {"deposit_volume", &volume, 0.0, unbounded, false},
      {"deposit_area", &area, 0.0, unbounded, false},
      {"travel_distance", &length, 0.0, unbounded, false},
      {"drop_height", &length, -unbounded, unbounded, false},
      {"angle_of_reach", &angle, -90.0, 90.0, false},
  };
  return all;
}

// Null for an unknown name. A force between periods, max_seismic_force_35_150_s, is a force.
const ReportedQuantity* reported_quantity(const std::string& name) {
  const std::string plain = periods_of(name) ? reported_force : name;
  const auto& all = reported_quantities();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) { return plain == each.name; });
  return found == all.end() ? nullptr : &*found;
}

// Mistake in the periods of such a force; empty if there is none, or no periods.
std::string mistake_in_periods(const std::string& name) {
  const auto periods = periods_of(name);
  if (!periods ||
      (shortest_period <= periods->first && periods->first < periods->second && periods->second <= longest_period)) {
    return "";
  }
  return fmt::format("{}: give the shorter period first, both from {:g} to {:g} s", name, shortest_period,
                     longest_period);
}

const std::vector<std::string> needed{"quantity", "value", "unit"};
const std::map<std::string, double> seconds_of{{"time_s", 1.0}, {"time_min", 60.0}, {"time_h", 3600.0}};
const std::vector<std::string> allowed{"quantity", "value", "unit", "time_s", "time_min", "time_h", "source", "kind"};
const std::vector<std::string> kinds{"observation", "model", "assumption"};

std::string format_unit(const std::string& unit) {
  return unit.empty() || unit == "-" || unit == "1" ? "" : " " + unit;
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
    require_known_columns(table, file_, allowed);
    std::vector<std::string> times;
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const std::string& name = table.columns[k];
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
          in_quotes(name), hint_of(name, known), comma_list(known), reported_force);
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

bool is_reported_quantity(const std::string& name) { return reported_quantity(name) != nullptr; }

ReportedValues read_reported_values(const std::filesystem::path& file) { return TargetsReader(file.string()).read(); }

}  // namespace thawslide::config
