// Conditions by which stages mark tiles (mpm/step_passes.hpp): of one or several particles, and of the record `Reads`
// of a node, unless that is void. For host and device.
#pragma once

#include "band/averages_kernel.hpp"
#include "band/pressure_kernels.hpp"

namespace thawslide::band {

// A temperature may change by more than is negligible.
template <class Content>
struct MayChange {
  using Reads = mpm::NodalState;

  Content content;
  double dt;

  template <class Record>
  [[nodiscard]] THAWSLIDE_HD bool of_node(const Record& state) const {
    return !content.is_negligible(2.0 * (dt * state[mpm::NodalState::temperature_rate]));
  }
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD bool of_particles(const Particles& particles, const At& at) const {
    return any(!content.is_negligible(2.0 * particles.conduction_in_cell.load(at)));
  }
};

// A node has friction heat to be passed on to particles.
struct HasHeat {
  using Reads = mpm::UnreachedHeat;

  template <class Record>
  [[nodiscard]] THAWSLIDE_HD bool of_node(const Record& unreached) const {
    return unreached[0] != 0.0;
  }
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD bool of_particles(const Particles& /*particles*/, const At& /*at*/) const {
    return false;
  }
};

// Water seeps to or from particles in their current state, or did before heat changed them.
struct SeepingInState {
  using Reads = void;

  BandPhysics model;
  HydraulicConductivity hydraulic;

  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD bool of_particles(const Particles& particles, const At& at) const {
    return any(seeps(model, hydraulic, particles, at));
  }
};
struct SeepingBefore : SeepingInState {
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD bool of_particles(const Particles& particles, const At& at) const {
    const auto melted = melted_before(model, particles, at);
    return any(melted) && any(melted & (hydraulic(particles, at) > 0.0));
  }
};

}  // namespace thawslide::band
