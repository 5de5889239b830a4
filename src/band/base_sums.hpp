// Sums, means and extremes over the band columns of the base. For host and device.
#pragma once

#include <cstdint>
#include <limits>

#include "band/base_budget.hpp"

namespace thawslide::band {

// Sums over segments [J, kg, m2, m3], and extremes. Heat includes the friction heat that is pending until the columns'
// next step.
struct BaseSums {
  double area = 0, heat = 0, water = 0, opening = 0, gas_void = 0;
  double dry_area = 0;  // where a cell of the band has no water left, as ice or melt
  // Means of the band times area.
  double temperature = 0, saturation = 0, pore_pressure = 0, load = 0, thickness = 0;
  // Of all cells above the ground, and of those with water [C].
  double max_temperature = -celsius_to_kelvin, max_wet_temperature = -celsius_to_kelvin;
  double max_pressure_ratio = 0;  // P over averaged N
  std::uint64_t boiled_dry = 0;   // columns with a cell above the ground that has boiled dry

  THAWSLIDE_HD BaseSums& operator+=(const BaseSums& part) {
    area += part.area;
    heat += part.heat;
    water += part.water;
    opening += part.opening;
    gas_void += part.gas_void;
    dry_area += part.dry_area;
    temperature += part.temperature;
    saturation += part.saturation;
    pore_pressure += part.pore_pressure;
    load += part.load;
    thickness += part.thickness;
    max_temperature = max(max_temperature, part.max_temperature);
    max_wet_temperature = max(max_wet_temperature, part.max_wet_temperature);
    max_pressure_ratio = max(max_pressure_ratio, part.max_pressure_ratio);
    boiled_dry += part.boiled_dry;
    return *this;
  }

  // The number, or NaN without a base.
  [[nodiscard]] double known(double number) const {
    return area > 0.0 ? number : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double mean(double times_area) const { return known(times_area / area); }
};

// With the budget since the start.
struct BaseTotals {
  BaseSums sums;
  ColumnLedger budget;
};

// Contribution of one segment. One thread per segment.
template <int Dim>
struct SumSegment {
  using Cells = physics::ColumnCells;

  ColumnsModel model;
  const BasalSegment<Dim>* segments;
  BaseSums* sums;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    const BasalSegment<Dim>& segment = segments[p];
    const double area = segment.area;
    const physics::BandColumn& column = segment.column;
    const physics::ColumnVolumes volumes = volumes_of(model, segment);
    const physics::BandMeans means = current_means(segment);
    BaseSums of_segment;
    of_segment.area = area;
    of_segment.heat = segment.area_of_column * physics::heat_of(column) + segment.heat;
    of_segment.water = segment.area_of_column * physics::water_of(column);
    of_segment.opening = area * volumes.opening;
    of_segment.gas_void = area * volumes.gas_void;
    of_segment.temperature = area * means.temperature;
    of_segment.saturation = area * means.saturation;
    of_segment.pore_pressure = area * means.pore_pressure;
    of_segment.load = area * segment.load;
    of_segment.thickness = area * column.thickness;
    add_cells(segment, of_segment);
    sums[p] = of_segment;
  }

 private:
  THAWSLIDE_HD void add_cells(const BasalSegment<Dim>& segment, BaseSums& found) const {
    constexpr double wet_fraction = 1e-3;  // of full pores; less water has just seeped in, and boils next
    const physics::BandColumn& column = segment.column;
    const auto [grid, full] = model.column.visit([&](const auto& of_band) {
      return Pores{physics::grid_of(of_band, column), of_band.porosity * of_band.phases.water_density};
    });
    double pressure = column.pressure[0];
    bool has_boiled_dry = false;
    for (int k = 0; k < Cells::slide; ++k) {
      const double temperature = column.temperature[Cells::ground + k];
      found.max_temperature = max(found.max_temperature, temperature);
      if (column.water[k] > wet_fraction * full * grid.slide_height(k)) {
        found.max_wet_temperature = max(found.max_wet_temperature, temperature);
      }
      pressure = max(pressure, column.pressure[k]);
      const bool is_dry = !(column.water[k] > 0.0);
      found.dry_area = is_dry && k < Cells::band ? segment.area : found.dry_area;
      has_boiled_dry = has_boiled_dry || (is_dry && temperature > physics::Steam::boiling_at_atmosphere);
    }
    found.max_pressure_ratio = segment.load > 0.0 ? min(pressure / segment.load, 1.0) : 0.0;
    found.boiled_dry = has_boiled_dry ? 1 : 0;
  }
  // Grid of a column, and water in pores full of melt [kg/m3].
  struct Pores {
    physics::ColumnGrid grid;
    double full;
  };
};

}  // namespace thawslide::band
