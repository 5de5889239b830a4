// The direction in which a slide leaves: along the x axis in 2D, along a given line in 3D. Front, runout and discharge
// are measured in it, so that no result depends on the end at which a profile, a path or a cross section was begun.
//   M = sum m v.e                                                  momentum at t = 0 along a horizontal direction e
//   F = sum m (g.e - |g_z| dz/de) / sqrt(1 + (dz/de)^2)            gravity along the ground below the bodies
// It is the sign of M, or, where nothing moves along e, that of F. Where M is against F, bodies of the mass m and the
// length L along e soon turn back, and it is that of F, unless they would come farther than L/2 without any friction:
//   (M/m)^2/2 > |F|/m L/2
#pragma once

#include <string>

#include "config/site.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// 1 or -1: towards +x or -x, of bodies at t = 0; 1 in 3D, and where they leave neither way. cell: of the grid [m], over
// which slopes are averaged.
template <int Dim, class Real>
[[nodiscard]] double direction_at_start(const Model<Dim, Real>& model, const mpm::Particles<Dim, Real>& particles,
                                        double cell);

// The same of a slide on its way: it lies ahead of the rear end that it left (Simulation::rear_at_start). One that was
// thrown uphill and returned past that end changes direction there.
template <int Dim, class Real>
[[nodiscard]] double direction_along_x(const Simulation<Dim, Real>& simulation);

// In 2D: x up to which 99.5 % of the mass has come, in that direction [m].
template <int Dim, class Real>
[[nodiscard]] double front_along_x(const Simulation<Dim, Real>& simulation, double direction);

// Reverses the site's path if its bodies leave against it. If they leave neither way, its first end becomes the nearer
// one; without a body, the higher one. Then reverses each line of a probe that the path crosses from right to left, or,
// if it crosses none, to whose right the bodies lie: a discharge to the right of the line is positive. Returns what the
// user should know; empty: nothing.
[[nodiscard]] std::string orient_lines(const config::Case& parameters, config::Site& site);

// Of a path that passes all bodies by; empty: it does not.
[[nodiscard]] std::string warning_of_path(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
