// Case with a body on a plane, on cells that follow the ground.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/portability.hpp"
#include "case_from_text.hpp"
#include "sim/simulation.hpp"

namespace thawslide::testing_support {

// Inclined plane through the origin that falls towards +x.
struct Incline {
  double degrees;

  [[nodiscard]] double angle() const { return degrees * pi / 180.0; }
  // Place at a distance down the slope and above the plane.
  [[nodiscard]] Vector<double, 2> place(double along, double above) const {
    return {along * std::cos(angle()) + above * std::sin(angle()),
            above * std::cos(angle()) - along * std::sin(angle())};
  }
  [[nodiscard]] Vector<double, 2> down() const { return place(1.0, 0.0); }
};

// A polygon `body` of grains with an internal friction of 35 degrees. sets: other keys.
inline config::Case body_on_plane(const Incline& plane, double cell, const std::vector<Vector<double, 2>>& body,
                                  std::vector<std::string> sets = {}) {
  constexpr double margin = 600.0;
  std::string vertices;
  Vector<double, 2> least = body[0], greatest = body[0];
  for (const auto& vertex : body) {
    vertices += fmt::format("{}[{},{}]", vertices.empty() ? "" : ",", vertex[0], vertex[1]);
    least = least.cwiseMin(vertex);
    greatest = greatest.cwiseMax(vertex);
  }
  const double fall = std::tan(plane.angle()) * margin;
  const auto rounded = [&](double number) { return cell * std::round(number / cell); };
  sets.insert(sets.begin(),
              {fmt::format("grid.cell={}", cell), fmt::format("terrain.slope={}", plane.degrees),
               fmt::format("grid.min=[{},{}]", rounded(least[0] - margin), rounded(least[1] - fall - 40)),
               fmt::format("grid.max=[{},{}]", rounded(greatest[0] + margin), rounded(greatest[1] + fall + 80)),
               "body.slide.vertices=[" + vertices + "]"});
  return case_from_text(R"(
[case]
dimension = 2
[time]
end = 20.0
stepping = "adaptive"
[grid]
follows_terrain = true
[terrain]
type = "plane"
elevation = 0.0
[body.slide]
material = "grains"
shape = "polygon"
temperature = -5.0
porosity = 0.3
[material.grains]
law = "mohr_coulomb"
youngs_modulus = 5.0e7
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 0.0
[basal]
friction = "constant"
friction_angle = 1.14576283817255  # coefficient 0.02
[heat]
enabled = false
[pressure]
enabled = false
)",
                        sets);
}

// Standard deviation of the mass along the plane [m], and the volume relative to that at t = 0.
struct Spread {
  double along, growth;

  Spread(const sim::Simulation<2>& simulation, const Incline& plane) {
    const auto& particles = simulation.particles();
    double mass = 0.0, first = 0.0, second = 0.0, volume = 0.0, initial_volume = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double along_plane = particles.position.get<Vector<double, 2>>(p).dot(plane.down());
      mass += particles.mass(p);
      first += particles.mass(p) * along_plane;
      second += particles.mass(p) * along_plane * along_plane;
      volume += particles.volume(p);
      initial_volume += particles.initial_volume(p);
    }
    along = std::sqrt(second / mass - first / mass * first / mass);
    growth = volume / initial_volume - 1.0;
  }
};

}  // namespace thawslide::testing_support
