// Particles at t = 0: where they are, what they are made of, what stress they carry.
#pragma once

#include "config/case.hpp"
#include "mpm/particles.hpp"
#include "sim/model.hpp"

namespace thawslide::sim {

// Fills the particles of all bodies: ids 0, 1, ... body by body, in lattice order. Throws UserError for a body without
// particles.
template <int Dim, class Real>
void fill_bodies(const config::Case& parameters, const config::Site& site, const Model<Dim, Real>& model,
                 mpm::Particles<Dim, Real>& particles);

}  // namespace thawslide::sim
