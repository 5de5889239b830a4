// Direction in which a slide leaves: along the x axis in 2D, along a given line in 3D. Front, runout and discharge are
// measured in this direction. No result therefore depends on the end at which a profile, a path or a cross section
// begins.
//    M = sum m v.e                                                  momentum at t = 0 along a horizontal direction e
//    F = sum m (g.e - |g_z| dz/de) / sqrt(1 + (dz/de)^2)            gravity along the ground below the bodies
// The direction is the sign of M, or that of F if nothing moves along e. If M opposes F, bodies of mass m and length L
// along e soon reverse, and the direction is that of F, unless they would travel farther than L/2 without friction:
//    (M/m)^2/2 > |F|/m L/2
#pragma once

#include <string>

#include "config/site.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Bodies at t = 0, by number. cell: of the grid [m], over which slopes are averaged. In 3D, and without a direction,
// bodies leave towards +x.
template <int Dim>
[[nodiscard]] std::vector<BodyAtStart> bodies_at_start(const Model<Dim>& model, const mpm::Particles<Dim>& particles,
                                                       double cell);

// Direction of bodies together, 1 or -1: that of the greater mass.
[[nodiscard]] double direction_of(const std::vector<BodyAtStart>& bodies, const MovedMass& moved);

// Front of the mass that has moved, along the x axis.
struct FrontAlongX {
  double direction;  // of the slide, 1 or -1: away from the rear
  double position;   // x coordinate that has 99.5 % of the mass behind it [m]
  double rear;       // x coordinate of the rear end of the same bodies at t = 0 [m]
};
// The direction of a slide that moved uphill and returned past its rear at t = 0 is reversed there.
template <int Dim>
[[nodiscard]] FrontAlongX front_along_x(const Simulation<Dim>& simulation);

// Reverses the site's path if its bodies leave against it. If there is no direction, the end nearer to the bodies
// becomes the first one; without a body, the higher end. Then reverses each probe line that the path crosses from right
// to left. A line that the path does not cross is reversed if the bodies lie to its right. Discharge to the right of
// the line is positive. Returns a note for the user; empty if there is none.
[[nodiscard]] std::string orient_lines(const config::Case& parameters, config::Site& site);

// Warning if the path misses all bodies; empty otherwise.
[[nodiscard]] std::string warning_of_path(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
