// Time step of a column (band_column.hpp), and its initial state (docs/theory/band-columns.md).
#pragma once

#include "physics/band_column_intake.hpp"
#include "physics/band_column_water.hpp"

namespace thawslide::physics {

// Means over the band, used by basal friction. P is limited to the current load, because the load may decrease between
// two steps of the column; excess water volume then counts as opening.
struct BandMeans {
  double temperature, pore_pressure, saturation, solid_fraction;  // [C], [Pa], S, n_e of Eq. 2
};

// Volumes of a whole column per area [m]: opening, by which water lifts the sliding mass, and voids.
struct ColumnVolumes {
  double opening, gas_void;
};

// Mixes the band by shear: its cells, all of one height, approach their mean by the fraction `share`.
template <class Curve>
THAWSLIDE_HD void mix_band(const ColumnModel<Curve>& model, const ColumnGrid& grid, double fraction,
                           BandColumn& column) {
  for (double* of_band : {column.heat + ColumnCells::ground, &column.water[0], &column.thawing[0]}) {
    double mean = 0;
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::band; ++k) { mean += of_band[k] / ColumnCells::band; }
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::band; ++k) { of_band[k] += fraction * (mean - of_band[k]); }
  }
  temperatures_from_heat(model, grid, column);
}

// Advances a column by drive.dt. Friction heat is distributed over the band; then heat is conducted, and water boils
// and seeps.
template <class Curve>
THAWSLIDE_HD ColumnBudget step_column(const ColumnModel<Curve>& model, const ColumnDrive& drive, BandColumn& column) {
  ColumnBudget budget;
  bool was_melted[ColumnCells::slide];
  const ColumnGrid grid = grid_of(model, drive.thickness, drive.cell_growth);
  if (drive.stretching != 0.0 || drive.thickness != column.thickness || drive.cell_growth != column.cell_growth) {
    mix_in_surroundings(model, grid_of(model, column), grid, drive, column, budget);
  }
  if (drive.mixed > 0.0) {
    mix_band(model, grid, drive.mixed, column);
  }
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) { was_melted[k] = is_melted(model, column, k); }
  budget.friction_heat = drive.heat_flux * drive.dt;
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::band; ++k) {
    column.heat[ColumnCells::ground + k] += budget.friction_heat / ColumnCells::band;
  }
  if (model.conduction) {
    conduct_in_column(model, grid, drive.dt, column);
  }
  temperatures_from_heat(model, grid, column);
  if (model.steam) {
    boil(model, grid, drive.normal_pressure, column, budget);
    if (budget.steam > 0.0) {
      temperatures_from_heat(model, grid, column);
    }
  }
  fill_pores(model, grid, drive.normal_pressure, was_melted, column);
  if (model.seepage && model.pressurization && model.hydraulic_conductivity > 0.0) {
    seep_in_column(model, grid, drive.dt, drive.normal_pressure, column, budget);
    temperatures_from_heat(model, grid, column);
  }
  set_pressures(model, PressureBounds(model, drive.normal_pressure, column), column);
  return budget;
}

// Heat [J/m2], and ice and water [kg/m2], of a column.
inline THAWSLIDE_HD double heat_of(const BandColumn& column) {
  double sum = 0;
  THAWSLIDE_ROLLED for (const double heat : column.heat) { sum += heat; }
  return sum;
}
inline THAWSLIDE_HD double water_of(const BandColumn& column) {
  double sum = 0;
  THAWSLIDE_ROLLED for (const double water : column.water) { sum += water; }
  return sum;
}

// Column in material of uniform temperature [C], with pores full of ice and water.
template <class Curve>
THAWSLIDE_HD void start_column(const ColumnModel<Curve>& model, double thickness, double cell_growth,
                               double temperature, double ground_temperature, double normal_pressure,
                               BandColumn& column) {
  column = {};
  column.thickness = thickness;
  column.cell_growth = cell_growth;
  const ColumnGrid grid = grid_of(model, column);
  const double water = water_of_full_pores(model, temperature);
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) { column.water[k] = water * grid.slide_height(k); }
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::all; ++k) {
    column.temperature[k] = k < ColumnCells::ground ? ground_temperature : temperature;
    column.heat[k] = enthalpy(model.curve, cell_coefficients(model, grid, column, k), column.temperature[k]);
  }
  const bool was_melted[ColumnCells::slide] = {};
  fill_pores(model, grid, normal_pressure, was_melted, column);
  const double storage = pore_storage(model.phases, model.porosity, model.skeleton_compressibility);
  const double full = thawing_surplus(storage, normal_pressure, model.residual_stress, 0.0);
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    if (is_melted(model, column, k)) {  // initially melted cells have no thermal pressure
      column.thawing[k] += full - column.surplus[k];
      column.surplus[k] = full;
    }
  }
  set_pressures(model, PressureBounds(model, normal_pressure, column), column);
}
template <class Curve>
BandColumn start_column(const ColumnModel<Curve>& model, double thickness, double cell_growth, double temperature,
                        double ground_temperature, double normal_pressure) {
  BandColumn column;
  start_column(model, thickness, cell_growth, temperature, ground_temperature, normal_pressure, column);
  return column;
}

// Enthalpy [J/m3] of the body's material at a temperature [C], with full pores.
template <class Curve>
THAWSLIDE_HD double body_enthalpy(const ColumnModel<Curve>& model, double temperature) {
  return enthalpy(model.curve, slide_coefficients(model, 1.0, water_of_full_pores(model, temperature)), temperature);
}

// Mean pore pressure [Pa] of the band, limited in each cell to the load N [Pa].
inline THAWSLIDE_HD double band_pressure(double normal_pressure, const BandColumn& column) {
  double mean = 0;
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::band; ++k) {
    mean += 1.0 / ColumnCells::band * min(column.pressure[k], normal_pressure);
  }
  return mean;
}

template <class Curve>
THAWSLIDE_HD BandMeans band_means(const ColumnModel<Curve>& model, double normal_pressure, const BandColumn& column) {
  BandMeans means{};
  constexpr double fraction = 1.0 / ColumnCells::band;
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::band; ++k) {
    const double temperature = column.temperature[ColumnCells::ground + k];
    const double saturation = model.curve.saturation(temperature);
    means.temperature += fraction * temperature;
    means.saturation += fraction * saturation;
    means.solid_fraction += fraction * effective_solid_fraction(model.phases, model.porosity, saturation);
  }
  means.pore_pressure = band_pressure(normal_pressure, column);
  return means;
}

template <class Curve>
THAWSLIDE_HD ColumnVolumes column_volumes(const ColumnModel<Curve>& model, double normal_pressure,
                                          const BandColumn& column) {
  ColumnVolumes volumes{};
  const ColumnGrid grid = grid_of(model, column);
  const double storage = pore_storage(model.phases, model.porosity, model.skeleton_compressibility);
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    if (is_melted(model, column, k)) {
      const auto filling = pore_filling(column.surplus[k], storage, normal_pressure);
      volumes.opening += grid.slide_height(k) * filling.opening;
      volumes.gas_void += grid.slide_height(k) * filling.gas_void;
    }
  }
  return volumes;
}

// Volume of liquid water in a whole column, per area [m].
template <class Curve>
THAWSLIDE_HD double liquid_volume(const ColumnModel<Curve>& model, const BandColumn& column) {
  double volume = 0;
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    const double melted = model.curve.saturation(column.temperature[ColumnCells::ground + k]);
    volume += melted * column.water[k] / model.phases.water_density;
  }
  return volume;
}

// Merges two columns of the same cell growth, with area fractions `share` and 1 - share. Heat, water and rock are
// conserved, because cell heights are proportional to the band thickness.
template <class Curve>
THAWSLIDE_HD BandColumn joined_columns(const ColumnModel<Curve>& model, double fraction, const BandColumn& first,
                                       const BandColumn& second, double normal_pressure) {
  BandColumn column = first;
  const auto mean = [&](double of_first, double of_second) {
    return fraction * of_first + (1.0 - fraction) * of_second;
  };
  column.thickness = mean(first.thickness, second.thickness);
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::all; ++k) { column.heat[k] = mean(first.heat[k], second.heat[k]); }
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    column.water[k] = mean(first.water[k], second.water[k]);
    column.thawing[k] =
        mean(first.thickness * first.thawing[k], second.thickness * second.thawing[k]) / column.thickness;
  }
  const ColumnGrid grid = grid_of(model, column);
  temperatures_from_heat(model, grid, column);
  bool was_melted[ColumnCells::slide];
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) { was_melted[k] = is_melted(model, column, k); }
  fill_pores(model, grid, normal_pressure, was_melted, column);
  set_pressures(model, PressureBounds(model, normal_pressure, column), column);
  return column;
}

}  // namespace thawslide::physics
