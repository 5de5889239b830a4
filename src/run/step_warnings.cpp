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

}  // namespace

template <int Dim>
std::string StepWarnings::warning_of_dry(const sim::Simulation<Dim>& simulation) {
  const auto* columns = simulation.band_columns();
  if (columns == nullptr || !simulation.parameters().heat.steam) {
    return "";
  }
  const auto dry =
      std::ranges::count_if(columns->segments(), [](const auto& segment) { return has_boiled_dry(segment.column); });
  if (dry == 0) {
    return "";
  }
  return fmt::format(
      "warning: at {} s {} of the base {} boiled dry, and the hottest is at {:.0f} C. Without water, boiling no longer "
      "limits temperature and friction. A thicker band (band.thickness) or {} keeps it cooler; "
      "docs/choosing-the-base.md.",
      rounded_text(simulation.time(), 3), dry == 1 ? "a column" : fmt::format("{} columns", dry),
      dry == 1 ? "has" : "have", band::means_of(*columns).max_temperature,
      std::isfinite(simulation.parameters().band.mixing_slip) ? "a smaller band.mixing_slip"
                                                              : "one that mixes (band.mixing_slip)");
}

template <int Dim>
std::string StepWarnings::warning_of_heat(const sim::Simulation<Dim>& simulation) {
  const auto* columns = simulation.band_columns();
  const bool boils = columns != nullptr && simulation.parameters().heat.steam;
  const double hottest = columns == nullptr ? warmest_particle(simulation) : band::means_of(*columns).max_temperature;
  if (!(hottest > (boils ? unphysical_temperature : boiling))) {
    return "";
  }
  if (boils) {
    const double load = physics::saturation_pressure(unphysical_temperature) - physics::Steam::atmosphere;
    return fmt::format(
        "warning: at {} s the hottest column of the base passes {} C, where water boils at {:.1f} MPa: the load "
        "exceeds this pressure, or the column is dry; docs/choosing-the-base.md.",
        rounded_text(simulation.time(), 3), count_text(unphysical_temperature), load / 1e6);
  }
  return fmt::format("warning: at {} s the base passes {:g} C. {}: temperatures above {:g} C are not physical.",
                     rounded_text(simulation.time(), 3), boiling,
                     columns == nullptr ? "Nothing in the model boils" : "Nothing boils, as heat.steam is false",
                     boiling);
}

std::string StepWarnings::warning_of_removal(double time, const sim::Removed& removed) {
  return removed.by_guards() == 0
             ? ""
             : fmt::format(
                   "warning: at t = {:.6g} s guards have removed {}; history.csv has their mass, run.json their number",
                   time, sim::text_of(removed));
}

template std::string StepWarnings::warning_of_dry<2>(const sim::Simulation<2>&);
template std::string StepWarnings::warning_of_dry<3>(const sim::Simulation<3>&);
template std::string StepWarnings::warning_of_heat<2>(const sim::Simulation<2>&);
template std::string StepWarnings::warning_of_heat<3>(const sim::Simulation<3>&);

}  // namespace thawslide::run
