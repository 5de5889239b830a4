#include "app/boiling_note.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/boiling.hpp"

namespace thawslide::app {

namespace {

constexpr double boiling = physics::Steam<double>::boiling_at_atmosphere;  // [C]
constexpr double beyond_belief = 210.0;                                    // [C] steam of it lifts some 90 m of slide

template <int Dim>
double warmest_particle(const sim::Simulation<Dim, double>& simulation) {
  double temperature = -HUGE_VAL;
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    temperature = std::max(temperature, simulation.particles().temperature(p));
  }
  return temperature;
}

bool has_boiled_dry(const physics::BandColumn<double>& column) {
  for (int k = 0; k < physics::ColumnCells::slide; ++k) {
    if (column.water[k] <= 0.0 && column.temperature[physics::ColumnCells::ground + k] > boiling) {
      return true;
    }
  }
  return false;
}

// Of columns whose water boils.
std::string note_on_columns(double time, std::ptrdiff_t dry, double hottest) {
  if (dry == 0 && !(hottest > beyond_belief)) {
    return "";
  }
  const std::string found =
      dry > 0 ? fmt::format("{} of the base {} boiled dry, and the hottest is at {:.0f} C",
                            dry == 1 ? "a column" : fmt::format("{} columns", dry), dry == 1 ? "has" : "have", hottest)
              : fmt::format("the hottest column of the base passes {:g} C", beyond_belief);
  return fmt::format(
      "note: at {:g} s {}: where no water is left nothing limits temperature and friction. A thicker band "
      "(band.thickness) or one that mixes (band.mixing_slip) keeps it cooler; docs/choosing-the-base.md.",
      time, found);
}

}  // namespace

template <int Dim>
std::string note_on_boiling(const sim::Simulation<Dim, double>& simulation) {
  const auto* columns = simulation.band_columns();
  if (columns != nullptr && simulation.parameters().heat.steam) {
    const auto& pieces = columns->pieces();
    const auto dry =
        std::count_if(pieces.begin(), pieces.end(), [](const auto& piece) { return has_boiled_dry(piece.column); });
    return note_on_columns(simulation.time(), dry, columns->means().hottest);
  }
  const double hottest = columns == nullptr ? warmest_particle(simulation) : columns->means().hottest;
  return hottest > boiling
             ? fmt::format(
                   "note: at {:g} s the base passes {:g} C. {}: beyond this temperatures are a bookkeeping of "
                   "heat, not a forecast.",
                   simulation.time(), boiling,
                   columns == nullptr ? "Nothing in the model boils" : "Nothing boils, as heat.steam is false")
             : "";
}

template std::string note_on_boiling<2>(const sim::Simulation<2, double>&);
template std::string note_on_boiling<3>(const sim::Simulation<3, double>&);

}  // namespace thawslide::app
