#include "sim/checks/bodies_apart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

namespace thawslide::sim {

namespace {

template <int Dim>
using CubeIndex = std::array<int, static_cast<std::size_t>(Dim)>;  // of a cube; touching particles: in it or next to it

constexpr double cube = 2.0;  // cells

// Particles touch if their boxes are less than half a spacing apart along each axis.
template <int Dim>
bool do_touch(const mpm::Particles<Dim>& particles, std::size_t p, std::size_t other, double half, double other_half) {
  const double reach = half + other_half + std::min(half, other_half);
  bool touches = true;
  for (int a = 0; a < Dim; ++a) {
    touches = touches && std::abs(particles.position(p, a) - particles.position(other, a)) <= reach;
  }
  return touches;
}

// Particles by body in each occupied cube.
template <int Dim>
using Cubes = std::map<CubeIndex<Dim>, std::map<std::size_t, std::vector<std::size_t>>>;

template <int Dim>
Cubes<Dim> cubes_of(const Simulation<Dim>& simulation) {
  const auto& particles = simulation.particles();
  Cubes<Dim> cubes;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    CubeIndex<Dim> point;
    for (std::size_t a = 0; a < Dim; ++a) {
      const double at = particles.position(p, static_cast<int>(a)) / (cube * simulation.parameters().grid.cell);
      point[a] = static_cast<int>(std::floor(at));
    }
    cubes[point][static_cast<std::size_t>(particles.body(p))].push_back(p);
  }
  return cubes;
}

// For each body, the lowest number in its group of bodies that touch directly or through others.
template <int Dim>
std::vector<std::size_t> groups_of_touching(const Simulation<Dim>& simulation) {
  const auto& particles = simulation.particles();
  const auto half = [&](std::size_t body) {
    return simulation.model().motion.sizes.half(body) * simulation.parameters().grid.cell;
  };
  std::vector<std::size_t> group(simulation.parameters().bodies.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto join_if_touching = [&](const auto& of_body, const auto& of_other) {
    const std::size_t one = group[of_body.first], two = group[of_other.first];
    const bool touch = one != two && std::any_of(of_body.second.begin(), of_body.second.end(), [&](std::size_t p) {
                         return std::any_of(of_other.second.begin(), of_other.second.end(), [&](std::size_t other) {
                           return do_touch(particles, p, other, half(of_body.first), half(of_other.first));
                         });
                       });
    if (touch) {
      std::replace(group.begin(), group.end(), std::max(one, two), std::min(one, two));
    }
  };
  const Cubes<Dim> cubes = cubes_of(simulation);
  for (const auto& [middle, bodies] : cubes) {
    for (int k = 0; k < mpm::Tile<Dim>::stencil; ++k) {
      CubeIndex<Dim> point = middle;
      for (std::size_t a = 0, rest = static_cast<std::size_t>(k); a < Dim; ++a, rest /= 3) {
        point[a] += static_cast<int>(rest % 3) - 1;
      }
      const auto found = cubes.find(point);
      for (auto of_body = bodies.begin(); found != cubes.end() && of_body != bodies.end(); ++of_body) {
        for (const auto& of_other : found->second) {
          join_if_touching(*of_body, of_other);
        }
      }
    }
  }
  return group;
}

}  // namespace

template <int Dim>
std::string warning_of_bodies_apart(const Simulation<Dim>& simulation) {
  const config::Case& parameters = simulation.parameters();
  if (!parameters.mechanics.enabled || parameters.bodies.size() < 2 ||
      config::was_given(parameters, "contact.between_bodies")) {
    return "";
  }
  const std::vector<std::size_t> group = groups_of_touching(simulation);
  const auto& layers = simulation.model().between_bodies.layer_of_body;
  for (std::size_t body = 1; body < group.size(); ++body) {
    for (std::size_t other = 0; other < body; ++other) {
      if (group[body] != group[other] && (layers.empty() || layers[body] == layers[other])) {
        const auto& names = simulation.model().body_names;
        return fmt::format(
            "{}: body.{} stands apart from body.{}, and contact.between_bodies is \"bonded\": below a gap of 1 to 2 "
            "cells ({:g} to {:g} m) they interact, stick together, and drag one another as they separate. Set "
            "contact.between_bodies = \"frictional\" and contact.friction_angle, or write contact.between_bodies = "
            "\"bonded\" if they are meant to be one body.",
            config::location_of(parameters, "body." + names[body]), names[body], names[other], parameters.grid.cell,
            2.0 * parameters.grid.cell);
      }
    }
  }
  return "";
}

template std::string warning_of_bodies_apart<2>(const Simulation<2>&);
template std::string warning_of_bodies_apart<3>(const Simulation<3>&);

}  // namespace thawslide::sim
