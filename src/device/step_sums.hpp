// Sums over particles and nodes of one step, for the budget, the monitor and the next step.
#pragma once

#include <cstdint>

#include "band/nodal_heat.hpp"
#include "band/pressure_kernels.hpp"
#include "band/step_extremes.hpp"
#include "mpm/between_bodies.hpp"
#include "mpm/kernel_totals.hpp"
#include "terrain/contact_node.hpp"

namespace thawslide::device {

// Energies [J].
template <int Dim>
struct StepSums {
  terrain::ContactWork<Dim> contact;
  double particle_kinetic = 0;  // as mpm::move_particles returns
  double filtered = 0;          // kinetic energy added by the velocity filter
  double mapped_back = 0;       // work of internal forces at mid-step velocities minus that at mapped-back velocities
  mpm::Deformed deformed;
  double band_rescale = 0;  // heat added by changes of scaling
  band::HeatGain heat;
  band::WaterLoss water;
  mpm::InvalidParticle invalid;  // after particles have moved
  band::StepExtremes extremes;
  mpm::BodyContactWork between_bodies;  // of bodies that do not share nodes
  std::uint64_t escapes = 0;            // particles outside the domain, or in a block with partly unknown ground
};

}  // namespace thawslide::device
