// Device kernels of pore pressure other than those of band/pressure_kernels.hpp and band/averages_kernel.hpp, by the
// functions of band/nodal_seepage.hpp.
#pragma once

#include "band/averages_kernel.hpp"
#include "band/nodal_seepage.hpp"
#include "band/pressure_kernels.hpp"
#include "device/node_kernels.hpp"

namespace thawslide::device {

// Tile conditions (device/marks.hpp): water seeps to or from particles in their current state, or did before heat
// changed them.
template <int Dim>
struct SeepingInState {
  mpm::ParticleView<Dim> particles;
  band::BandPhysics physics;
  band::HydraulicConductivity hydraulic;

  [[nodiscard]] THAWSLIDE_HD bool of_node(std::size_t /*node*/) const { return false; }
  [[nodiscard]] THAWSLIDE_HD bool of_particle(std::uint32_t particle) const {
    return band::seeps(physics, hydraulic, particles, mpm::ScalarIndex{{particle}});
  }
};
template <int Dim>
struct SeepingBefore : SeepingInState<Dim> {
  [[nodiscard]] THAWSLIDE_HD bool of_particle(std::uint32_t particle) const {
    return band::any_seeped(this->physics, this->hydraulic, this->particles, mpm::ScalarIndex{{particle}});
  }
};

// Sets the pore pressure at nodes of marked blocks to that of the seeping water.
template <int Dim>
struct SetSeepingPressure {
  NodeViews<Dim> nodes;
  const double* seeping_water;
  const std::uint8_t* blocks;

  THAWSLIDE_HD void operator()(std::size_t node) const {
    if (blocks[node / static_cast<std::size_t>(mpm::Tile<Dim>::nodes)] != 0) {
      nodes.state_at(node)[mpm::NodalState::pore_pressure] =
          band::seeping_pressure(seeping_water + node * mpm::record_size(mpm::components_of<mpm::SeepingWater, Dim>));
    }
  }
};

// Nodal pressure change by seepage; sums the water absorbed by frozen pores. If no particle in reach of a node seeps,
// the sums contain only pore space, and the change is zero.
template <int Dim>
struct SolveSeepage {
  using Part = double;
  using Sum = double;

  NodeViews<Dim> nodes;
  const double* seepage;
  double dt;

  THAWSLIDE_HD void visit(std::size_t node, double& absorbed) const {
    const double* sums = seepage + node * mpm::record_size(mpm::components_of<mpm::Seepage, Dim>);
    const double change = band::pressure_change(sums, dt);
    nodes.state_at(node)[mpm::NodalState::pressure_change] = change;
    absorbed = band::absorbed_by_frozen(sums, change);
  }
  THAWSLIDE_HD void add(const double* parts, std::size_t count, double& sum) const {
    for (std::size_t k = 0; k < count; ++k) {
      sum += parts[k];
    }
  }
};
struct KeepVented {
  const double* absorbed;
  physics::Phases phases;
  double* vented;

  THAWSLIDE_HD void operator()(std::size_t /*k*/) const { *vented = band::mass_of_absorbed(phases, *absorbed); }
};

// Normal load of a particle, from columns that hold the load per depth in place of the cosine.
template <class Columns>
struct AddPressureLoad {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  struct InTile {
    typename Columns::OfTile columns;

    template <class Particles, class At, class Seen, class Scatter>
    THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                                 Totals& /*totals*/) const {
      band::update_load(particles, at.particle[0], columns.flow_depth(particles, at));
    }
  };

  Columns columns;  // by tile

  [[nodiscard]] THAWSLIDE_HD InTile in_tile(std::size_t tile) const { return InTile{columns.of_tile(tile)}; }
};

}  // namespace thawslide::device
