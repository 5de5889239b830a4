#include "run/block_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "config/notices.hpp"
#include "config/profile_csv.hpp"
#include "physics/basal/shared_parameters.hpp"
#include "run/setup.hpp"
#include "sim/block/block.hpp"
#include "sim/block/path_section.hpp"

namespace thawslide::run {

namespace {

// Valley factor above which the effect of the cross-slope ground on friction is reported.
constexpr double least_valley_factor = 1.03;

void report_valley_factor(const std::vector<sim::HistoryRow>& rows, Observer& observer) {
  const auto narrower = [](const sim::HistoryRow& a, const sim::HistoryRow& b) {
    return value_of(a, "valley_factor") < value_of(b, "valley_factor");
  };
  const sim::HistoryRow& narrowest = *std::ranges::max_element(rows, narrower);
  const double factor = value_of(narrowest, "valley_factor");
  if (factor > least_valley_factor) {
    observer.line(
        "note: the path follows a valley, whose sides raise friction by a factor of {:.3g} at the start and {:.3g} at "
        "most, at {} s (valley_factor)",
        value_of(rows.front(), "valley_factor"), factor, rounded_text(value_of(narrowest, "time_s"), 3));
  }
}

// Runs a 3D case as a section along its path.
std::vector<sim::HistoryRow> block_along_path(const config::Case& parameters, Warnings& warnings, Observer& observer) {
  const sim::PathSection section = sim::section_along_path(parameters, read_map_files(parameters, warnings));
  std::vector<sim::HistoryRow> rows =
      sim::run_block(section.parameters, section.site, section.valley_factor, section.start);
  observer.line(
      "a section along {}, with the mean thickness of the release across the path; front positions are distances along "
      "it",
      section.path_given ? "maps.path"
                         : "the line of steepest descent from the centre of the release, because maps.path is not set");
  constexpr double most_off = 45.0;
  if (section.off_steepest > most_off) {
    observer.line(
        "warning: maps.path is at {:.0f} degrees to the steepest descent at the middle of the release. Only the slope "
        "along the path drives the block",
        section.off_steepest);
  }
  const double end = section.pit ? section.pit->along : section.site.profile.distance.back();
  auto beyond =
      std::ranges::find_if(rows, [&](const sim::HistoryRow& row) { return value_of(row, "front_position_m") > end; });
  const bool is_reached = beyond != rows.end();
  const std::string time = is_reached ? rounded_text(value_of(*beyond, "time_s"), 3) : "";
  if (section.pit) {
    observer.line("warning: the flow path ends in a closed depression after {} m, at x = {}, y = {}{}",
                  rounded_text(end, 3), coordinate_text(section.pit->point[0]), coordinate_text(section.pit->point[1]),
                  is_reached
                      ? fmt::format(". The front reaches it at {} s, and the block stops there. Set maps.path to "
                                    "a longer line to follow the slide further",
                                    time)
                      : ", which the front does not reach");
    beyond += is_reached ? 1 : 0;
  } else if (is_reached) {
    observer.line(
        "warning: maps.path: the front leaves the DEM after {} m, at {} s, and the table ends there. Use {} to follow "
        "it further",
        with_commas(end, 3), time, section.path_given ? "a longer maps.path, or a larger DEM," : "a larger DEM");
    beyond = std::max(beyond, rows.begin() + 1);  // the ground is known below the whole release
  }
  rows.erase(beyond, rows.end());
  report_valley_factor(rows, observer);
  return rows;
}

// On a profile without extrapolation, the results end with it.
std::vector<sim::HistoryRow> block_on_profile(const config::Case& parameters, Observer& observer) {
  std::vector<sim::HistoryRow> rows = sim::run_block(parameters);
  if (parameters.terrain.kind != config::TerrainKind::profile || parameters.terrain.extend) {
    return rows;
  }
  const config::ProfileTable profile = config::read_profile(parameters.terrain.file);
  const double first = profile.distance.front(), last = profile.distance.back();
  const auto beyond = std::ranges::find_if(rows, [&](const sim::HistoryRow& row) {
    const double front = value_of(row, "front_position_m");
    return front < first || front > last;
  });
  if (beyond != rows.end()) {
    observer.line(
        "warning: the profile is known from {} to {} m; the front leaves it at {} s, and the rows end before. Give a "
        "longer profile, or set terrain.extend = true, to follow it further",
        coordinate_text(first), coordinate_text(last), rounded_text(value_of(*beyond, "time_s"), 3));
    rows.erase(std::max(beyond, rows.begin() + 1), rows.end());
  }
  return rows;
}

// Thinnest band that config::ProposedBase allows. run(): rows of the block of `parameters`; end: of the terrain [m].
template <class Run>
config::ProposedBase thinnest_band(config::Case& parameters, double end, const Run& run) {
  config::ProposedBase base;
  parameters.mechanisms.pressurization = false;
  for (const double thickness : config::ProposedBase::candidates) {
    parameters.band.thickness.table = Table(thickness);
    double warmest = -HUGE_VAL;
    const auto rows = run();
    for (const sim::HistoryRow& row : rows) {
      if (value_of(row, "front_position_m") <= end) {
        warmest = std::max(warmest, value_of(row, "band_temperature_C"));
      }
    }
    if (thickness != config::ProposedBase::candidates.front() && warmest > config::ProposedBase::limit) {
      break;
    }
    const double driving = std::abs(value_of(rows.front(), "driving_traction_Pa"));
    const double strength = value_of(rows.front(), "sliding_strength_Pa");
    // Without cohesion, the strength is proportional to the tangent of the friction angle.
    constexpr double degree = std::numbers::pi / 180.0;
    const double given = std::tan(parameters.basal.numbers(physics::basal::friction_angle) * degree);
    base = {thickness, warmest, std::atan(given * driving / strength) / degree, strength / driving,
            std::max(0.0, driving - strength)};
  }
  return base;
}

}  // namespace

double value_of(const sim::HistoryRow& row, const std::string& name) {
  for (const auto& [key, number] : row) {
    if (key == name) {
      return number;
    }
  }
  throw InternalError("no column is called " + name);
}

std::vector<sim::HistoryRow> block_rows(const config::Case& parameters, Observer& observer) {
  Warnings warnings(&observer);
  warnings.add(config::notices(parameters));
  return parameters.terrain.kind == config::TerrainKind::dem ? block_along_path(parameters, warnings, observer)
                                                             : block_on_profile(parameters, observer);
}

config::ProposedBase propose_base(config::Case parameters) {
  parameters.substrates.clear();
  if (parameters.terrain.kind != config::TerrainKind::dem) {
    const double end = config::read_profile(parameters.terrain.file).distance.back();
    return thinnest_band(parameters, end, [&] { return sim::run_block(parameters); });
  }
  Warnings warnings;
  sim::PathSection section = sim::section_along_path(parameters, read_map_files(parameters, warnings));
  const double end = section.pit ? section.pit->along : section.site.profile.distance.back();
  return thinnest_band(section.parameters, end, [&] {
    return sim::run_block(section.parameters, section.site, section.valley_factor, section.start);
  });
}

}  // namespace thawslide::run
