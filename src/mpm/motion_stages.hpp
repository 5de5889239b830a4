// Stages of momentum and motion as sequences of passes, written once for the CPU (mpm/step_passes.hpp) and for devices
// (device/step_passes.hpp). Totals are written to memory of the executor.
#pragma once

#include <variant>
#include <vector>

#include "mpm/motion_kernels.hpp"
#include "mpm/parameters.hpp"
#include "mpm/section_width.hpp"
#include "mpm/stress_kernel.hpp"

namespace thawslide::mpm::stages {

// Transfers particle mass, momentum, force (Eq. 12) and volume to the nodes. of_walls: force of the walls along x [N],
// written if the width of the section varies.
template <int Dim, class Passes>
void momentum_to_grid(Passes& passes, const MotionParameters<Dim>& motion, const WidthView& width, double* of_walls) {
  with_width<Dim>(width, [&]<class Width>(const Width& of_section) {
    const AddMomentum<Dim, Width> add{motion.gravity, motion.effective_stress, motion.viscous(), of_section};
    if constexpr (Width::varies) {
      passes.total(passes.momentum(), add, of_walls);
    } else {
      passes.run(passes.momentum(), add);
    }
  });
  if (motion.is_affine()) {
    passes.run(passes.affine(), AddAffineMomentum<Dim>{});
  }
  passes.template sum_all<Momentum>();
}

// Computes new velocities (Eq. 13, or another transfer) and displacements (Eq. 14, with its missing summation sign)
// from nodal motion; then adds the particles' momentum to the patches of Velocity (MUSL), without summing these.
// gained: kinetic energy gained by particles minus sum p_i.dv_i over the nodes [J]; sum m |dv_p|^2/2 in FLIP.
// Subtracting sum m_i |dv_i|^2/2 gives the energy created by the transfers.
template <int Dim, class Passes>
void move_particles(Passes& passes, const MotionParameters<Dim>& motion, double dt, double* gained) {
  passes.total(passes.momentum(), Move<Dim>{motion.is_affine() ? 1.0 : motion.pic_fraction, dt}, gained);
  if (motion.is_affine()) {
    passes.add_total(passes.affine(), MoveAffine<Dim>{dt}, gained);
  }
}

// Updates strain, rotation, stress (Eq. 11), volume and porosity (Eq. 6, mechanical part) from the mapped-back
// velocities. The constitutive law is selected outside the kernels. deformed: to which the work is added.
template <int Dim, class Passes>
void update_stress_and_porosity(Passes& passes, const MotionParameters<Dim>& motion, const WidthView& width, double dt,
                                Deformed* deformed) {
  with_width<Dim>(width, [&]<class Width>(const Width& of_section) {
    // persistent, to avoid allocation in each step
    thread_local std::vector<typename DeformByLaw<Dim, Width>::Type> by_material;
    by_material.clear();
    for (const MaterialModel& material : motion.materials) {
      std::visit(
          [&]<class Law>(const Law& law) {
            by_material.push_back(
                Deform<Dim, Law, Width>{law, material, motion.phases, motion.effective_stress, dt, of_section});
          },
          material.law);
    }
    passes.add_total_by_material(passes.momentum(), by_material, deformed);
  });
}

}  // namespace thawslide::mpm::stages
