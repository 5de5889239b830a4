// Momentum on the grid and motion of particles (Eqs. 6, 10-14): the stages without terrain and heat.
#pragma once

#include "mpm/body_sizes.hpp"
#include "mpm/constraints.hpp"
#include "mpm/kernel_totals.hpp"
#include "mpm/nodes.hpp"
#include "mpm/parameters.hpp"
#include "mpm/particles.hpp"
#include "mpm/section_width.hpp"

namespace thawslide::mpm {

template <int Dim>
struct MotionModel : MotionParameters<Dim> {
  SectionWidth width;  // of a 2D section
  BodySizes sizes;     // of particles, in cells
};

// Converts total to effective stress, sigma + P I, of particles at memory index `first` and above.
template <int Dim>
void split_total_stress(Particles<Dim>& particles, std::size_t first = 0);

// Transfers particle mass, momentum, force (Eq. 12) and volume to the nodes. Returns the force of the walls along x [N]
// if the section width varies.
template <int Dim>
double momentum_to_grid(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
                        Nodes<Dim>& nodes);

// Computes new velocities (Eq. 13, or another transfer) and displacements (Eq. 14, with its missing summation sign)
// from nodal motion; then adds the particles' momentum to the patches of nodes.velocity (MUSL), without summing these.
// update_positions applies the displacement. Returns the kinetic energy gained by particles minus sum p_i.dv_i over the
// nodes [J]; sum m |dv_p|^2/2 in FLIP. Subtracting sum m_i |dv_i|^2/2 gives the energy created by the transfers.
template <int Dim>
double move_particles(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model, double dt,
                      Nodes<Dim>& nodes);

// Updates strain, rotation, stress (Eq. 11), volume and porosity (Eq. 6, mechanical part) from the mapped-back
// velocities.
template <int Dim>
Deformed update_stress_and_porosity(const SparseGrid<Dim>& grid, Particles<Dim>& particles,
                                    const MotionModel<Dim>& model, double dt, Nodes<Dim>& nodes);

// Applies the displacement of the step; returns a particle that is not finite or outside [lower, upper].
template <int Dim>
[[nodiscard]] InvalidParticle update_positions(Particles<Dim>& particles, const Vector<double, Dim>& lower,
                                               const Vector<double, Dim>& upper);

}  // namespace thawslide::mpm
