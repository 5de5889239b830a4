// Sums of kernels over particles: energies, and invalid particles.
#pragma once

#include <cstdint>

#include "base/portability.hpp"

namespace thawslide::mpm {

// Energies of one step [J].
struct StressWork {
  double total = 0;    // of the constitutive stress on the strain
  double plastic = 0;  // dissipated in plastic strain
  double viscous = 0;  // dissipated by viscosity
  double pore = 0;     // of the pore pressure on the volume, if it acts inside the body

  THAWSLIDE_HD StressWork& operator+=(const StressWork& part) {
    total += part.total;
    plastic += part.plastic;
    viscous += part.viscous;
    pore += part.pore;
    return *this;
  }
};

// Reason why a particle is invalid. The underlying type has the width of the adjacent id, to avoid uninitialized
// padding in sums.
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

// Invalid particle with the smallest id; id < 0 if all are valid.
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

// Results of straining: energies, and the invalid particle of smallest id.
struct Deformed {
  StressWork work;
  InvalidParticle invalid;

  THAWSLIDE_HD Deformed& operator+=(const Deformed& part) {
    work += part.work;
    invalid += part.invalid;
    return *this;
  }
};

}  // namespace thawslide::mpm
