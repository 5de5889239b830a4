// Straight channel on a slope, as a DEM, with a fill that slides down it.
#pragma once

#include <cmath>

#include "base/portability.hpp"
#include "slide_on_dem.hpp"

namespace thawslide::testing_support {

// Cross-section of a channel: height of the ground above the thalweg at a distance across it [m].
using Section = std::function<double(double across)>;

struct Channel {
  Section ground;
  double surface = 0.0;       // of the fill above the thalweg [m]
  double half_width = 120.0;  // maximum, of the fill [m]
  double azimuth = 0.0;       // of the thalweg, from +x towards +y [degrees]
  double aside = 0.0;         // offset of the thalweg from the domain's centre, which is on grid lines [m]
  double spacing = 1.25;      // of the DEM's points [m]
};

// Plane instead of a channel, with a fill of a width and a thickness [m] across it.
inline Channel plane_channel(double width, double thickness) {
  return {.ground = [](double) { return 0.0; }, .surface = thickness, .half_width = 0.5 * width};
}

// V-shaped channel with half its opening angle [degrees], filled to a width [m].
inline Channel v_channel(double half_opening, double width) {
  const double rise = 1.0 / std::tan(half_opening * pi / 180.0);
  return {.ground = [rise](double across) { return rise * std::abs(across); }, .surface = 0.5 * width * rise};
}

// Semicircle of a width [m], filled to the brim; its steep parts are replaced by planes.
inline Channel u_channel(double width) {
  const double radius = 0.5 * width, steep = 0.98 * radius;
  const double rise = steep / std::sqrt(radius * radius - steep * steep);
  return {.ground =
              [=](double across) {
                const double s = std::abs(across), on_circle = std::min(s, steep);
                return radius - std::sqrt(radius * radius - on_circle * on_circle) + (s - on_circle) * rise;
              },
          .surface = radius};
}

// Cells of 5 m; slope of the thalweg 35 degrees; friction angle of the ground 15 degrees.
inline constexpr double channel_cell = 5.0, channel_slope = 35.0, channel_friction = 15.0;

// Modifies the ground before the simulation uses it.
using Treatment = std::function<Raster(Raster)>;

// Additional friction of the fill relative to the coefficient of the ground, on average between two times [s], from the
// velocity of its centre of mass along the thalweg.
inline double friction_in_channel(
    const Channel& channel, const Sets& material, double from, double to,
    const Treatment& treat = [](Raster ground) { return ground; }) {
  constexpr double degree = pi / 180.0, gravity = 9.81, length = 60.0;
  const double sine = std::sin(channel_slope * degree), cosine = std::cos(channel_slope * degree);
  const Place along(std::cos(channel.azimuth * degree), std::sin(channel.azimuth * degree)), aside(-along[1], along[0]);
  const auto across = [&](double x, double y) { return Place(x, y).dot(aside) - channel.aside; };
  const auto downstream = [&](double x, double y) { return Place(x, y).dot(along); };
  const auto on_slope = [&](double x, double y, double above) { return (above - downstream(x, y) * sine) / cosine; };
  const Raster ground =
      raster_between(Place(-130.0, -130.0), Place(130.0, 130.0), channel.spacing,
                     [&](double x, double y) { return on_slope(x, y, channel.ground(across(x, y))); });
  // The ends of the fill are vertical; its length in the map is `length`.
  const Place half(120.0, 120.0);
  const Raster thickness = thickness_between(-half, half, 0.625, [&](double x, double y) {
    const double depth = (channel.surface - channel.ground(across(x, y))) / cosine;
    const bool is_in = std::abs(downstream(x, y) + 40.0) < 0.5 * length && std::abs(across(x, y)) < channel.half_width;
    return is_in ? std::max(0.0, depth) : 0.0;
  });
  const Variant slide = release_on_dem({to, 0.002, channel_cell, {-120.0, -120.0, -150.0}, {120.0, 120.0, 250.0}},
                                       material, channel_friction);
  sim::Simulation<3> simulation(case_on_dem(slide, "time.stepping=adaptive; grid.steepest=70"),
                                site_of(treat(ground), thickness));
  const Position down(along[0] * cosine, along[1] * cosine, -sine);
  run_until(simulation, from);
  const double first = CentreOfMass(simulation).velocity.dot(down), began = simulation.time();
  run_until(simulation, to);
  const double gained = CentreOfMass(simulation).velocity.dot(down) - first;
  const double found = (gravity * sine - gained / (simulation.time() - began)) / (gravity * cosine);
  return found / std::tan(channel_friction * degree);
}

// Broken rock without cohesion.
inline const Sets loose_rock =
    "material.debris.youngs_modulus=1e8; material.debris.poisson_ratio=0.2; material.debris.friction_angle=35; "
    "material.debris.viscosity_time=0.01; mechanics.slope_shear=true";

}  // namespace thawslide::testing_support
