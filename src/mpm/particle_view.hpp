// All fields of the particles as kernels on a device see them.
#pragma once

#include <cstdint>

#include "mpm/field_view.hpp"

namespace thawslide::mpm {

// Members, their units and their order: as in mpm/particles.hpp. Numbers of fields that are not kept must not be
// touched.
template <int Dim, class Real>
struct ParticleView {
  using Scalar = FieldView<Real, 1>;
  using VectorField = FieldView<Real, Dim>;
  using TensorField = FieldView<Real, Dim == 2 ? 4 : 6>;

  FieldView<std::int64_t, 1> id;
  FieldView<std::int32_t, 1> body, material;
  Scalar mass, volume, initial_volume;
  VectorField position, velocity;
  FieldView<Real, Dim * Dim> affine_velocity;
  VectorField displacement;
  Scalar path_length;
  TensorField stress, viscous_stress;
  Scalar plastic_strain, gap, temperature, heat_content, initial_heat_content, liquid_saturation, porosity;
  Scalar initial_porosity, initial_saturation, ice_pressure, liquid_pressure, pore_pressure, pore_void, normal_load;
  Scalar seeped_water, flow_depth, thermal_scaling;
  Scalar contact_offset, slip;
  FieldView<std::int32_t, 1> in_band;
  VectorField step_displacement;
  Scalar volume_strain, previous_temperature, secant_capacity, conduction_in_cell, seepage_in_cell, load_change;
};

// Holds until there are more or fewer particles.
template <int Dim, class Real, template <int, class> class Particles>
ParticleView<Dim, Real> view_of(Particles<Dim, Real>& particles) {
  Particles<Dim, Real>& p = particles;
  return {p.id.view(),
          p.body.view(),
          p.material.view(),
          p.mass.view(),
          p.volume.view(),
          p.initial_volume.view(),
          p.position.view(),
          p.velocity.view(),
          p.affine_velocity.view(),
          p.displacement.view(),
          p.path_length.view(),
          p.stress.view(),
          p.viscous_stress.view(),
          p.plastic_strain.view(),
          p.gap.view(),
          p.temperature.view(),
          p.heat_content.view(),
          p.initial_heat_content.view(),
          p.liquid_saturation.view(),
          p.porosity.view(),
          p.initial_porosity.view(),
          p.initial_saturation.view(),
          p.ice_pressure.view(),
          p.liquid_pressure.view(),
          p.pore_pressure.view(),
          p.pore_void.view(),
          p.normal_load.view(),
          p.seeped_water.view(),
          p.flow_depth.view(),
          p.thermal_scaling.view(),
          p.contact_offset.view(),
          p.slip.view(),
          p.in_band.view(),
          p.step_displacement.view(),
          p.volume_strain.view(),
          p.previous_temperature.view(),
          p.secant_capacity.view(),
          p.conduction_in_cell.view(),
          p.seepage_in_cell.view(),
          p.load_change.view()};
}

}  // namespace thawslide::mpm
