// Reference for band/pressure_kernels.hpp: pressures and water of one particle after heat and seepage.
#pragma once

#include <algorithm>

#include "scalar_columns.hpp"

namespace thawslide::testing_support {

template <int Dim>
class ScalarWater {
 public:
  static constexpr double tref = 0.0;

  ScalarWater(const sim::Model<Dim>& model, const ScalarColumns<Dim>& columns) : model_(model), columns_(columns) {}

  // seeped: pressure change due to seepage [Pa]; drained_depth: depth below the top within which the pressure is
  // atmospheric [m].
  void update(Point<Dim>& p, double seeped, double drained_depth) const {
    const auto& band = model_.band;
    const double load_change = load(p);
    const double ice = physics::ice_pressure(band.phases, band.gravity, p.flow_depth);
    const double per_pressure = band.phases.water_density * storage(p) * p.volume / p.scaling;
    const bool flowing = p.old_temperature >= tref;
    const double start = band.ice_presses ? ice * band.phases.water_density / band.phases.ice_density
                                          : std::max(0.0, p.normal_load - band.residual_stress);
    const double before = (flowing ? p.liquid_pressure : start) + seeped, from = flowing ? p.old_temperature : tref;
    if (p.temperature < tref) {
      if (band.balances_water() && flowing) {
        balanced(p, before, from, load_change);
      }
      p.liquid_pressure = band.ice_presses ? physics::liquid_pressure_clapeyron(band.phases, ice, p.temperature, tref,
                                                                                band.clapeyron_sign)
                                           : 0.0;
      p.pore_pressure = band.ice_presses ? physics::pore_pressure(p.saturation, p.liquid_pressure, ice) : 0.0;
    } else {
      p.liquid_pressure = p.pore_pressure =
          band.balances_water() ? balanced(p, before, from, flowing ? load_change : 0.0) : pressurized(p, before, from);
      if (columns_.below_top(p) < drained_depth) {
        drain(p, per_pressure * p.pore_pressure);
        p.liquid_pressure = p.pore_pressure = 0.0;
      }
    }
    p.seeped_water += per_pressure * seeped;
  }

 private:
  [[nodiscard]] double storage(const Point<Dim>& p) const {
    return p.porosity / model_.band.phases.water_bulk_modulus + model_.band.skeleton_compressibility;
  }

  // Updates N; returns its change.
  double load(Point<Dim>& p) const {
    if (!model_.band.needs_normal_load()) {
      return 0.0;
    }
    const auto normal = model_.ground->normal_below(Vector<double, Dim - 1>::Zero(), 0.0);
    const double before = p.normal_load;
    p.normal_load = columns_.normal_load(p, model_.motion.gravity.dot(normal) * -normal[Dim - 1]);
    return p.normal_load - before;
  }

  [[nodiscard]] double pressurized(const Point<Dim>& p, double before, double from) const {
    return before + physics::undrained_pressure_coefficient(model_.band.phases, p.porosity, p.saturation) *
                        (p.temperature - from);
  }

  // Excess water, as a pressure or as a void.
  double balanced(Point<Dim>& p, double before, double from, double load_change) const {
    const auto& band = model_.band;
    const double to = std::max(p.temperature, tref);
    const double grains = (1.0 - p.porosity) * band.phases.rock_expansion * (to - from);
    const double water = p.porosity * band.water.swelling(from, to);
    const double surplus =
        storage(p) * before - p.pore_void + grains + water + band.skeleton_compressibility * load_change;
    p.pore_void = std::max(0.0, -surplus);
    return std::max(0.0, surplus) / storage(p);
  }

  void drain(Point<Dim>& p, double mass) const {
    p.seeped_water -= mass;
    if (model_.band.conservative_advection) {
      const double heat = std::max(0.0, mass) * model_.band.phases.water_heat_capacity * (p.temperature - tref) *
                          p.scaling / p.initial_volume;  // [J/m3]
      p.heat_content -= heat;
      p.temperature -= heat / physics::heat_capacity(model_.band.phases, p.initial_porosity, 1.0);
    }
  }

  const sim::Model<Dim>& model_;
  const ScalarColumns<Dim>& columns_;
};

}  // namespace thawslide::testing_support
