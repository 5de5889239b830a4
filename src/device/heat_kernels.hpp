// Device kernels of heat conduction other than those of band/heat_kernels.hpp, by the functions of band/nodal_heat.hpp.
#pragma once

#include "band/heat_kernels.hpp"
#include "band/nodal_heat.hpp"
#include "band/rescaling.hpp"
#include "device/node_kernels.hpp"

namespace thawslide::device {

// Sets the scaling of particles; sums the heat that the change of scaling adds.
template <int Dim, class Content>
struct RescaleBand {
  using Law = band::ParticleHeat<Content, band::InitialMasses>;
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = double;

  Content content;
  band::BandPhysics physics;
  bool has_water;
  band::BandScaling<Dim> scaling;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               double& added_heat) const {
    const std::uint32_t p = at.particle[0];
    const Law law{content};
    band::rescale_particle(physics, law, has_water, scaling.of(particles, p), p, particles, added_heat);
  }
};

// Nodal temperature rates, from sums with the tangent capacity, or with the secant capacity in blocks with temperature
// changes.
template <int Dim>
struct SolveRates {
  using Part = band::NodalHeat;
  using Sum = Part;
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  NodeViews<Dim> nodes;
  const double *tangent_rates, *secant_rates;
  const std::uint8_t* changing_blocks;  // null: none yet
  double* unreached_heat;
  double dt;
  const std::uint64_t* block_keys;
  band::HeatFaces<Dim> faces;
  bool has_faces, first_step;
  double cell;

  THAWSLIDE_HD void visit(std::size_t node, Part& part) const {
    using mpm::HeatRates;
    constexpr std::size_t size = mpm::record_size(HeatRates::size<Dim>);
    constexpr std::size_t unreached_size = mpm::record_size(mpm::UnreachedHeat::size<Dim>);
    const bool changes = changing_blocks != nullptr && changing_blocks[node / block_nodes] != 0;
    const double* rates = (changes ? secant_rates : tangent_rates) + node * size;
    const double* tangent = tangent_rates + node * size;
    for (std::size_t c = 1; c < unreached_size; ++c) {
      // cleared, because a pass that reads the record reads all its components
      unreached_heat[node * unreached_size + c] = 0.0;
    }
    band::solve_temperature_rate<Dim>(
        tangent, rates[HeatRates::capacity], rates[HeatRates::subgrid],
        nodes.contact_at(node)[mpm::Contact::friction_heat], static_cast<const double*>(nodes.momentum_at(node)), dt,
        nodes.state_at(node)[mpm::NodalState::temperature_rate], unreached_heat[node * unreached_size], part,
        [&](double& rate, double& power) {
          return has_faces && band::meets_face(faces.at(position_of_node<Dim>(block_keys, node, cell)), first_step,
                                               static_cast<const double*>(nodes.averages_at(node)),
                                               rates[HeatRates::capacity], cell, dt, rate, power, part.gain.boundary);
        });
  }
  THAWSLIDE_HD void add(const Part* parts, std::size_t count, Sum& sum) const {
    for (std::size_t k = 0; k < count; ++k) {
      sum += parts[k];
    }
  }
};

// Tile condition (device/marks.hpp): a temperature may change by more than is negligible.
template <int Dim, class Content>
struct MayChange {
  NodeViews<Dim> nodes;
  mpm::ParticleView<Dim> particles;
  Content content;
  double dt;

  [[nodiscard]] THAWSLIDE_HD bool of_node(std::size_t node) const {
    return !content.is_negligible(2.0 * (dt * nodes.state_at(node)[mpm::NodalState::temperature_rate]));
  }
  [[nodiscard]] THAWSLIDE_HD bool of_particle(std::uint32_t particle) const {
    return !content.is_negligible(2.0 * particles.conduction_in_cell(particle));
  }
};

// Tile condition: nodes hold friction heat to be passed on to particles.
template <int Dim>
struct HasHeat {
  const double* unreached_heat;

  [[nodiscard]] THAWSLIDE_HD bool of_node(std::size_t node) const {
    return unreached_heat[node * mpm::record_size(mpm::UnreachedHeat::size<Dim>)] != 0.0;
  }
  [[nodiscard]] THAWSLIDE_HD bool of_particle(std::uint32_t /*particle*/) const { return false; }
};

}  // namespace thawslide::device
