// What kernels sum over particles: energies, and the particle that is in a bad state.
#pragma once

#include <cstdint>

#include "base/portability.hpp"

namespace thawslide::mpm {

// Energies of one step [J].
template <class Real>
struct StressWork {
  Real total = 0;    // of the constitutive stress on the strain
  Real plastic = 0;  // dissipated in plastic strain
  Real viscous = 0;  // dissipated by viscosity
  Real pore = 0;     // of the pore pressure on the volume, where it acts inside the body

  THAWSLIDE_HD StressWork& operator+=(const StressWork& part) {
    total += part.total;
    plastic += part.plastic;
    viscous += part.viscous;
    pore += part.pore;
    return *this;
  }
};

// What can be wrong with a particle.
// As wide as the id beside it below: sums have no gaps, which nothing writes, between their numbers.
enum class Fault : std::int64_t {
  none,
  volume_not_finite,
  volume_not_positive,
  volume_too_small,
  volume_too_large,
  state_not_finite,
  left_domain,
  left_map
};

// A particle found in a bad state, the one of smallest id; id < 0 if all are well.
struct InvalidParticle {
  std::int64_t id = -1;
  Fault fault = Fault::none;

  THAWSLIDE_HD void record(std::int64_t other, Fault found) {
    if (other >= 0 && (id < 0 || other < id)) {
      id = other;
      fault = found;
    }
  }
  THAWSLIDE_HD InvalidParticle& operator+=(const InvalidParticle& part) {
    record(part.id, part.fault);
    return *this;
  }
};

}  // namespace thawslide::mpm
