// Strain and stress of the particles of one material, with all kernel parameters held by value.
#pragma once

#include <cstdint>

#include "mpm/stress_kernel.hpp"

namespace thawslide::device {

template <int Dim, class Law>
struct DeformMaterial {
  using Kernel = mpm::Deform<Dim, Law>;
  using Reads = typename Kernel::Reads;
  using Adds = typename Kernel::Adds;
  using Account = typename Kernel::Account;

  // Parameters of mpm::Deform.
  Law law;
  physics::Elastic elastic;
  physics::Phases phases;
  bool gaps_close_first;
  Real viscosity_time;
  bool effective_stress;
  Real dt;
  std::int32_t material;
  bool is_only_one;  // all particles have this material

  // Kernel for material m of a step model.
  template <class Model>
  static DeformMaterial of(const Law& law, const Model& model, std::size_t m, Real dt) {
    const auto& material = model.materials[m];
    return {law,
            material.elastic,
            model.phases,
            material.gaps_close_first,
            material.viscosity_time,
            model.effective_stress,
            dt,
            static_cast<std::int32_t>(m),
            model.materials.size() == 1};
  }

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& seen, Scatter& added,
                               Account& account) const {
    if (is_only_one || particles.material(at.particle[0]) == material) {
      const Kernel deform{law, elastic, phases, gaps_close_first, viscosity_time, effective_stress, dt};
      deform(particles, at, seen, added, account);
    }
  }
};

}  // namespace thawslide::device
