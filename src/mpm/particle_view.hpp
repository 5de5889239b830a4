// View of all particle fields for kernels on a device.
#pragma once

#include <cstdint>

#include "mpm/field_view.hpp"

namespace thawslide::mpm {

// Members, units and order as in mpm/particles.hpp. Fields that are not stored must not be accessed.
template <int Dim>
struct ParticleView {
  using Scalar = FieldView<double, 1>;
  using VectorField = FieldView<double, Dim>;
  using TensorField = FieldView<double, Dim == 2 ? 4 : 6>;

  FieldView<std::int64_t, 1> id;
  FieldView<std::int32_t, 1> body, material;
  Scalar mass, volume, initial_volume;
  VectorField position, velocity;
  FieldView<double, Dim * Dim> affine_velocity;
  VectorField displacement;
  Scalar path_length;
  TensorField stress, viscous_stress;
  Scalar plastic_strain, gap, temperature, heat_content, initial_heat_content, liquid_saturation, porosity;
  Scalar initial_porosity, initial_saturation, ice_pressure, liquid_pressure, pore_pressure, pore_void, normal_load;
  Scalar seeped_water, flow_depth, thermal_scaling;
  Scalar contact_offset, slip;
  FieldView<std::int32_t, 1> in_band;
  FieldView<double, (Dim - 1) * (Dim - 1)> surface_stretch;
  FieldView<std::int64_t, 1> parent_id;
  VectorField step_displacement;
  Scalar volume_strain, previous_temperature, secant_capacity, conduction_in_cell, seepage_in_cell, load_change;
  Scalar height_above_ground;
  FieldView<double, Dim - 1> ground_slope, linear_slope;
};

// Calls visit(field of a, field of b) for each field, in order. a, b: views, or particles.
template <class A, class B, class Visit>
void for_fields_of(A& a, B& b, const Visit& visit) {
  visit(a.id, b.id);
  visit(a.body, b.body);
  visit(a.material, b.material);
  visit(a.mass, b.mass);
  visit(a.volume, b.volume);
  visit(a.initial_volume, b.initial_volume);
  visit(a.position, b.position);
  visit(a.velocity, b.velocity);
  visit(a.affine_velocity, b.affine_velocity);
  visit(a.displacement, b.displacement);
  visit(a.path_length, b.path_length);
  visit(a.stress, b.stress);
  visit(a.viscous_stress, b.viscous_stress);
  visit(a.plastic_strain, b.plastic_strain);
  visit(a.gap, b.gap);
  visit(a.temperature, b.temperature);
  visit(a.heat_content, b.heat_content);
  visit(a.initial_heat_content, b.initial_heat_content);
  visit(a.liquid_saturation, b.liquid_saturation);
  visit(a.porosity, b.porosity);
  visit(a.initial_porosity, b.initial_porosity);
  visit(a.initial_saturation, b.initial_saturation);
  visit(a.ice_pressure, b.ice_pressure);
  visit(a.liquid_pressure, b.liquid_pressure);
  visit(a.pore_pressure, b.pore_pressure);
  visit(a.pore_void, b.pore_void);
  visit(a.normal_load, b.normal_load);
  visit(a.seeped_water, b.seeped_water);
  visit(a.flow_depth, b.flow_depth);
  visit(a.thermal_scaling, b.thermal_scaling);
  visit(a.contact_offset, b.contact_offset);
  visit(a.slip, b.slip);
  visit(a.in_band, b.in_band);
  visit(a.surface_stretch, b.surface_stretch);
  visit(a.parent_id, b.parent_id);
  visit(a.step_displacement, b.step_displacement);
  visit(a.volume_strain, b.volume_strain);
  visit(a.previous_temperature, b.previous_temperature);
  visit(a.secant_capacity, b.secant_capacity);
  visit(a.conduction_in_cell, b.conduction_in_cell);
  visit(a.seepage_in_cell, b.seepage_in_cell);
  visit(a.load_change, b.load_change);
  visit(a.height_above_ground, b.height_above_ground);
  visit(a.ground_slope, b.ground_slope);
  visit(a.linear_slope, b.linear_slope);
}

// Valid until the number of particles changes.
template <int Dim, template <int> class Particles>
ParticleView<Dim> view_of(Particles<Dim>& particles) {
  ParticleView<Dim> view{};
  for_fields_of(view, particles, [](auto& of_view, auto& field) { of_view = field.view(); });
  return view;
}

}  // namespace thawslide::mpm
