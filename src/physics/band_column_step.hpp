// Advection between the cells of a column (band_column.hpp), and exchange with the body, as cell faces move; time step
// of a column, and its initial state (docs/theory/band-columns.md).
#pragma once

#include <cmath>

#include "physics/band_column_heat.hpp"
#include "physics/band_column_water.hpp"

namespace thawslide::physics {

// Largest fraction of a cell's content that moves to its neighbours or the body when faces move from one grid to
// another while material spreads. left: old area over new area. Up to 1, no cell loses more than its content.
inline THAWSLIDE_HD double largest_fraction_given(const ColumnGrid& before, const ColumnGrid& after, double left) {
  double largest = 0, below = 0;  // below: height swept by the cell's lower face [m]
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    const double above = after.face(k + 1) - left * before.face(k + 1);
    const double given = max(below, 0.0) + max(-above, 0.0);
    largest = max(largest, given / (left * before.slide_height(k)));
    below = above;
  }
  return largest;
}

// Motion of a column's faces in a step.
struct ColumnChange {
  double stretch;                        // logarithm of new area over old area
  double thickness, next_thickness;      // of the band, before and after [m]
  double cell_growth, next_cell_growth;  // r

  // After `part` of `parts` equal parts of the step.
  [[nodiscard]] THAWSLIDE_HD double thickness_after(int part, int parts) const {
    return thickness + (next_thickness - thickness) * static_cast<double>(part) / static_cast<double>(parts);
  }
  [[nodiscard]] THAWSLIDE_HD double cell_growth_after(int part, int parts) const {
    return cell_growth + (next_cell_growth - cell_growth) * static_cast<double>(part) / static_cast<double>(parts);
  }
};

// Number of substeps of a change: in each, a segment stretches by at most a tenth, and no cell loses more than its
// content. The second condition applies if cells are thin compared with their height above the base.
template <class Curve>
THAWSLIDE_HD int parts_of(const ColumnModel<Curve>& model, const ColumnChange& change) {
  constexpr double most_stretch = 0.1;
  int parts = static_cast<int>(max(1.0, std::ceil(std::abs(change.stretch) / most_stretch)));
  while (true) {
    const double left = std::exp(-change.stretch / static_cast<double>(parts));
    double largest = 0;
    THAWSLIDE_ROLLED for (int part = 0; part < parts; ++part) {
      const auto grid_after = [&](int count) {
        return grid_of(model, change.thickness_after(count, parts), change.cell_growth_after(count, parts));
      };
      largest = max(largest, largest_fraction_given(grid_after(part), grid_after(part + 1), left));
    }
    if (!(largest > 1.0)) {
      return parts;
    }
    parts = static_cast<int>(max(static_cast<double>(parts + 1), std::ceil(static_cast<double>(parts) * largest)));
  }
}

// Moves the faces of a column's cells, by changes of band thickness and cell growth and by the spreading of a
// stretching segment. The swept volume moves between cells; at the top, it is exchanged with the body.
template <class Curve>
THAWSLIDE_HD void mix_in_surroundings(const ColumnModel<Curve>& model, const ColumnGrid& before,
                                      const ColumnGrid& after, const ColumnDrive& drive, BandColumn& column,
                                      ColumnBudget& budget) {
  constexpr int count = ColumnCells::slide;
  const double left = 1.0 / (1.0 + drive.stretching * drive.dt);                // old area over new area
  double heat[count + 1] = {}, water[count + 1] = {}, thawing[count + 1] = {};  // downward through each lower face
  THAWSLIDE_ROLLED for (int f = 1; f <= count; ++f) {
    const double swept = after.face(f) - left * before.face(f);  // [m]
    if (swept > 0.0 && f == count) {
      heat[f] = swept * drive.body_heat;
      water[f] = swept * drive.body_water;
      thawing[f] = swept * column.thawing[count - 1];
    } else {
      const int from = swept > 0.0 ? f : f - 1;
      const double fraction = swept / before.slide_height(from);
      heat[f] = fraction * column.heat[ColumnCells::ground + from];
      water[f] = fraction * column.water[from];
      thawing[f] = swept * column.thawing[from];
    }
  }
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
    double& of_cell = column.heat[ColumnCells::ground + k];
    of_cell = left * of_cell + heat[k + 1] - heat[k];
    column.water[k] = left * column.water[k] + water[k + 1] - water[k];
    column.thawing[k] =
        (left * before.slide_height(k) * column.thawing[k] + thawing[k + 1] - thawing[k]) / after.slide_height(k);
  }
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::ground;
                        ++k) {  // newly covered ground has the temperature of the segment's ground
    budget.ground_heat += (1.0 - left) * column.heat[k];
  }
  column.thickness = drive.thickness;
  column.cell_growth = drive.cell_growth;
  budget.body_heat += heat[count];
  budget.body_water += water[count];
  temperatures_from_heat(model, after, column);
}

// Changes the cell growth of a column, with exchange with the body at the top [J/m3, kg/m3]. Pressures are not updated.
template <class Curve>
THAWSLIDE_HD ColumnBudget apply_cell_growth(const ColumnModel<Curve>& model, double cell_growth, double body_heat,
                                            double body_water, BandColumn& column) {
  ColumnBudget budget;
  if (cell_growth == column.cell_growth) {
    return budget;
  }
  const ColumnChange change{0.0, column.thickness, column.thickness, column.cell_growth, cell_growth};
  const int parts = parts_of(model, change);
  ColumnDrive drive{};
  drive.thickness = column.thickness;
  drive.body_heat = body_heat;
  drive.body_water = body_water;
  THAWSLIDE_ROLLED for (int part = 1; part <= parts; ++part) {
    drive.cell_growth = change.cell_growth_after(part, parts);
    mix_in_surroundings(model, grid_of(model, column), grid_of(model, drive.thickness, drive.cell_growth), drive,
                        column, budget);
  }
  return budget;
}

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
