// thawslide block, describe, report and version.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

#include "app/commands.hpp"
#include "app/describe_outputs.hpp"
#include "app/input_guard.hpp"
#include "app/map_files.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "config/describe.hpp"
#include "config/notices.hpp"
#include "config/read_case.hpp"
#include "io/history_writer.hpp"
#include "sim/block.hpp"
#include "sim/path_section.hpp"
#include "version.hpp"

namespace thawslide::app {

namespace {

constexpr std::size_t rows_in_table = 21;

double value_of(const sim::HistoryRow& row, const std::string& name) {
  for (const auto& [key, number] : row) {
    if (key == name) {
      return number;
    }
  }
  throw InternalError("the block model has no column " + name);
}

void print_table(const std::vector<sim::HistoryRow>& rows) {
  fmt::print(
      "{:>8} {:>9} {:>10} {:>10} {:>10} {:>10} {:>9} {:>7}\n{:>8} {:>9} {:>10} {:>10} {:>10} {:>10} {:>9} {:>7}\n",
      "time", "velocity", "distance", "normal", "pore p.", "strength", "band T", "mu_e", "s", "m/s", "m", "kPa", "kPa",
      "kPa", "C", "");
  const std::size_t shown = std::min(rows_in_table, rows.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const auto& row = rows[shown == 1 ? 0 : k * (rows.size() - 1) / (shown - 1)];
    const auto value = [&](const std::string& name) { return value_of(row, name); };
    fmt::print("{:8.2f} {:9.2f} {:10.1f} {:10.1f} {:10.1f} {:10.1f} {:9.2f} {:7.4f}\n", value("time_s"),
               value("velocity_m_s"), value("displacement_m"), value("normal_pressure_Pa") / 1e3,
               value("pore_pressure_Pa") / 1e3, value("sliding_strength_Pa") / 1e3, value("band_temperature_C"),
               value("band_friction_coefficient"));
  }
}

// Valley factor above which the effect of the cross-slope ground on friction is reported.
constexpr double least_valley_factor = 1.03;

void print_valley_factor(const std::vector<sim::HistoryRow>& rows) {
  const auto narrower = [](const sim::HistoryRow& a, const sim::HistoryRow& b) {
    return value_of(a, "valley_factor") < value_of(b, "valley_factor");
  };
  const sim::HistoryRow& narrowest = *std::max_element(rows.begin(), rows.end(), narrower);
  const double factor = value_of(narrowest, "valley_factor");
  if (factor > least_valley_factor) {
    fmt::print(
        "note: the path follows a valley, whose sides raise friction by a factor of {:.3g} at the start and {:.3g} at "
        "most, at {:.4g} s (valley_factor)\n",
        value_of(rows.front(), "valley_factor"), factor, value_of(narrowest, "time_s"));
  }
}

// Runs a 3D case as a section along its path.
std::vector<sim::HistoryRow> block_along_path(const config::Case& parameters, Warnings& warnings) {
  const sim::PathSection section = sim::section_along_path(parameters, read_map_files(parameters, warnings));
  std::vector<sim::HistoryRow> rows = sim::run_block(section.parameters, section.site, section.valley_factor);
  fmt::print(
      "a section along {}, with the mean thickness of the release across the path; front positions are distances along "
      "it\n",
      section.path_given ? "maps.path"
                         : "the line of steepest descent from the centre of the release, because maps.path is not set");
  constexpr double most_off = 45.0;
  if (section.off_steepest > most_off) {
    fmt::print(
        "warning: maps.path is at {:.0f} degrees to the steepest descent at the middle of the release. Only the slope "
        "along the path drives the block\n",
        section.off_steepest);
  }
  const auto first_beyond = [&](double end) {
    return std::find_if(rows.begin(), rows.end(),
                        [&](const sim::HistoryRow& row) { return value_of(row, "front_position_m") > end; });
  };
  if (section.pit) {
    const auto beyond = first_beyond(section.pit->along);
    fmt::print("warning: the flow path ends in a closed depression after {:.6g} m, at x = {:.10g}, y = {:.10g}{}\n",
               section.pit->along, section.pit->place[0], section.pit->place[1],
               beyond == rows.end() ? ", which the front does not reach"
                                    : fmt::format(". The front reaches it at {:.4g} s, and the block stops there. Set "
                                                  "maps.path to a longer line to follow the slide further",
                                                  value_of(*beyond, "time_s")));
    rows.erase(beyond == rows.end() ? beyond : beyond + 1, rows.end());
    print_valley_factor(rows);
    return rows;
  }
  const double end = section.site.profile.distance.back();
  const auto beyond = first_beyond(end);
  if (beyond != rows.end()) {
    fmt::print(
        "warning: maps.path: the front leaves the DEM after {} m, at {:.3g} s, and the table ends there. Use {} to "
        "follow it further\n",
        with_commas(end, 3), value_of(*beyond, "time_s"),
        section.path_given ? "a longer maps.path, or a larger DEM," : "a larger DEM");
    // The first row is kept: the ground is known below the whole release.
    rows.erase(std::max(beyond, rows.begin() + 1), rows.end());
  }
  print_valley_factor(rows);
  return rows;
}

// On a profile without extrapolation, the results end with it.
std::vector<sim::HistoryRow> block_on_profile(const config::Case& parameters) {
  std::vector<sim::HistoryRow> rows = sim::run_block(parameters);
  if (parameters.terrain.kind != config::TerrainKind::profile || parameters.terrain.extend) {
    return rows;
  }
  const config::ProfileTable profile = config::read_profile(parameters.terrain.file);
  const double first = profile.distance.front(), last = profile.distance.back();
  const auto beyond = std::find_if(rows.begin(), rows.end(), [&](const sim::HistoryRow& row) {
    const double front = value_of(row, "front_position_m");
    return front < first || front > last;
  });
  if (beyond != rows.end()) {
    fmt::print(
        "warning: the profile is known from {:.6g} to {:.6g} m; the front leaves it at {:.4g} s, and the rows end "
        "before. Give a longer profile, or set terrain.extend = true, to follow it further\n",
        first, last, value_of(*beyond, "time_s"));
    rows.erase(std::max(beyond, rows.begin() + 1), rows.end());
  }
  return rows;
}

}  // namespace

int run_block_model(const BlockOptions& options) {
  const config::Case parameters = config::read_case(options.of_case.file, options.of_case.sets);
  if (!options.output.empty()) {
    require_no_input_at(options.output, "--output", parameters);
  }
  Warnings warnings;
  warnings.add(config::notices(parameters));
  const auto start = std::chrono::steady_clock::now();
  const std::vector<sim::HistoryRow> rows = parameters.terrain.kind == config::TerrainKind::dem
                                                ? block_along_path(parameters, warnings)
                                                : block_on_profile(parameters);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.output.empty()) {
    print_table(rows);
    const auto& first = rows.front();
    fmt::print("safety factor at the start: {:.3f} (sliding strength over driving traction); took {:.0f} ms\n",
               value_of(first, "sliding_strength_Pa") / std::abs(value_of(first, "driving_traction_Pa")),
               1e3 * seconds);
    return static_cast<int>(ExitCode::done);
  }
  io::HistoryWriter writer(options.output);
  for (const sim::HistoryRow& row : rows) {
    writer.add(row);
  }
  fmt::print("{} rows in {}; took {:.0f} ms\n", rows.size(), options.output, 1e3 * seconds);
  return static_cast<int>(ExitCode::done);
}

int describe_parameters(const DescribeOptions& options) {
  fmt::print("{}", options.json       ? config::describe_json()
                   : options.markdown ? config::describe_markdown()
                   : options.schema   ? config::schema_json()
                   : options.outputs  ? describe_outputs()
                                      : config::describe_text());
  return static_cast<int>(ExitCode::done);
}

int hand_over_to_report(const std::vector<std::string>& arguments) {
  std::string program = "thawslide-report";
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers{program.data()};
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  execvp(program.c_str(), pointers.data());
  throw UserError(
      fmt::format("thawslide-report cannot be started ({}). It is part of the Python package: "
                  "`./run --setup` installs it into .venv; put .venv/bin on PATH.",
                  std::strerror(errno)));
}

int print_version() {
  fmt::print("thawslide {} (commit {}, {} {})\n", version, commit,
#if defined(__clang__)
             "clang",
#else
             "g++",
#endif
             __VERSION__);
  return static_cast<int>(ExitCode::done);
}

}  // namespace thawslide::app
