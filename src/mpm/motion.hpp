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

// mpm/motion_stages.hpp describes this stage and the next one. Returns the force of the walls along x [N], 0 if the
// section width is uniform.
template <int Dim>
double momentum_to_grid(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
                        Nodes<Dim>& nodes);

// Returns the kinetic energy gained by particles [J]. update_positions applies the displacement.
template <int Dim>
double move_particles(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model, double dt,
                      Nodes<Dim>& nodes);

// Filters the velocities with the order of the model (mpm/velocity_filter.hpp). Returns the kinetic energy gained by
// particles [J].
template <int Dim>
double filter_velocities(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
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
