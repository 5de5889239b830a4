// Strain and stress of the particles of one material on a device (mpm/stress_kernel.hpp), which selects the law per
// pass.
#pragma once

#include <cstdint>

#include "mpm/stress_kernel.hpp"

namespace thawslide::device {

template <int Dim, class Law, class Width>
struct DeformMaterial {
  using Kernel = mpm::Deform<Dim, Law, Width>;
  using Reads = typename Kernel::Reads;
  using Adds = typename Kernel::Adds;
  using Totals = typename Kernel::Totals;

  // Parameters of mpm::Deform.
  Law law;
  mpm::MaterialParameters material;
  physics::Phases phases;
  bool effective_stress;
  double dt;
  Width width;
  std::int32_t number;  // of the material
  bool is_only_one;     // all particles have this material

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& seen, Scatter& added,
                               Totals& totals) const {
    if (is_only_one || particles.material(at.particle[0]) == number) {
      const Kernel deform{law, material, phases, effective_stress, dt, width};
      deform(particles, at, seen, added, totals);
    }
  }
};

}  // namespace thawslide::device
