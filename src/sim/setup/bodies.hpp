// Initial particles: position, material and stress at t = 0.
#pragma once

#include "config/case.hpp"
#include "mpm/particles.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

// Fills in the particles of all bodies. Ids 0, 1, ... are assigned body by body, in lattice order. Throws UserError for
// a body without particles.
template <int Dim>
void fill_bodies(const config::Case& parameters, const config::Site& site, const Model<Dim>& model,
                 mpm::Particles<Dim>& particles);

}  // namespace thawslide::sim
