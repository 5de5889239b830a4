// Material points: all particle fields, declared once.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "base/linear.hpp"
#include "mpm/field.hpp"

namespace thawslide::mpm {

// Largest number of particles. Limit of index arithmetic: an affine velocity has nine numbers per particle.
inline constexpr double most_particles = 2.3e8;

template <int Dim>
class Particles {
 public:
  static constexpr int tensor_components = Dim == 2 ? 4 : 6;
  using Scalar = Field<double, 1>;
  using VectorField = Field<double, Dim>;
  using TensorField = Field<double, tensor_components>;

  FieldList fields;

  // clang-format off
  Field<std::int64_t, 1> id{fields, {"id", "1", FieldShape::scalar, "number of the particle"}};
  Field<std::int32_t, 1> body{
      fields, {"body", "1", FieldShape::scalar, "number of the body, from 0 in alphabetical order of the names"}};
  Field<std::int32_t, 1> material{fields, {"material", "1"}};
  Scalar mass{fields, {"mass", "kg", FieldShape::scalar, "mass; in 2D per metre of width"}};
  Scalar volume{fields, {"volume", "m3", FieldShape::scalar, "volume; in 2D per metre of width"}};
  Scalar initial_volume{fields, {"initial_volume", "m3"}};
  VectorField position{fields, {"position", "m", FieldShape::vector}};  // relative to the domain's lower corner
  VectorField velocity{fields, {"velocity", "m/s", FieldShape::vector, "velocity"}};
  // C of APIC: the velocity around the particle is v + C (x - x_p); by columns
  Field<double, Dim * Dim> affine_velocity{fields, {"affine_velocity", "1/s", FieldShape::matrix}};
  VectorField displacement{fields, {"displacement", "m", FieldShape::vector, "displacement since t = 0"}};
  Scalar path_length{fields, {"path_length", "m", FieldShape::scalar, "length of the path travelled"}};
  TensorField stress{
      fields, {"stress", "Pa", FieldShape::tensor, "stress without viscous stress, tension positive"}};
  TensorField viscous_stress{fields, {"viscous_stress", "Pa", FieldShape::tensor}};
  Scalar plastic_strain{fields, {"plastic_strain", "1", FieldShape::scalar, "accumulated equivalent plastic strain"}};
  Scalar gap{fields, {"gap", "1", FieldShape::scalar,
                      "volumetric strain of gaps that have not closed yet, with `gaps_close_first`"}};
  Scalar temperature{fields, {"temperature", "C", FieldShape::scalar, "temperature"}};
  Scalar heat_content{fields, {"heat_content", "J/m3"}};     // per initial volume, 0 for frozen material at Tref
  Scalar initial_heat_content{fields, {"initial_heat_content", "J/m3"}};
  Scalar liquid_saturation{fields, {"liquid_saturation", "1", FieldShape::scalar, "liquid saturation S"}};
  Scalar porosity{fields, {"porosity", "1", FieldShape::scalar, "porosity n"}};
  Scalar initial_porosity{fields, {"initial_porosity", "1"}};
  Scalar initial_saturation{fields, {"initial_saturation", "1"}};
  Scalar ice_pressure{fields, {"ice_pressure", "Pa", FieldShape::scalar, "ice pressure P_I"}};
  Scalar liquid_pressure{fields, {"liquid_pressure", "Pa", FieldShape::scalar, "liquid pressure P_L"}};
  Scalar pore_pressure{fields, {"pore_pressure", "Pa", FieldShape::scalar, "pore pressure P of Eq. 21"}};
  Scalar pore_void{fields, {"pore_void", "1"}};              // left by the water after melting, fraction of volume
  Scalar normal_load{fields, {"normal_load", "Pa"}};         // N of the column above
  Scalar seeped_water{fields, {"seeped_water", "kg"}};       // net water gained by seepage
  Scalar flow_depth{fields, {"flow_depth", "m"}};            // H of P_I = rho_I g H
  Scalar thermal_scaling{fields, {"thermal_scaling", "1"}};  // current xi
  Scalar contact_offset{fields, {"contact_offset", "m"}};    // distance from the ground at which it touches
  Scalar slip{fields, {"slip", "m", FieldShape::scalar, "slip along the ground, accumulated"}};
  Field<std::int32_t, 1> in_band{fields, {"in_band", "1", FieldShape::scalar, "1 in the band, otherwise 0"}};
  // Deformation F in the horizontal plane, at constant height above the ground; by columns (mpm/splitting.hpp)
  Field<double, (Dim - 1) * (Dim - 1)> surface_stretch{fields, {"surface_stretch", "1", FieldShape::matrix}};
  Field<std::int64_t, 1> parent_id{
      fields, {"parent_id", "1", FieldShape::scalar,
               "with `split_stretched`: number of the particle from which it was split, otherwise its own number", true,
               true}};
  // Within a step only: displacement and its volumetric strain, temperature before the step, secant capacity, changes
  // by conduction and seepage within the cell, and change of N.
  VectorField step_displacement{fields, {"step_displacement", "m", FieldShape::vector, nullptr, false}};
  Scalar volume_strain{fields, {"volume_strain", "1", FieldShape::scalar, nullptr, false}};
  Scalar previous_temperature{fields, {"previous_temperature", "C", FieldShape::scalar, nullptr, false}};
  Scalar secant_capacity{fields, {"secant_capacity", "J/m3/K", FieldShape::scalar, nullptr, false}};
  Scalar conduction_in_cell{fields, {"conduction_in_cell", "K", FieldShape::scalar, nullptr, false}};
  Scalar seepage_in_cell{fields, {"seepage_in_cell", "Pa", FieldShape::scalar, nullptr, false}};
  Scalar load_change{fields, {"load_change", "Pa", FieldShape::scalar, nullptr, false}};
  // With ground (mpm/mapping.hpp): vertical height above it, and its slope below
  Scalar height_above_ground{fields, {"height_above_ground", "m", FieldShape::scalar, nullptr, false}};
  Field<double, Dim - 1> ground_slope{fields, {"ground_slope", "1", FieldShape::vector, nullptr, false}};
  // The same by linear shape functions
  Field<double, Dim - 1> linear_slope{fields, {"linear_slope", "1", FieldShape::vector, nullptr, false}};
  // clang-format on

  Particles() = default;
  Particles(const Particles&) = delete;
  Particles& operator=(const Particles&) = delete;

  [[nodiscard]] std::size_t size() const { return size_; }

  void resize(std::size_t particles) {
    size_ = particles;
    for (FieldBase* field : fields.all()) {
      field->resize(particles);
    }
  }

  static constexpr std::uint32_t nowhere = ~std::uint32_t{0};

  // Removes the marked particles; the last ones in memory fill their places. Returns the new place of each particle.
  std::vector<std::uint32_t> remove(const std::vector<std::uint8_t>& marked) {
    THAWSLIDE_ASSERT(marked.size() == size_, "{} marks for {} particles", marked.size(), size_);
    std::vector<std::uint32_t> now_at(size_);
    std::iota(now_at.begin(), now_at.end(), 0u);
    std::size_t end = size_;
    for (std::size_t p = 0; p < end; ++p) {
      while (end > p && marked[end - 1] != 0) {
        now_at[--end] = nowhere;
      }
      if (p < end && marked[p] != 0) {
        now_at[p] = nowhere;
        now_at[--end] = static_cast<std::uint32_t>(p);
        for (FieldBase* field : fields.all()) {
          field->copy(end, p);
        }
      }
    }
    set_size(end);
    return now_at;
  }

  // Appends particles with all values 0; returns the place of the first one. The caller must assign ids that were never
  // used in the run.
  std::size_t append(std::size_t count) {
    const std::size_t first = size_;
    set_size(size_ + count);
    return first;
  }

  void reorder(const std::vector<std::uint32_t>& order) {
    for (FieldBase* field : fields.all()) {
      field->reorder(order, reorder_buffer_);
    }
  }

 private:
  void set_size(std::size_t particles) {
    size_ = particles;
    for (FieldBase* field : fields.all()) {
      field->set_size(particles);
    }
  }

  std::size_t size_ = 0;
  ReorderBuffer reorder_buffer_;  // persistent, to avoid allocation in each step
};

// Particle tensor as a full six-component tensor; plane strain has zz but no yz, xz.
template <int Dim>
SymmetricTensor<double> full_tensor(const typename Particles<Dim>::TensorField& field, std::size_t particle) {
  SymmetricTensor<double> s = SymmetricTensor<double>::Zero();
  for (int c = 0; c < Particles<Dim>::tensor_components; ++c) {
    s[c] = field(particle, c);
  }
  return s;
}

}  // namespace thawslide::mpm
