// Water of a column (band_column.hpp): pore filling and seepage (docs/theory/band-columns.md).
#pragma once

#include <cmath>

#include "physics/band_column_heat.hpp"

namespace thawslide::physics {

// Surplus theta of each cell. In a newly thawed cell, water takes over the part of the load that the ice carried.
template <class Curve>
THAWSLIDE_HD void fill_pores(const ColumnModel<Curve>& model, const ColumnGrid& grid, double normal_pressure,
                             const bool* was_melted, BandColumn& column) {
  const double storage = pore_storage(model.phases, model.porosity, model.skeleton_compressibility);
  const double on_thawing = thawing_surplus(storage, normal_pressure, model.residual_stress, 0.0) -
                            model.skeleton_compressibility * normal_pressure;
  const double reference = model.curve.reference_temperature;
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    const bool melted = is_melted(model, column, k);
    if (!melted || !was_melted[k]) {
      column.thawing[k] = on_thawing;
    }
    const double water = column.water[k] / (model.phases.water_density * grid.slide_height(k));
    const double temperature = column.temperature[ColumnCells::ground + k];
    const double swelling = model.pressurization && melted
                                ? (1.0 - model.porosity) * model.phases.rock_expansion * (temperature - reference) +
                                      water * model.water_expansion.swelling(reference, temperature)
                                : 0.0;
    column.surplus[k] =
        water - model.porosity + swelling + model.skeleton_compressibility * normal_pressure + column.thawing[k];
  }
}

// Water mobility per pressure and area [m/s/Pa]: between cells k - 1 and k, and from cells into air. Water flows
// through the fraction of the pores that it fills, steam through the rest.
struct ColumnMobility {
  double between[ColumnCells::slide + 1];
  double to_air[ColumnCells::slide], steam_to_air[ColumnCells::slide];
};

template <class Curve>
THAWSLIDE_HD ColumnMobility mobilities(const ColumnModel<Curve>& model, const ColumnGrid& grid,
                                       const BandColumn& column) {
  const double mobility = model.hydraulic_conductivity / model.phases.water_unit_weight;
  const auto wet = [&](int k) {
    const double filled = column.water[k] / (model.phases.water_density * grid.slide_height(k) * model.porosity);
    return min(1.0, max(0.0, filled));
  };
  ColumnMobility result{};
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    if (!is_melted(model, column, k)) {
      continue;
    }
    const bool top = k + 1 == ColumnCells::slide;
    if (!top && is_melted(model, column, k + 1)) {
      const int from = column.pressure[k] < column.pressure[k + 1] ? k + 1 : k;
      result.between[k + 1] = 2.0 * mobility * wet(from) / (grid.slide_height(k) + grid.slide_height(k + 1));
    }
    double open = 0;  // to the air
    if ((top ? model.at_top : model.at_frozen) == EndOfWater::vented && (top || !is_melted(model, column, k + 1))) {
      open += 2.0 * mobility / grid.slide_height(k);
    }
    if (k > 0 && model.at_frozen == EndOfWater::vented && !is_melted(model, column, k - 1)) {
      open += 2.0 * mobility / grid.slide_height(k);
    }
    result.to_air[k] = open * wet(k);
    result.steam_to_air[k] = open * (1.0 - wet(k));
  }
  return result;
}

// Bounds within which the pressure of each cell follows its surplus [Pa]. Steam maintains the lower bound in a void.
struct PressureBounds {
  double lower[ColumnCells::slide], upper;

  template <class Curve>
  THAWSLIDE_HD PressureBounds(const ColumnModel<Curve>& model, double normal_pressure, const BandColumn& column)
      : upper(normal_pressure) {
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
      lower[k] = min(upper, steam_pressure(model, column, k));
    }
  }
};

template <class Curve>
THAWSLIDE_HD void set_pressures(const ColumnModel<Curve>& model, const PressureBounds& bounds, BandColumn& column) {
  const double storage = pore_storage(model.phases, model.porosity, model.skeleton_compressibility);
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    const bool acts = model.pressurization && is_melted(model, column, k);
    column.pressure[k] = acts ? min(max(column.surplus[k] / storage, bounds.lower[k]), bounds.upper) : 0.0;
  }
}

// Moves water, with its heat, upward through the lower face of each cell and into the air. flow, to_air: volumes per
// area [m]. All outflows of a cell are reduced by the same factor if they exceed its water.
template <class Curve>
THAWSLIDE_HD void carry_water(const ColumnModel<Curve>& model, const double* flow, const double* to_air,
                              BandColumn& column, ColumnBudget& budget) {
  constexpr int count = ColumnCells::slide;
  const double density = model.phases.water_density;
  double fraction[count], water[count + 1] = {}, heat[count + 1] = {};
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
    const double out = density * (max(flow[k + 1], 0.0) + max(-flow[k], 0.0) + to_air[k]);
    const double available = max(column.water[k], 0.0);  // round-off may leave a negative value
    fraction[k] = out > available ? available / out : 1.0;
  }
  const auto enthalpy_in = [&](int k) { return water_enthalpy(model, column.temperature[ColumnCells::ground + k]); };
  THAWSLIDE_ROLLED for (int k = 1; k < count; ++k) {
    if (flow[k] != 0.0) {
      const int from = flow[k] > 0.0 ? k - 1 : k;
      water[k] = density * flow[k] * fraction[from];
      heat[k] = water[k] * enthalpy_in(from);
    }
  }
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
    const double vented = density * to_air[k] * fraction[k];
    const double vented_heat = vented > 0.0 ? vented * enthalpy_in(k) : 0.0;
    column.water[k] += water[k] - water[k + 1] - vented;
    column.heat[ColumnCells::ground + k] += heat[k] - heat[k + 1] - vented_heat;
    budget.vented_water += vented;
    budget.vented_heat += vented_heat;
  }
}

// Seepage of steam into the air, by Darcy's law with the density and viscosity of steam.
template <class Curve>
THAWSLIDE_HD void vent_steam(const ColumnModel<Curve>& model, const ColumnMobility& mobility, double dt,
                             BandColumn& column, ColumnBudget& budget) {
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    const double pressure = mobility.steam_to_air[k] > 0.0 ? steam_pressure(model, column, k) : 0.0;
    if (pressure > 0.0) {
      const double absolute = column.temperature[ColumnCells::ground + k] + celsius_to_kelvin;
      const double density = (pressure + Steam::atmosphere) / (Steam::gas_constant * absolute);
      const double volume = dt * mobility.steam_to_air[k] * model.water_to_steam_viscosity * pressure;
      release_steam(model, min(column.water[k], density * volume), k, column, budget);
    }
  }
}

// One step of seepage, implicit: pressures follow from the surplus at the end of the step. At a bound, P is independent
// of the surplus; Newton's iteration finds the cells at a bound.
template <class Curve>
THAWSLIDE_HD void seep_in_column(const ColumnModel<Curve>& model, const ColumnGrid& grid, double dt,
                                 double normal_pressure, BandColumn& column, ColumnBudget& budget) {
  constexpr int count = ColumnCells::slide, most_iterations = 40;
  const PressureBounds bounds(model, normal_pressure, column);
  const ColumnMobility mobility = mobilities(model, grid, column);
  const double storage = pore_storage(model.phases, model.porosity, model.skeleton_compressibility);
  const double close = 1e-12 * storage * max(normal_pressure, 1.0);
  double before[count], flow[count + 1],
      to_air[count];  // volumes per area, upward through the lower face of each cell [m]
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) { before[k] = column.surplus[k]; }
  flow[0] = flow[count] = 0.0;
  THAWSLIDE_ROLLED for (int iteration = 0; iteration <= most_iterations; ++iteration) {
    set_pressures(model, bounds, column);
    THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
      if (k > 0) {
        flow[k] = dt * mobility.between[k] * (column.pressure[k - 1] - column.pressure[k]);
      }
      to_air[k] = dt * mobility.to_air[k] * column.pressure[k];
    }
    double below[count], diagonal[count], above[count], change[count], largest = 0;
    THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
      change[k] = before[k] - column.surplus[k] + (flow[k] - flow[k + 1] - to_air[k]) / grid.slide_height(k);
      largest = max(largest, std::abs(change[k]));
    }
    if (largest < close || iteration == most_iterations) {
      break;
    }
    const auto follows = [&](int k) {  // dP/d theta
      const double pressure = column.surplus[k] / storage;
      return pressure > bounds.lower[k] && pressure < bounds.upper ? 1.0 / storage : 0.0;
    };
    THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
      const double per_height = dt / grid.slide_height(k);
      below[k] = k > 0 ? -per_height * mobility.between[k] * follows(k - 1) : 0.0;
      above[k] = k + 1 < count ? -per_height * mobility.between[k + 1] * follows(k + 1) : 0.0;
      diagonal[k] =
          1.0 + per_height * (mobility.between[k] + mobility.between[k + 1] + mobility.to_air[k]) * follows(k);
    }
    solve_tridiagonal<count>(below, diagonal, above, change);
    THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) { column.surplus[k] += change[k]; }
  }
  carry_water(model, flow, to_air, column, budget);
  vent_steam(model, mobility, dt, column, budget);
}

}  // namespace thawslide::physics
