#include "run/step_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "band/base_sums.hpp"
#include "base/rounding.hpp"
#include "physics/boiling.hpp"

namespace thawslide::run {

namespace {

constexpr double boiling = physics::Steam::boiling_at_atmosphere;  // [C]
constexpr double unphysical_temperature = 210.0;  // [C] steam at this temperature lifts about 80 m of slide

template <int Dim>
double warmest_particle(const sim::Simulation<Dim>& simulation) {
  double temperature = -HUGE_VAL;
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    temperature = std::max(temperature, simulation.particles().temperature(p));
  }
  return temperature;
}

bool has_boiled_dry(const physics::BandColumn& column) {
  for (int k = 0; k < physics::ColumnCells::slide; ++k) {
    if (column.water[k] <= 0.0 && column.temperature[physics::ColumnCells::ground + k] > boiling) {
      return true;
    }
  }
  return false;
}

const char* mixing_advice(bool mixes) {
  return mixes ? "a smaller band.mixing_slip" : "one that mixes (band.mixing_slip)";
}

std::string of_dry(double time, std::ptrdiff_t dry, double hottest, bool mixes) {
  return fmt::format(
      "warning: at {} s {} of the base {} boiled dry, and the hottest is at {:.0f} C. Without water, boiling no longer "
      "limits temperature and friction. A thicker band (band.thickness) or {} keeps it cooler; "
      "docs/choosing-the-base.md.",
      rounded_text(time, 3), dry == 1 ? "a column" : fmt::format("{} columns", dry), dry == 1 ? "has" : "have", hottest,
      mixing_advice(mixes));
}

std::string of_hot(double time) {
  const double load = physics::saturation_pressure(unphysical_temperature) - physics::Steam::atmosphere;
  return fmt::format(
      "warning: at {} s the hottest column of the base passes {} C, where water boils at {:.1f} MPa: the load exceeds "
      "this pressure, or the column is dry; docs/choosing-the-base.md.",
      rounded_text(time, 3), count_text(unphysical_temperature), load / 1e6);
}

std::string of_hotter(double time, double limit, bool mixes) {
  return fmt::format(
      "warning: at {} s the hottest part of the base passes {} C. Nothing in the model limits the temperature of a dry "
      "base, and this is not physical: use a thicker band (band.thickness) or {}.",
      rounded_text(time, 3), count_text(limit), mixing_advice(mixes));
}

std::string of_no_boiling(double time, double limit, const char* reason) {
  return fmt::format("warning: at {} s the base passes {} C. {}: temperatures above {:g} C are not physical.",
                     rounded_text(time, 3), count_text(limit), reason, boiling);
}

// Highest limit below a temperature [C], of `first` and those of all bases; 0 if there is none.
double limit_below(double temperature, double first) {
  double passed = 0.0;
  for (const double limit : {first, 500.0, 1000.0, 2000.0}) {
    passed = temperature > limit ? limit : passed;
  }
  return passed;
}

}  // namespace

template <int Dim>
std::string BoilingWatch::warning(const sim::Simulation<Dim>& simulation) {
  const double time = simulation.time();
  const auto* columns = simulation.band_columns();
  const bool mixes = std::isfinite(simulation.parameters().band.mixing_slip);
  const bool boils = columns != nullptr && simulation.parameters().heat.steam;
  const double hottest = columns == nullptr ? warmest_particle(simulation) : band::means_of(*columns).max_temperature;
  const double first = boils ? unphysical_temperature : boiling;
  if (boils && !is_dry_) {
    const auto segments = columns->segments();
    const auto dry =
        std::ranges::count_if(segments, [](const auto& segment) { return has_boiled_dry(segment.column); });
    if (dry > 0) {
      is_dry_ = true;
      passed_limit_ = std::max({passed_limit_, first, limit_below(hottest, first)});
      return of_dry(time, dry, hottest, mixes);
    }
  }
  const double limit = limit_below(hottest, first);
  if (limit <= passed_limit_) {
    return "";
  }
  passed_limit_ = limit;
  if (!boils) {
    return of_no_boiling(time, limit,
                         columns == nullptr ? "Nothing in the model boils" : "Nothing boils, as heat.steam is false");
  }
  return limit > first ? of_hotter(time, limit, mixes) : of_hot(time);
}

std::string StepWarnings::warning_of_removal(double time, const sim::Removed& removed) {
  return removed.by_guards() == 0
             ? ""
             : fmt::format(
                   "warning: at t = {:.6g} s guards have removed {}; history.csv has their mass, run.json their number",
                   time, sim::text_of(removed));
}

template std::string BoilingWatch::warning<2>(const sim::Simulation<2>&);
template std::string BoilingWatch::warning<3>(const sim::Simulation<3>&);

}  // namespace thawslide::run
