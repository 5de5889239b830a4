#include "sim/bodies_apart.hpp"

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
using Place = std::array<int, static_cast<std::size_t>(Dim)>;  // of a cube that holds all that may touch in those about

constexpr double cube = 2.0;  // cells

// Particles touch whose boxes are less than half a spacing apart along each axis.
template <int Dim>
bool do_touch(const mpm::Particles<Dim, double>& particles, std::size_t p, std::size_t other, double half,
              double other_half) {
  const double reach = half + other_half + std::min(half, other_half);
  bool touches = true;
  for (int a = 0; a < Dim; ++a) {
    touches = touches && std::abs(particles.position(p, a) - particles.position(other, a)) <= reach;
  }
  return touches;
}

// By body, the lowest number of those that it touches, one by way of others too.
template <int Dim>
std::vector<std::int32_t> groups_of_touching(const Simulation<Dim, double>& simulation) {
  const auto& particles = simulation.particles();
  const double cell = simulation.parameters().grid.cell;
  const auto body = [&](std::size_t p) { return static_cast<std::size_t>(particles.body(p)); };
  const auto half = [&](std::size_t p) { return simulation.model().motion.sizes.half(body(p)) * cell; };
  std::vector<std::int32_t> group(simulation.parameters().bodies.size());
  std::iota(group.begin(), group.end(), 0);
  std::map<Place<Dim>, std::vector<std::size_t>> seen;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    Place<Dim> middle;
    for (std::size_t a = 0; a < Dim; ++a) {
      middle[a] = static_cast<int>(std::floor(particles.position(p, static_cast<int>(a)) / (cube * cell)));
    }
    for (int k = 0; k < mpm::Tile<Dim>::stencil; ++k) {
      Place<Dim> place = middle;
      for (std::size_t a = 0, rest = static_cast<std::size_t>(k); a < Dim; ++a, rest /= 3) {
        place[a] += static_cast<int>(rest % 3) - 1;
      }
      const auto found = seen.find(place);
      for (std::size_t n = 0; found != seen.end() && n < found->second.size(); ++n) {
        const std::size_t other = found->second[n];
        const std::int32_t one = group[body(p)], two = group[body(other)];
        if (one != two && do_touch(particles, p, other, half(p), half(other))) {
          std::replace(group.begin(), group.end(), std::max(one, two), std::min(one, two));
        }
      }
    }
    seen[middle].push_back(p);
  }
  return group;
}

}  // namespace

template <int Dim>
std::string doubt_of_bodies_apart(const Simulation<Dim, double>& simulation) {
  const config::Case& parameters = simulation.parameters();
  if (!parameters.mechanics.enabled || parameters.bodies.size() < 2 ||
      config::was_given(parameters, "contact.between_bodies")) {
    return "";
  }
  const std::vector<std::int32_t> group = groups_of_touching(simulation);
  const auto& layers = simulation.model().between_bodies.layer_of_body;
  for (std::size_t body = 1; body < group.size(); ++body) {
    for (std::size_t other = 0; other < body; ++other) {
      if (group[body] != group[other] && (layers.empty() || layers[body] == layers[other])) {
        const auto& names = simulation.model().body_names;
        return fmt::format(
            "{}: body.{} stands apart from body.{}, and contact.between_bodies is \"bonded\": from a gap of 1 "
            "to 2 cells ({:g} to {:g} m) on they act on one another, stick, and drag one another as they part. Set "
            "contact.between_bodies = \"frictional\" and contact.friction_angle, or write contact.between_bodies = "
            "\"bonded\" if they are to be one.",
            config::place_of(parameters, "body." + names[body]), names[body], names[other], parameters.grid.cell,
            2.0 * parameters.grid.cell);
      }
    }
  }
  return "";
}

template std::string doubt_of_bodies_apart<2>(const Simulation<2, double>&);
template std::string doubt_of_bodies_apart<3>(const Simulation<3, double>&);

}  // namespace thawslide::sim
