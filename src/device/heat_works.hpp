// What particles, nodes and tiles do to conduct heat on a device: the kernels of band/heat_kernels.hpp with what they
// refer to by value, and the functions of band/nodal_heat.hpp.
#pragma once

#include "band/heat_kernels.hpp"
#include "band/nodal_heat.hpp"
#include "device/node_works.hpp"
#include "device/tile_tables.hpp"

namespace thawslide::device {

// Scaling of a particle in the band, or of all; sums the heat that another scaling adds.
template <int Dim, class Real>
struct RescaleBand {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Account = Real;

  Real in_band;
  bool scales_all;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& /*seen*/, Added& /*added*/,
                               Real& added_heat) const {
    const std::uint32_t p = at.particle[0];
    const Real scaling = scales_all || particles.in_band(p) != 0 ? in_band : Real(1);
    const Real old = particles.thermal_scaling(p);
    if (scaling != old) {
      added_heat += particles.initial_volume(p) * particles.heat_content(p) * (Real(1) / scaling - Real(1) / old);
      particles.thermal_scaling(p) = scaling;
    }
  }
};

template <int Dim, class Real, class Content>
struct HeatFlows {
  using Law = band::ParticleHeat<Content, band::InitialMasses>;
  using Kernel = band::HeatFlows<Dim, Real, Law>;
  using Reads = typename Kernel::Reads;
  using Adds = typename Kernel::Adds;
  using Account = typename Kernel::Account;

  Content content;
  band::BandPhysics<Real> physics;
  band::HydraulicConductivity<Real> hydraulic;
  Real dt, inverse_cell;
  bool subgrid;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& seen, Added& added,
                               Account& account) const {
    const Law law{content};
    const Kernel kernel{physics, hydraulic, law, dt, inverse_cell, subgrid};
    kernel(particles, at, seen, added, account);
  }
};

template <int Dim, class Real, class Content>
struct SecantCapacity {
  using Law = band::ParticleHeat<Content, band::InitialMasses>;
  using Kernel = band::SecantCapacity<Dim, Real, Law>;
  using Reads = typename Kernel::Reads;
  using Adds = typename Kernel::Adds;
  using Account = typename Kernel::Account;

  Content content;
  Real dt;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& seen, Added& added,
                               Account& account) const {
    const Law law{content};
    const Kernel kernel{law, dt};
    kernel(particles, at, seen, added, account);
  }
};

template <int Dim, class Real, class Content>
struct TakeHeat {
  using Law = band::ParticleHeat<Content, band::InitialMasses>;
  using Kernel = band::TakeHeat<Dim, Real, Law>;
  using Reads = typename Kernel::Reads;
  using Adds = typename Kernel::Adds;
  using Account = typename Kernel::Account;

  Content content;
  band::BandPhysics<Real> physics;
  Real dt;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& seen, Added& added,
                               Account& account) const {
    const Law law{content};
    const Kernel kernel{physics, law, dt};
    kernel(particles, at, seen, added, account);
  }
};

// The nodes' rates of temperature, from the sums with the tangent, or with the secant where temperatures change.
template <int Dim, class Real>
struct SolveRates {
  using Part = band::NodalHeat<Real>;
  using Sum = Part;
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  NodeViews<Dim, Real> nodes;
  const Real *tangent_rates, *secant_rates;
  const std::uint8_t* changing_blocks;  // null: none yet
  Real* orphan_heat;
  Real dt;

  THAWSLIDE_HD void visit(std::size_t node, Part& part) const {
    using mpm::HeatRates;
    constexpr std::size_t size = mpm::record_size(HeatRates::size<Dim>);
    constexpr std::size_t orphan_size = mpm::record_size(mpm::OrphanHeat::size<Dim>);
    const bool changes = changing_blocks != nullptr && changing_blocks[node / block_nodes] != 0;
    const Real* rates = (changes ? secant_rates : tangent_rates) + node * size;
    const Real* tangent = tangent_rates + node * size;
    band::solve_temperature_rate<Dim>(
        tangent, rates[HeatRates::capacity], rates[HeatRates::subgrid],
        nodes.contact_at(node)[mpm::Contact::friction_heat], static_cast<const Real*>(nodes.momentum_at(node)), dt,
        nodes.state_at(node)[mpm::NodalState::temperature_rate], orphan_heat[node * orphan_size], part,
        [](Real& /*rate*/, Real& /*power*/) { return false; });
  }
  THAWSLIDE_HD void add(const Part* parts, std::size_t count, Sum& sum) const {
    for (std::size_t k = 0; k < count; ++k) {
      sum += parts[k];
    }
  }
};

// Marks the tiles whose nodes, or whose particles, meet a condition. A group of threads a tile. Asks: of_node(number
// among those of all blocks), of_particle(particle).
template <class Asks, int Dim>
struct MarkTiles {
  using T = mpm::Tile<Dim>;
  TileTables<Dim> tables;
  Asks asks;
  std::uint8_t* marks;

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t tile) const {
    constexpr auto nodes = static_cast<std::size_t>(T::nodes), stencil = static_cast<std::size_t>(T::stencil);
    const std::size_t first = tables.first_of_cell[tile * nodes], last = tables.first_of_cell[(tile + 1) * nodes];
    group.each(1, [this, tile](std::size_t /*k*/) { marks[tile] = 0; });
    group.barrier();
    group.each(static_cast<std::size_t>(T::patch_nodes), [this, tile](std::size_t k) {
      const PlaceInBlock<Dim> place = place_in_block<Dim>(k);
      const std::int32_t block = tables.blocks_about_tile[tile * stencil + place.direction];
      if (asks.of_node(static_cast<std::size_t>(block) * nodes + place.node)) {
        marks[tile] = 1;  // all who write it write the same
      }
    });
    group.each(last - first, [this, tile, first](std::size_t k) {
      if (asks.of_particle(tables.order[first + k])) {
        marks[tile] = 1;
      }
    });
  }
};

// Where a temperature may change by more than is negligible.
template <int Dim, class Real, class Content>
struct MayChange {
  NodeViews<Dim, Real> nodes;
  mpm::ParticleView<Dim, Real> particles;
  Content content;
  Real dt;

  [[nodiscard]] THAWSLIDE_HD bool of_node(std::size_t node) const {
    return !content.is_negligible(Real(2) * (dt * nodes.state_at(node)[mpm::NodalState::temperature_rate]));
  }
  [[nodiscard]] THAWSLIDE_HD bool of_particle(std::uint32_t particle) const {
    return !content.is_negligible(Real(2) * particles.conduction_in_cell(particle));
  }
};

// Where nodes hold friction heat for particles.
template <int Dim, class Real>
struct HoldsHeat {
  const Real* orphan_heat;

  [[nodiscard]] THAWSLIDE_HD bool of_node(std::size_t node) const {
    return orphan_heat[node * mpm::record_size(mpm::OrphanHeat::size<Dim>)] != Real(0);
  }
  [[nodiscard]] THAWSLIDE_HD bool of_particle(std::uint32_t /*particle*/) const { return false; }
};

// Blocks whose nodes particles of marked tiles may see.
template <int Dim>
struct MarkBlocks {
  TileTables<Dim> tables;
  const std::uint8_t* tiles;
  std::uint8_t* blocks;

  THAWSLIDE_HD void operator()(std::size_t block) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    std::uint8_t any = 0;
    for (std::size_t d = 0; d < stencil; ++d) {
      const std::int32_t tile = tables.tiles_about_block[block * stencil + d];
      any = tile != absent && tiles[tile] != 0 ? 1 : any;
    }
    blocks[block] = any;
  }
};

// Of a pass over marked tiles.
struct MarkedTiles {
  const std::uint8_t* marks;

  THAWSLIDE_HD bool operator()(std::size_t tile) const { return marks[tile] != 0; }
  THAWSLIDE_HD bool operator()(std::size_t /*tile*/, std::size_t /*cell*/) const { return true; }
};

}  // namespace thawslide::device
