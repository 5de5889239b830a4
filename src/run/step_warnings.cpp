#include "run/step_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

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

}  // namespace

template <int Dim>
std::string StepWarnings::warning_of_dry(const sim::Simulation<Dim>& simulation) {
  if (!simulation.has_band_columns() || !simulation.parameters().heat.steam) {
    return "";
  }
  const band::BaseSums base = simulation.base_totals().sums;
  const std::uint64_t dry = base.boiled_dry;
  if (dry == 0) {
    return "";
  }
  return fmt::format(
      "warning: at {} s {} of the base {} boiled dry, and the hottest is at {:.0f} C. Without water, boiling no longer "
      "limits temperature and friction. A thicker band (band.thickness) or {} keeps it cooler; "
      "docs/choosing-the-base.md.",
      rounded_text(simulation.time(), 3), dry == 1 ? "a column" : fmt::format("{} columns", dry),
      dry == 1 ? "has" : "have", base.max_temperature,
      std::isfinite(simulation.parameters().band.mixing_slip) ? "a smaller band.mixing_slip"
                                                              : "one that mixes (band.mixing_slip)");
}

template <int Dim>
std::string StepWarnings::warning_of_heat(const sim::Simulation<Dim>& simulation) {
  const bool has_columns = simulation.has_band_columns(), boils = has_columns && simulation.parameters().heat.steam;
  const double hottest = has_columns ? simulation.base_totals().sums.max_temperature : warmest_particle(simulation);
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
                     has_columns ? "Nothing boils, as heat.steam is false" : "Nothing in the model boils", boiling);
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
