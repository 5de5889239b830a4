#include "sim/setup/columns_model.hpp"

#include <cmath>

namespace thawslide::sim {

namespace {

template <class Curve>
physics::ColumnModel<Curve> column_model(const config::Case& parameters, const physics::Phases& phases,
                                         const Curve& curve, const ColumnMaterial& material) {
  const config::Pressure& pressure = parameters.pressure;
  physics::ColumnModel<Curve> column;
  column.phases = phases;
  column.curve = curve;
  column.water_expansion = {parameters.phases.water_expansion_law, phases.water_expansion};
  column.porosity = material.porosity;
  column.hydraulic_conductivity = material.hydraulic_conductivity;
  column.skeleton_compressibility = pressure.skeleton_compressibility;
  column.residual_stress = pressure.residual_stress;
  column.at_frozen =
      pressure.frozen_rows == config::FrozenRows::vented ? physics::EndOfWater::vented : physics::EndOfWater::sealed;
  column.at_top = pressure.column_top;
  column.water_to_steam_viscosity = pressure.water_to_steam_viscosity;
  column.latent = parameters.heat.latent;
  column.conduction = parameters.heat.conduction;
  column.seepage = pressure.seepage;
  column.pressurization = pressure.enabled && pressure.thermal_pressurization;
  column.steam = parameters.heat.steam;
  column.ground_conductivity = phases.rock_conductivity;
  column.ground_capacity = phases.rock_density * phases.rock_heat_capacity;
  column.ground_cell = parameters.band.thickness.smallest() / physics::ColumnCells::band;
  return column;
}

}  // namespace

template <int Dim>
band::ColumnsModel make_columns_model(const config::Case& parameters, const Model<Dim>& model,
                                      const ColumnMaterial& material) {
  const config::Band& band = parameters.band;
  band::ColumnsModel columns;
  columns.column = model.band.with_heat_content([&](const auto& content) -> band::AnyColumnModel {
    return column_model(parameters, model.motion.phases, content.curve, material);
  });
  columns.body_temperature = material.temperature;
  columns.ground_temperature = std::isnan(band.ground_temperature) ? material.temperature : band.ground_temperature;
  columns.density = model.band.with_heat_content([&](const auto& content) {
    return physics::mixture_density(model.motion.phases, material.porosity,
                                    content.curve.saturation(columns.body_temperature));
  });
  columns.load_time = band.load_time;
  columns.step = band.column_step;
  columns.growth = band.growth;
  columns.grain_size = band.grain_size;
  columns.inertial_number = band.inertial_number;
  columns.growth_per_slip = band.growth_per_slip;
  columns.mixing_slip = band.mixing_slip;
  columns.rock_density = model.motion.phases.rock_density;
  columns.largest_thickness = material.depth;
  return columns;
}

template band::ColumnsModel make_columns_model(const config::Case&, const Model<2>&, const ColumnMaterial&);
template band::ColumnsModel make_columns_model(const config::Case&, const Model<3>&, const ColumnMaterial&);

}  // namespace thawslide::sim
