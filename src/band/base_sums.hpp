// Sums over the band columns of the base in host memory, and their checkpoint state.
#pragma once

#include <vector>

#include "band/basal_segments.hpp"
#include "exec/cpu.hpp"

namespace thawslide::band {

template <int Dim>
using BaseColumns = BasalSegments<exec::Cpu, Dim>;

// Sums over all segments [J, kg, m2, m3]. Heat includes the friction heat that is pending until the columns' next step.
struct ColumnSums {
  double area = 0, heat = 0, waiting_heat = 0, water = 0, opening = 0, gas_void = 0;

  ColumnSums& operator+=(const ColumnSums& part) {
    area += part.area;
    heat += part.heat;
    waiting_heat += part.waiting_heat;
    water += part.water;
    opening += part.opening;
    gas_void += part.gas_void;
    return *this;
  }
};
template <int Dim>
[[nodiscard]] ColumnSums sums_of(const BaseColumns<Dim>& columns);

// Means over the base, weighted by area, and extremes.
struct BaseMeans {
  double temperature = 0, saturation = 0, pore_pressure = 0, load = 0, thickness = 0;
  double max_temperature = 0,
         max_wet_temperature = 0;  // maximum of all cells above the ground, and of those with water [C]
  double dry_fraction = 0;         // area fraction of the base in which a cell of the band has no water left
  double max_pressure_ratio = 0;   // maximum P over averaged N
};
template <int Dim>
[[nodiscard]] BaseMeans means_of(const BaseColumns<Dim>& columns);

// Checkpoint state without the time since the columns' last step. restore throws UserError for an impossible state.
template <int Dim>
[[nodiscard]] std::vector<double> numbers_of(const BaseColumns<Dim>& columns);
template <int Dim>
void restore(const std::vector<double>& numbers, BaseColumns<Dim>& columns);

}  // namespace thawslide::band
