// Block of frictional material that slides down a plane, with its front half melted and the rest about to melt. It is
// seeded independently of the other modules, for comparing steps on GPU and CPU.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "band/body_sums.hpp"
#include "device/step_model.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::gpu_test {

// All fields of a given number of particles, initially 0.
template <int Dim>
class ParticleMemory {
 public:
  explicit ParticleMemory(std::size_t count) : count_(count) {
    mpm::for_fields_of(view_, view_, [&](auto& field, const auto& /*same*/) { allocate(field); });
  }
  ParticleMemory(const ParticleMemory&) = delete;
  ParticleMemory& operator=(const ParticleMemory&) = delete;

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const mpm::ParticleView<Dim>& view() const { return view_; }

 private:
  template <class T, int Components>
  void allocate(mpm::FieldView<T, Components>& field) {
    constexpr std::size_t block = mpm::particles_of_block;
    const std::size_t numbers = (count_ + block - 1) / block * block * Components;
    memory_.emplace_back(numbers * sizeof(T), std::byte{0});
    field.numbers = reinterpret_cast<T*>(memory_.back().data());
  }

  std::size_t count_;
  mpm::ParticleView<Dim> view_{};
  std::vector<std::vector<std::byte>> memory_;
};

inline constexpr double cell = 1.0;         // [m]
inline constexpr double ground = 8.0;       // elevation of the ground [m]
inline constexpr double density = 2000.0;   // [kg/m3]
inline constexpr double slope = 35.0;       // [degrees]
inline constexpr double time_step = 1e-3;   // [s]
inline constexpr std::size_t per_axis = 2;  // particles per cell

// Cells of the block along each axis; the second one is unused in 2D.
struct Size {
  std::size_t length, width, height;

  [[nodiscard]] std::size_t particles(int dim) const {
    const std::size_t in_plane = length * height * per_axis * per_axis;
    return dim == 2 ? in_plane : in_plane * width * per_axis;
  }
};

inline physics::Phases phases() {
  return {.rock_density = 2700.0,
          .ice_density = 917.0,
          .water_density = 1000.0,
          .rock_heat_capacity = 800.0,
          .ice_heat_capacity = 2100.0,
          .water_heat_capacity = 4200.0,
          .rock_conductivity = 3.0,
          .ice_conductivity = 2.2,
          .water_conductivity = 0.6,
          .rock_expansion = 3e-5,
          .ice_expansion = 1.5e-4,
          .water_expansion = 1e-4,
          .water_bulk_modulus = 2e9,
          .latent_heat = 3.34e5,
          .water_unit_weight = 9810.0,
          .ice_to_rock_density_ratio = 0.34};
}
inline physics::HeatContent<physics::PowerLawCurve> heat_content() { return {phases(), {0.0, 5.0}, true}; }

template <int Dim>
void seed(const Size& size, ParticleMemory<Dim>& memory) {
  const mpm::ParticleView<Dim>& p = memory.view();
  const std::array<std::size_t, 3> count{size.length * per_axis, (Dim == 2 ? size.height : size.width) * per_axis,
                                         size.height * per_axis};
  const double spacing = cell / static_cast<double>(per_axis);
  double volume = 1;
  for (int a = 0; a < Dim; ++a) {
    volume *= spacing;
  }
  for (std::size_t k = 0; k < memory.size(); ++k) {
    const std::array<std::size_t, 3> place{k % count[0], k / count[0] % count[1], k / count[0] / count[1]};
    p.id(k) = static_cast<std::int64_t>((k * 7919) % memory.size() * 3);  // unordered, with gaps
    for (int a = 0; a < Dim; ++a) {
      const double from = a == Dim - 1 ? ground : 16.0 * cell;
      // Displaced, so that no two particles behave alike or change cell in the same step.
      const double off = 0.45 * std::sin(static_cast<double>(k % 1009) + 2.4 * a);
      p.position(k, a) = from + (static_cast<double>(place[static_cast<std::size_t>(a)]) + 0.5 + off) * spacing;
    }
    p.height_above_ground(k) = p.position(k, Dim - 1) - ground;
    p.volume(k) = p.initial_volume(k) = volume;
    p.mass(k) = density * volume;
    p.velocity(k, 0) = 3.0 + 6.0 * static_cast<double>(place[Dim - 1]) / static_cast<double>(count[2]);  // shear
    p.velocity(k, Dim - 1) = -0.3;
    const double depth = static_cast<double>(size.height) * cell - p.height_above_ground(k);
    for (int c = 0; c < 3; ++c) {
      p.stress(k, c) = -0.5 * density * 9.81 * depth;
    }
    const bool melted = 2 * place[0] >= count[0];
    p.temperature(k) = p.previous_temperature(k) =
        (melted ? 1.0 : -2e-4) + 1e-4 * std::sin(static_cast<double>(k % 17));
    p.porosity(k) = p.initial_porosity(k) = 0.3;
    p.heat_content(k) = heat_content().content(p.temperature(k), p.porosity(k));
    p.liquid_saturation(k) = p.initial_saturation(k) = heat_content().curve.saturation(p.temperature(k));
    p.liquid_pressure(k) = p.pore_pressure(k) = melted ? 1e4 : 0.0;
    p.pore_void(k) = melted ? 0.0 : 1e-5;
    p.contact_offset(k) = 0.5 * spacing;
    p.gap(k) = k % 2 == 0 ? 0.0 : 0.1;
    p.thermal_scaling(k) = 1.0;
  }
}

template <int Dim>
device::StepModel<Dim> model_of_slide() {
  device::StepModel<Dim> model;
  model.cell = cell;
  model.mapping.has_ground = true;
  model.columns.columns.fill(1);  // others have the same height
  model.columns.chunks.fill(1);
  model.half_sizes = {0.5 / static_cast<double>(per_axis)};
  model.motion.gravity.setZero();
  model.motion.gravity[0] = 9.81 * std::sin(slope * pi / 180.0);
  model.motion.gravity[Dim - 1] = -9.81 * std::cos(slope * pi / 180.0);
  model.motion.pic_fraction = 0.01;
  mpm::MaterialModel material;
  material.elastic = physics::Elastic::from_young_poisson(1e8, 0.3);
  const double friction_angle = 30.0 * pi / 180.0;
  material.law = physics::MohrCoulomb<>::make(material.elastic, {.friction_angle = friction_angle,
                                                                 .dilation_angle = 0.0,
                                                                 .cohesion = 1e3,
                                                                 .residual_cohesion = 1e3,
                                                                 .tension_cutoff = 1e3,
                                                                 .residual_friction_angle = friction_angle});
  model.motion.materials = {material};
  model.free_gaps = {1.0};
  model.motion.phases = phases();
  model.band.heat_content = heat_content();
  model.band.phases = model.motion.phases;
  model.band.gravity = 9.81;
  model.band.frozen_rows = band::FrozenRows::vented;
  model.band.ice_presses = false;
  model.band.melt_contracts = true;
  model.band.skeleton_compressibility = 2e-9;
  model.band.water.law = physics::WaterExpansionLaw::by_temperature;
  model.band.conservative_advection = true;
  model.band.hydraulic_conductivity = {1e-9};
  model.band_thickness = [cell = model.cell](double /*time*/) { return cell / 10.0; };
  model.band.region = band::BandRegion::first_layer;
  model.extent.setConstant(1e5);
  model.lower.setZero();
  model.upper = model.extent;
  model.contact.law.grounds[0].friction = physics::basal::ConstantFriction{std::tan(20.0 * pi / 180.0)};
  model.contact.law.grounds[0].cohesion = physics::basal::ConstantCohesion{0.0};
  model.contact.distance_check = true;
  model.finds_extremes = model.counts_escaped = true;
  return model;
}

// Sums for rows of the history.
template <int Dim>
band::SumsOfParticle<Dim> sums_of_particle() {
  band::SumsOfParticle<Dim> of_particle;
  of_particle.gravity = model_of_slide<Dim>().motion.gravity;
  of_particle.origin.setZero();
  of_particle.phases = phases();
  of_particle.latent = of_particle.melt_contracts = true;
  of_particle.moved_distance = 1.0;
  return of_particle;
}

// Level ground.
template <int Dim>
bool query_ground(std::uint64_t block, terrain::GroundAtNode<Dim>* nodes) {
  using T = mpm::Tile<Dim>;
  const double face = Dim == 2 ? cell : cell * cell;
  for (int k = 0; k < T::nodes; ++k) {
    const int layer = T::node(T::index(block), k)[Dim - 1];
    terrain::GroundAtNode<Dim> node;
    node.normal.setZero();
    node.normal[Dim - 1] = -1.0;
    node.candidate = layer <= 0;
    node.plane = layer <= 0 ? -ground : std::numeric_limits<double>::infinity();
    node.plane_scale = layer <= 0 ? 1.0 : 0.0;
    node.area = layer == 0 ? face : 0.0;
    node.elevation = ground + static_cast<double>(layer) * cell;
    nodes[k] = node;
  }
  return true;
}

template <int Dim>
device::HostCallbacks<Dim> terrain_of_slide() {
  using Place = Vector<double, Dim - 1>;
  device::HostCallbacks<Dim> ask;
  ask.ground = query_ground<Dim>;
  ask.column_heights = [] { return std::vector<double>(terrain::ColumnChunks<Dim>::size, ground); };
  ask.slope_cosine = [](const Place& /*place*/) { return 1.0; };
  ask.normal_gravity = [](const Place& /*place*/) { return 9.81 * std::cos(slope * pi / 180.0); };
  return ask;
}

}  // namespace thawslide::gpu_test
