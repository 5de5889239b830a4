// The particle fields, one per line: field(type, components, name, unit[, shape, meaning, ...]), from the unit on as in
// FieldInfo (mpm/field.hpp). Particles, views, checkpoints, snapshots, re-ordering and devices use this list.
#pragma once

namespace thawslide::mpm {

template <int Dim>
inline constexpr int tensor_components = Dim == 2 ? 4 : 6;  // in plane strain without yz and xz

}  // namespace thawslide::mpm

// clang-format off
#define THAWSLIDE_PARTICLE_FIELDS(field) \
  field(std::int64_t, 1, id, "1", FieldShape::scalar, "number of the particle") \
  field(std::int32_t, 1, body, "1", FieldShape::scalar, \
        "number of the body, from 0 in alphabetical order of the names") \
  field(std::int32_t, 1, material, "1") \
  field(double, 1, mass, "kg", FieldShape::scalar, "mass; in 2D per metre of width") \
  field(double, 1, volume, "m3", FieldShape::scalar, "volume; in 2D per metre of width") \
  field(double, 1, initial_volume, "m3") \
  /* relative to the lower corner of the domain */ \
  field(double, Dim, position, "m", FieldShape::vector) \
  field(double, Dim, velocity, "m/s", FieldShape::vector, "velocity") \
  /* C of APIC, by columns: the velocity around the particle is v + C (x - x_p) */ \
  field(double, Dim * Dim, affine_velocity, "1/s", FieldShape::matrix) \
  field(double, Dim, displacement, "m", FieldShape::vector, "displacement since t = 0") \
  field(double, 1, path_length, "m", FieldShape::scalar, "length of the path travelled") \
  field(double, tensor_components<Dim>, stress, "Pa", FieldShape::tensor, \
        "stress without viscous stress, tension positive") \
  field(double, tensor_components<Dim>, viscous_stress, "Pa", FieldShape::tensor) \
  field(double, 1, plastic_strain, "1", FieldShape::scalar, "accumulated equivalent plastic strain") \
  field(double, 1, gap, "1", FieldShape::scalar, \
        "volumetric strain of gaps that have not closed yet, with `gaps_close_first`") \
  field(double, 1, temperature, "C", FieldShape::scalar, "temperature") \
  /* per initial volume, 0 for frozen material at Tref */ \
  field(double, 1, heat_content, "J/m3") \
  field(double, 1, initial_heat_content, "J/m3") \
  field(double, 1, liquid_saturation, "1", FieldShape::scalar, "liquid saturation S") \
  field(double, 1, porosity, "1", FieldShape::scalar, "porosity n") \
  field(double, 1, initial_porosity, "1") \
  field(double, 1, initial_saturation, "1") \
  field(double, 1, ice_pressure, "Pa", FieldShape::scalar, "ice pressure P_I") \
  field(double, 1, liquid_pressure, "Pa", FieldShape::scalar, "liquid pressure P_L") \
  field(double, 1, pore_pressure, "Pa", FieldShape::scalar, "pore pressure P of Eq. 21") \
  /* left by the water after melting, fraction of volume; N of the column above; net water gained by seepage */ \
  field(double, 1, pore_void, "1") \
  field(double, 1, normal_load, "Pa") \
  field(double, 1, seeped_water, "kg") \
  /* H of P_I = rho_I g H; current xi; distance from the ground at which the particle touches it */ \
  field(double, 1, flow_depth, "m") \
  field(double, 1, thermal_scaling, "1") \
  field(double, 1, contact_offset, "m") \
  field(double, 1, slip, "m", FieldShape::scalar, "slip along the ground, accumulated") \
  field(std::int32_t, 1, in_band, "1", FieldShape::scalar, "1 in the band, otherwise 0") \
  /* deformation F in the horizontal plane, at constant height above the ground; by columns (mpm/splitting.hpp) */ \
  field(double, (Dim - 1) * (Dim - 1), surface_stretch, "1", FieldShape::matrix) \
  field(std::int64_t, 1, parent_id, "1", FieldShape::scalar, \
        "with `split_stretched`: number of the particle from which it was split, otherwise its own number", true, \
        true) \
  /* Within a step only: displacement and its volumetric strain, temperature before the step, secant capacity, */ \
  /* changes by conduction and seepage within the cell, and change of N */ \
  field(double, Dim, step_displacement, "m", FieldShape::vector, nullptr, false) \
  field(double, 1, volume_strain, "1", FieldShape::scalar, nullptr, false) \
  field(double, 1, previous_temperature, "C", FieldShape::scalar, nullptr, false) \
  field(double, 1, secant_capacity, "J/m3/K", FieldShape::scalar, nullptr, false) \
  field(double, 1, conduction_in_cell, "K", FieldShape::scalar, nullptr, false) \
  field(double, 1, seepage_in_cell, "Pa", FieldShape::scalar, nullptr, false) \
  field(double, 1, load_change, "Pa", FieldShape::scalar, nullptr, false) \
  /* With ground (mpm/mapping.hpp): vertical height above it, and its slope below; by linear shape functions, too */ \
  field(double, 1, height_above_ground, "m", FieldShape::scalar, nullptr, false) \
  field(double, Dim - 1, ground_slope, "1", FieldShape::vector, nullptr, false) \
  field(double, Dim - 1, linear_slope, "1", FieldShape::vector, nullptr, false)
// clang-format on
