// Case with a body on a plane, on cells that follow the ground.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/portability.hpp"
#include "base_cases.hpp"
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
                                  const Sets& sets = {}) {
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
  const Sets on_plane{
      "time.end=20; time.step=; time.stepping=adaptive; terrain.type=plane",
      "terrain.elevation=0; material.rock.law=mohr_coulomb; material.rock.youngs_modulus=5e7",
      "material.rock.friction_angle=35; material.rock.cohesion=0; material.rock.viscosity_time=",
      "body.block.shape=polygon; body.block.min=; body.block.max=; body.block.temperature=-5; body.block.porosity=0.3",
      "basal.friction_angle=1.14576283817255",  // coefficient 0.02
      fmt::format("grid.cell={}; terrain.slope={}; body.block.vertices=[{}]", cell, plane.degrees, vertices),
      fmt::format("grid.min=[{},{}]", rounded(least[0] - margin), rounded(least[1] - fall - 40)),
      fmt::format("grid.max=[{},{}]", rounded(greatest[0] + margin), rounded(greatest[1] + fall + 80))};
  return base_case("block", on_plane + sets);
}

// Standard deviation of the mass along a direction [m].
inline double mass_spread(const sim::Simulation<2>& simulation, const Vector<double, 2>& direction = {1.0, 0.0}) {
  const auto& particles = simulation.particles();
  double mass = 0.0, first = 0.0, second = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double along = particles.position.get<Vector<double, 2>>(p).dot(direction);
    mass += particles.mass(p);
    first += particles.mass(p) * along;
    second += particles.mass(p) * along * along;
  }
  return std::sqrt(second / mass - first / mass * first / mass);
}

// Growth of the volume relative to that at t = 0.
inline double volume_growth(const sim::Simulation<2>& simulation) {
  const auto& particles = simulation.particles();
  double volume = 0.0, initial_volume = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    volume += particles.volume(p);
    initial_volume += particles.initial_volume(p);
  }
  return volume / initial_volume - 1.0;
}

// Block of 200 m x 40 m on a plane, with gravity normal to it.
struct Spread {
  double along, growth;  // standard deviation of the mass along the plane [m], relative growth of the volume
};
inline Spread spread_of_block(const Incline& plane, double cell, double viscosity_time = 0.004) {
  sim::Simulation<2> simulation(body_on_plane(
      plane, cell, {plane.place(-100, 0), plane.place(100, 0), plane.place(100, 40), plane.place(-100, 40)},
      {fmt::format("case.gravity_tilt={}", -plane.degrees),
       fmt::format("material.rock.viscosity_time={}", viscosity_time)}));
  run_until(simulation, 16.0);
  return {mass_spread(simulation, plane.down()), volume_growth(simulation)};
}

}  // namespace thawslide::testing_support
