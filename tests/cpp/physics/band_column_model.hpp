// Shared by tests of band columns: a model of thawing rock and ice, and drives without effect.
#pragma once

#include <limits>

#include "physics/band_column_step.hpp"
#include "table1.hpp"

namespace thawslide::physics {

template <class Curve>
using ModelOf = ColumnModel<Curve>;
using Model = ModelOf<PowerLawCurve>;
using Column = BandColumn;
using Drive = ColumnDrive;
using Cells = ColumnCells;

constexpr double load = 5e5;  // N [Pa]

inline Model make_model() {
  Model model;
  model.phases = table1();
  model.curve = {0.0, 5.0};
  model.water_expansion = {WaterExpansionLaw::constant, model.phases.water_expansion};
  model.porosity = 0.375;
  model.hydraulic_conductivity = 1e-7;
  model.skeleton_compressibility = 2e-9;
  model.residual_stress = std::numeric_limits<double>::infinity();
  model.ground_conductivity = 3.0;
  model.ground_capacity = 2.36e6;
  model.ground_cell = 0.01;
  return model;
}

template <class Curve>
Drive drive_of(const ModelOf<Curve>& model, double dt, double thickness, double body_temperature) {
  return {dt,
          load,
          0.0,
          0.0,
          thickness,
          model.growth,
          0.0,
          body_enthalpy(model, body_temperature),
          water_of_full_pores(model, body_temperature)};
}

template <class Curve>
double melted_capacity(const ModelOf<Curve>& model) {  // [J/m3/K], pores full of water
  const auto of = slide_coefficients(model, 1.0, model.porosity * model.phases.water_density);
  return of.frozen + of.rise;
}
template <class Curve>
double storage(const ModelOf<Curve>& model) {
  return pore_storage(model.phases, model.porosity, model.skeleton_compressibility);
}
inline double swelling(const Model& model, double from, double to) {
  return melted_swelling(model.phases, model.water_expansion, model.porosity, from, to);
}

}  // namespace thawslide::physics
