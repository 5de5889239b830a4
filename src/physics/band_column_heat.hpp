// Heat of a column (band_column.hpp): conduction, friction heat, boiling (docs/theory/band-columns.md).
#pragma once

#include <cmath>

#include "physics/band_column.hpp"
#ifndef __CUDACC__
#include "base/simd.hpp"
#endif

namespace thawslide::physics {

// Cells of the sliding mass that are computed at once: as lanes on the CPU, one by one on a device.
#ifdef __CUDACC__
using CellLanes = double;
inline constexpr int cell_lanes = 1;
THAWSLIDE_HD inline CellLanes load_cells(const double* numbers) { return *numbers; }
THAWSLIDE_HD inline void store_cells(CellLanes lanes, double* numbers) { *numbers = lanes; }
#else
using CellLanes = Simd<double, 4>;
inline constexpr int cell_lanes = 4;
inline CellLanes load_cells(const double* numbers) { return CellLanes::load_unaligned(numbers); }
inline void store_cells(CellLanes lanes, double* numbers) { lanes.store_unaligned(numbers); }
#endif
static_assert(ColumnCells::slide % cell_lanes == 0);

// Capacities and latent heat of a cell of the sliding mass, per area: rock by volume, ice and water by mass [kg/m2].
template <class Curve, class Value>
THAWSLIDE_HD EnthalpyCoefficients<Value> slide_coefficients(const ColumnModel<Curve>& model, Value height,
                                                            Value water) {
  const Phases& phases = model.phases;
  const Value rock = (1.0 - model.porosity) * height * phases.rock_density * phases.rock_heat_capacity;
  return {rock + water * phases.ice_heat_capacity, water * (phases.water_heat_capacity - phases.ice_heat_capacity),
          model.latent ? water * phases.latent_heat : Value(0)};
}

template <class Curve>
THAWSLIDE_HD EnthalpyCoefficients<double> cell_coefficients(const ColumnModel<Curve>& model, const ColumnGrid& grid,
                                                            const BandColumn& column, int cell) {
  if (cell < ColumnCells::ground) {
    return {model.ground_capacity * grid.height(cell), 0.0, 0.0};
  }
  return slide_coefficients(model, grid.height(cell), column.water[cell - ColumnCells::ground]);
}

// Enthalpy of melted water [J/kg], relative to ice at Tref.
template <class Curve>
THAWSLIDE_HD double water_enthalpy(const ColumnModel<Curve>& model, double temperature) {
  return (model.latent ? model.phases.latent_heat : 0.0) +
         model.phases.water_heat_capacity * (temperature - model.curve.reference_temperature);
}

// True if the last ice of a cell of the sliding mass has melted.
template <class Curve>
THAWSLIDE_HD bool is_melted(const ColumnModel<Curve>& model, const BandColumn& column, int cell) {
  return column.temperature[ColumnCells::ground + cell] >= model.curve.reference_temperature;
}

// Coefficients of all cells of a column.
struct ColumnCoefficients {
  double frozen[ColumnCells::all], rise[ColumnCells::all], melting[ColumnCells::all];

  template <class Curve>
  THAWSLIDE_HD ColumnCoefficients(const ColumnModel<Curve>& model, const ColumnGrid& grid, const BandColumn& column) {
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::ground; ++k) {
      frozen[k] = model.ground_capacity * grid.height(k);
      rise[k] = melting[k] = 0.0;
    }
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; k += cell_lanes) {
      const int cell = ColumnCells::ground + k;
      const auto of = slide_coefficients(model, load_cells(grid.heights() + cell), load_cells(column.water + k));
      store_cells(of.frozen, frozen + cell);
      store_cells(of.rise, rise + cell);
      store_cells(of.melting, melting + cell);
    }
  }
  [[nodiscard]] THAWSLIDE_HD EnthalpyCoefficients<CellLanes> of_cells(int cell) const {
    return {load_cells(frozen + cell), load_cells(rise + cell), load_cells(melting + cell)};
  }
};

// Temperatures [C] of the cells with these enthalpies [J/m2]. temperature: initial values of the iteration. The ground
// does not freeze.
template <class Curve>
THAWSLIDE_HD void find_temperatures(const Curve& curve, const ColumnCoefficients& of, const double* heat,
                                    double* temperature) {
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::ground; ++k) {
    temperature[k] = curve.reference_temperature + heat[k] / of.frozen[k];
  }
  THAWSLIDE_ROLLED for (int k = ColumnCells::ground; k < ColumnCells::all; k += cell_lanes) {
    store_cells(temperature_of_enthalpy(curve, of.of_cells(k), load_cells(heat + k), load_cells(temperature + k)),
                temperature + k);
  }
}

template <class Curve>
THAWSLIDE_HD void temperatures_from_heat(const ColumnModel<Curve>& model, const ColumnGrid& grid, BandColumn& column) {
  find_temperatures(model.curve, ColumnCoefficients(model, grid, column), column.heat, column.temperature);
}

// Heat conductance [W/m2/K] between cells k and k + 1.
template <class Curve>
struct ColumnConductance {
  double between[ColumnCells::all - 1];

  THAWSLIDE_HD ColumnConductance(const ColumnModel<Curve>& model, const ColumnGrid& grid, const BandColumn& column) {
    double half_resistance[ColumnCells::all];
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::ground; ++k) {
      half_resistance[k] = grid.height(k) / (2.0 * model.ground_conductivity);
    }
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; k += cell_lanes) {
      const int cell = ColumnCells::ground + k;
      const CellLanes height = load_cells(grid.heights() + cell);
      const CellLanes conductivity =
          of_slide(model, height, load_cells(column.temperature + cell), load_cells(column.water + k));
      store_cells(height / (2.0 * conductivity), half_resistance + cell);
    }
    THAWSLIDE_ROLLED for (int k = 0; k + 1 < ColumnCells::all; ++k) {
      between[k] = 1.0 / (half_resistance[k] + half_resistance[k + 1]);
    }
  }

 private:
  // Only the fraction of the pores filled with ice and water conducts; steam and air do not.
  template <class Value>
  THAWSLIDE_HD static Value of_slide(const ColumnModel<Curve>& model, Value height, Value temperature, Value water) {
    const Value saturation = model.curve.saturation(temperature);
    const Value full = saturation * model.phases.water_density + (1.0 - saturation) * model.phases.ice_density;
    const Value volume = water / (full * height);
    const double rock = (1.0 - model.porosity) * model.phases.rock_conductivity;
    const Value of_pores = conductivity(model.phases, Value(model.porosity), saturation) - rock;
    return rock + of_pores * min(Value(1), max(Value(0), volume / model.porosity));
  }
};

// Solves a tridiagonal system in place; the solution replaces `right`. below[k] and above[k] couple k to its
// neighbours.
template <int Count>
THAWSLIDE_HD void solve_tridiagonal(const double* below, double* diagonal, const double* above, double* right) {
  diagonal[0] = 1.0 / diagonal[0];  // inverse from here on
  THAWSLIDE_ROLLED for (int k = 1; k < Count; ++k) {
    const double factor = below[k] * diagonal[k - 1];
    diagonal[k] = 1.0 / (diagonal[k] - factor * above[k - 1]);
    right[k] -= factor * right[k - 1];
  }
  right[Count - 1] *= diagonal[Count - 1];
  THAWSLIDE_ROLLED for (int k = Count - 2; k >= 0; --k) {
    right[k] = (right[k] - above[k] * right[k + 1]) * diagonal[k];
  }
}

// One step of conduction, implicit in temperature (Newton's iteration on enthalpies, because latent heat makes H(T)
// nonlinear). Conservative: the heat that leaves a cell enters its neighbour. `column.heat` holds the enthalpies
// including the friction heat of the step.
template <class Curve>
THAWSLIDE_HD void conduct_in_column(const ColumnModel<Curve>& model, const ColumnGrid& grid, double dt,
                                    BandColumn& column) {
  constexpr int count = ColumnCells::all, most_iterations = 12;
  constexpr double close = 1e-7;  // [K]
  const ColumnConductance<Curve> conductance(model, grid, column);
  const ColumnCoefficients of(model, grid, column);
  double guess[count], flow[count + 1];  // enthalpies; heat through the lower face of each cell [J/m2]
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) { guess[k] = column.heat[k]; }
  THAWSLIDE_ROLLED for (int iteration = 0; iteration < most_iterations; ++iteration) {
    double below[count], diagonal[count], above[count], change[count], capacity[count];
    flow[0] = flow[count] = 0.0;
    THAWSLIDE_ROLLED for (int k = 1; k < count; ++k) {
      flow[k] = dt * conductance.between[k - 1] * (column.temperature[k - 1] - column.temperature[k]);
    }
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::ground; ++k) { capacity[k] = of.frozen[k]; }
    THAWSLIDE_ROLLED for (int k = ColumnCells::ground; k < count; k += cell_lanes) {
      store_cells(physics::apparent_capacity(model.curve, of.of_cells(k), load_cells(column.temperature + k)),
                  capacity + k);
    }
    THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
      below[k] = k > 0 ? -dt * conductance.between[k - 1] : 0.0;
      above[k] = k + 1 < count ? -dt * conductance.between[k] : 0.0;
      diagonal[k] = capacity[k] - below[k] - above[k];
      change[k] = column.heat[k] + flow[k] - flow[k + 1] - guess[k];
    }
    solve_tridiagonal<count>(below, diagonal, above, change);
    double largest = 0;
    THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
      guess[k] += capacity[k] * change[k];
      largest = max(largest, std::abs(change[k]));
    }
    find_temperatures(model.curve, of, guess, column.temperature);
    if (largest < close) {
      break;
    }
  }
  THAWSLIDE_ROLLED for (int k = 1; k < count; ++k) {
    flow[k] = dt * conductance.between[k - 1] * (column.temperature[k - 1] - column.temperature[k]);
  }
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) { column.heat[k] += flow[k] - flow[k + 1]; }
}

// Removes water from a cell as steam, with its heat. steam [kg/m2].
template <class Curve>
THAWSLIDE_HD void release_steam(const ColumnModel<Curve>& model, double steam, int cell, BandColumn& column,
                                ColumnBudget& budget) {
  const double temperature = column.temperature[ColumnCells::ground + cell];
  const double heat = steam * (water_enthalpy(model, temperature) + heat_of_vaporization(temperature));
  column.water[cell] -= steam;
  column.heat[ColumnCells::ground + cell] -= heat;
  budget.steam += steam;
  budget.steam_heat += heat;
}

// Boils water at the temperature at which its steam pressure reaches the load. Heat above that temperature converts
// water to steam, which escapes from below the sliding mass, until no water is left. Dry material is heated further.
template <class Curve>
THAWSLIDE_HD void boil(const ColumnModel<Curve>& model, const ColumnGrid& grid, double normal_pressure,
                       BandColumn& column, ColumnBudget& budget) {
  double boiling = 0;  // [C], 0: not computed yet
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    double& temperature = column.temperature[ColumnCells::ground + k];
    if (!(temperature > Steam::boiling_at_atmosphere) || !(column.water[k] > 0.0)) {
      continue;
    }
    if (boiling == 0.0) {
      boiling = boiling_temperature(model.pressurization ? normal_pressure : 0.0);
    }
    if (temperature > boiling) {
      const int cell = ColumnCells::ground + k;
      const double surplus =
          column.heat[cell] - enthalpy(model.curve, cell_coefficients(model, grid, column, cell), boiling);
      temperature = boiling;
      release_steam(model, min(column.water[k], surplus / heat_of_vaporization(boiling)), k, column, budget);
    }
  }
}

// Steam pressure in a cell with water [Pa], above atmospheric pressure: 0 below 100 C.
template <class Curve>
THAWSLIDE_HD double steam_pressure(const ColumnModel<Curve>& model, const BandColumn& column, int cell) {
  const double temperature = column.temperature[ColumnCells::ground + cell];
  if (!model.steam || !(temperature > Steam::boiling_at_atmosphere) || !(column.water[cell] > 0.0)) {
    return 0.0;
  }
  return saturation_pressure(temperature) - Steam::atmosphere;
}

}  // namespace thawslide::physics
