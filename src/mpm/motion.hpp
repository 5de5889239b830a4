// Momentum on the grid and the motion of particles (Eqs. 6, 10-14): the stages that need no terrain and no heat.
#pragma once

#include <algorithm>
#include <vector>

#include "mpm/accounts.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/constraints.hpp"
#include "mpm/material.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"
#include "mpm/section_width.hpp"
#include "physics/mixture.hpp"

namespace thawslide::mpm {

// How particles take their velocity from the nodes: by their changes (FLIP, Eq. 13) with a share of their velocities
// (PIC), or their velocities with the affine velocity about the particle (APIC; Jiang et al. 2015).
enum class TransferKind { flip_pic, apic };

template <int Dim, class Real>
struct MotionModel {
  [[nodiscard]] bool viscous() const {
    return std::any_of(materials.begin(), materials.end(),
                       [](const MaterialModel<Real>& material) { return material.viscosity_time > Real(0); });
  }

  ShapeKind shape = ShapeKind::ugimp;
  HeldSides<Dim> sides;
  TransferKind transfer = TransferKind::flip_pic;
  Real pic_share = 0;         // of TransferKind::flip_pic; 0: FLIP
  int filter_order = 0;       // of the filter of velocities (mpm/velocity_filter.hpp); 0: none
  SectionWidth<Real> width;   // of a 2D section
  Vector<Real, Dim> gravity;  // [m/s2]
  Real mass_damping = 0;      // [1/s]
  BodySizes<Real> sizes;      // of particles, in cells
  std::vector<MaterialModel<Real>> materials;
  physics::Phases<Real> phases;
  bool effective_stress = false;  // stress is effective: the pore pressure acts inside the body too
  bool lubrication = true;        // off: Eq. 25 sees the initial porosity and saturation (Sec. 3.3)
};

// What moving the particles cost.
template <class Real>
struct MoveWork {
  // Kinetic energy that particles gained, less sum p_i.dv_i over the nodes [J]: sum m |dv_p|^2/2 in FLIP. Less
  // sum m_i |dv_i|^2/2 it is what the transfers between particles and nodes made.
  Real particle_kinetic = 0;
};

// From total stress to effective stress, sigma + P I, of the particles that stand in memory from `first` on.
template <int Dim, class Real>
void split_total_stress(Particles<Dim, Real>& particles, std::size_t first = 0);

// Particle mass, momentum, force (Eq. 12) and volume to the nodes. Returns the force of the walls along x [N], where
// the width of the section varies.
template <int Dim, class Real>
Real momentum_to_grid(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                      const MotionModel<Dim, Real>& model, Nodes<Dim, Real>& nodes);

// New velocities (Eq. 13, or another transfer) and displacements (Eq. 14, with the sum sign it lost) from node motion;
// then the moved particles' momentum to the patches of nodes.velocity (MUSL), not yet summed. The displacement takes
// effect in update_positions.
template <int Dim, class Real>
MoveWork<Real> move_particles(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                              const MotionModel<Dim, Real>& model, Real dt, Nodes<Dim, Real>& nodes);

// Strain, rotation, stress (Eq. 11), volume and porosity (Eq. 6, mechanical part) from the mapped-back velocities.
template <int Dim, class Real>
StressWork<Real> update_stress_and_porosity(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                                            const MotionModel<Dim, Real>& model, Real dt, Nodes<Dim, Real>& nodes,
                                            InvalidParticle& invalid);

// Lets the step's displacement take effect; reports a particle that is not finite or outside [lower, upper].
template <int Dim, class Real>
void update_positions(Particles<Dim, Real>& particles, const Vector<Real, Dim>& lower, const Vector<Real, Dim>& upper,
                      InvalidParticle& invalid);

}  // namespace thawslide::mpm
