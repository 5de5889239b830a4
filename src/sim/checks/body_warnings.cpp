#include "sim/checks/body_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "base/linear.hpp"
#include "base/rounding.hpp"
#include "config/grounds.hpp"
#include "config/notices.hpp"
#include "config/resolution.hpp"
#include "physics/softening.hpp"

namespace thawslide::sim {

namespace {

constexpr double most_strain = 0.05;      // under its own weight, at the base of the thickest column
constexpr double most_volume_off = 0.02;  // relative deviation of particle volume from the shape's volume
constexpr double least_resting = 0.5;     // fraction of a body's area
constexpr double touching = 0.5;  // spacings: tolerance, because particles lie on a lattice and the ground may not
constexpr int digits_of_places = 6;
constexpr double strain_of_unbroken = 1.0;  // softening strain from which on a material slides unbroken

// Particles lie on a lattice, so their volume may differ from that of the shape.
std::string volume_warning(const config::Case& parameters, const BodyFigures& body) {
  const double more = body.volume / body.shape_volume - 1.0;
  if (std::abs(more) <= most_volume_off) {
    return "";
  }
  const std::string key = "body." + body.name;
  return fmt::format(
      "{}: {} has {} {}; its particles, {:g} m apart, have {}, {:.2g} % {}. Place its corners at multiples of that "
      "distance, or use a smaller grid.cell.",
      config::location_of(parameters, key), key, rounded_text(body.shape_volume, 3),
      parameters.general.dimension == 2 ? "m3 per m of width" : "m3", body.spacing, rounded_text(body.volume, 3),
      100.0 * std::abs(more), more > 0.0 ? "more" : "less");
}

// Warns of a body over nothing, or far above its support.
std::string resting_warning(const config::Case& parameters, const BodyFigures& body) {
  const std::string key = "body." + body.name;
  if (!parameters.mechanics.enabled || parameters.general.gravity == 0.0 || !parameters.frames.empty()) {
    return "";
  }
  if (std::isinf(body.clearance)) {
    return fmt::format(
        "{}: {} has nothing below it: terrain.type is \"none\" and the lower side of the domain is open, so it falls "
        "out of the domain. Set terrain.type, or close the lower side.",
        config::location_of(parameters, key), key);
  }
  const config::BodyShape shape = parameters.bodies.at(body.name).shape;
  const bool follows = shape == config::BodyShape::surface || shape == config::BodyShape::release;
  if (body.clearance > touching * body.spacing) {
    const double time = std::sqrt(2.0 * body.clearance / parameters.general.gravity);
    return fmt::format(
        "{}: {} floats: its underside is {} m above what is below it, and it falls for {:.2g} s before it touches. "
        "Place it on that{}.",
        config::location_of(parameters, key), key, rounded_text(body.clearance, 3), time,
        follows ? "" : ", or set shape = \"surface\" or \"release\", which follow the ground");
  }
  if (body.resting_fraction < least_resting) {
    return fmt::format(
        "{}: {} rests on {:.2g} % of its area; the gap below the rest is at least {:.3g} m, one particle spacing. {}",
        config::location_of(parameters, key), key, 100.0 * body.resting_fraction, body.spacing,
        follows ? "Correct the terrain or the surface between them."
                : "Use a shape that follows the terrain: shape = \"surface\", \"release\", or a polygon.");
  }
  return "";
}

std::string stiffness_warning(const config::Case& parameters, const BodyFigures& body) {
  const std::string& material = parameters.bodies.at(body.name).material;
  const double modulus = parameters.materials.at(material).youngs_modulus;
  const double load = body.mass / body.volume * parameters.general.gravity * body.largest_thickness;
  const bool deforms = parameters.mechanics.enabled && parameters.mechanisms.deformation;
  if (!deforms || modulus < config::softest_modulus || !(load > most_strain * modulus)) {
    return "";
  }
  const std::string key = "material." + material + ".youngs_modulus";
  return fmt::format(
      "{}: {} is {} Pa: the weight of body {}, {} Pa where it is thickest, compresses it by {:.0f} % there. Give it "
      "{:.1g} Pa or more.",
      config::location_of(parameters, key), key, modulus, body.name, rounded_text(load, 2), 100.0 * load / modulus,
      rounded_up(load / most_strain, 1));
}

std::string band_warning(const config::Case& parameters, const BodyFigures& body) {
  const double thickest = parameters.band.thickness.largest();
  if (!parameters.mechanics.enabled || !(thickest > body.median_thickness)) {
    return "";
  }
  return fmt::format(
      "{}: band.thickness is {} m: more than the body {}, {} m thick in the median. The band is the part of a slide "
      "that shears at its base: typical values are 0.01 to 2 m.",
      config::location_of(parameters, "band.thickness"), thickest, body.name, rounded_text(body.median_thickness, 3));
}

bool is_plastic(const config::Case& parameters, const config::Material& material) {
  return parameters.mechanics.enabled && parameters.mechanisms.deformation &&
         material.law == config::LawKind::mohr_coulomb;
}

double sine_of(double degrees) { return std::sin(degrees * pi / 180.0); }
double cosine_of(double degrees) { return std::cos(degrees * pi / 180.0); }

// Pressure of the body's weight at its median thickness [Pa].
double usual_load(const config::Case& parameters, const BodyFigures& body) {
  return body.mass / body.volume * parameters.general.gravity * body.median_thickness;
}

// Warns of a base that is stronger than the broken body above it. The slide then shears in the cells above its base,
// the base stays frozen, and the result depends on the cell size. The same bound applies in soil mechanics: the
// friction angle of an interface is at most that of the soil. On planes parallel to the base, the body resists N
// tan(phi) + c.
std::string strength_warning(const config::Case& parameters, const BodyFigures& body) {
  const std::string& name = parameters.bodies.at(body.name).material;
  const config::Material& material = parameters.materials.at(name);
  const double load = usual_load(parameters, body);
  if (!is_plastic(parameters, material) || parameters.terrain.kind == config::TerrainKind::none || !(load > 0.0)) {
    return "";
  }
  const physics::basal::ContactNode frozen{.normal_pressure = load, .solid_fraction = 1.0};
  const double base = std::visit([&](const auto& law) { return law.coefficient(frozen); },
                                 config::law_of<physics::basal::FrictionLaw>(parameters.basal));
  const double strain = std::max(material.softening_strain,
                                 physics::softening_strain_of_slip(material.softening_slip, parameters.grid.cell));
  const bool is_unbroken = strain >= strain_of_unbroken;
  const double angle = is_unbroken ? material.friction_angle : material.residual_friction_angle;
  const double cohesion = is_unbroken ? material.cohesion : material.residual_cohesion;
  const double borne = std::tan(angle * pi / 180.0) + cohesion / load;
  if (base <= borne * (1.0 + round_off)) {
    return "";
  }
  const bool softens = material.residual_friction_angle < material.friction_angle;
  const std::string key = "material." + name + (softens ? ".residual_friction_angle" : ".friction_angle");
  return fmt::format(
      "{}: the base is stronger than the broken material of body {} (shear strength {:.3f} and {:.3f} of the load). "
      "The slide shears above its base, the base stays cold, and the results depend on grid.cell. Set a larger {}, or "
      "a basal friction of at most {:.3f} (an angle of {:.1f} degrees).",
      config::location_of(parameters, key), body.name, base, borne, key, borne,
      std::floor(10.0 * std::atan(borne) * 180.0 / pi) / 10.0);
}

// Warns of material that softens over a slip and releases more elastic energy in a cell than its rupture consumes.
std::string softening_warning(const config::Case& parameters, const BodyFigures& body) {
  const std::string& name = parameters.bodies.at(body.name).material;
  const config::Material& material = parameters.materials.at(name);
  if (!is_plastic(parameters, material) || !(material.softening_slip > 0.0)) {
    return "";
  }
  const auto radius = [&](double cohesion, double angle) {
    return cohesion * cosine_of(angle) + usual_load(parameters, body) * sine_of(angle);
  };
  const double loss = radius(material.cohesion, material.friction_angle) -
                      radius(material.residual_cohesion, material.residual_friction_angle);
  const double shear_modulus = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio));
  const double widest = physics::widest_softening_cell(material.softening_slip, shear_modulus, loss);
  if (!(loss > 0.0) || parameters.grid.cell <= widest) {
    return "";
  }
  const std::string key = "material." + name + ".softening_slip";
  return fmt::format(
      "{}: {} is {} m: in a cell of {:g} m the strength falls faster than the elastic strain can follow, and breaking "
      "depends on grid.cell. Set grid.cell to at most {} m, or {} to at least {} m.",
      config::location_of(parameters, key), key, material.softening_slip, parameters.grid.cell, rounded_text(widest, 2),
      key, rounded_text(material.softening_slip * parameters.grid.cell / widest, 2));
}

// Checks temperatures from maps; temperatures given as numbers are checked when the case is read.
std::string temperature_warning(const config::Case& parameters, const BodyFigures& body) {
  const InitialField& temperature = parameters.bodies.at(body.name).temperature;
  const bool is_map = temperature.is_map() && !parameters.bodies.at(body.name).saturation.is_given();
  if (!is_map || !(body.warmest > parameters.freezing.reference_temperature)) {
    return "";
  }
  const std::string key = "body." + body.name + ".temperature";
  return fmt::format(
      "{}: {} is up to {:.{}g} C in '{}': the pores there contain water and no ice from the start. Were temperatures "
      "below 0 meant?",
      config::location_of(parameters, key), key, body.warmest, digits_of_places, temperature.source);
}

// Warns of too few particles across the median thickness, or too few cells for maps.
std::string resolution_warning(const config::Case& parameters, const BodyFigures& body) {
  if (!parameters.mechanics.enabled) {
    return "";
  }
  const config::BodyOnCells on_cells{.name = body.name,
                                     .thickness = body.median_thickness,
                                     .cell = parameters.grid.cell,
                                     .particles_per_axis = parameters.bodies.at(body.name).particles_per_axis,
                                     .dimension = parameters.general.dimension,
                                     .has_maps = config::requests_maps(parameters)};
  const std::string warning = config::resolution_warning(on_cells, "grid.cell");
  return warning.empty() ? "" : config::location_of(parameters, "grid.cell") + ": " + warning;
}

}  // namespace

std::vector<std::string> body_warnings(const config::Case& parameters, const std::vector<BodyFigures>& bodies) {
  std::vector<std::string> found;
  const auto add = [&found](std::string warning) {
    if (!warning.empty()) {
      found.push_back(std::move(warning));
    }
  };
  for (const BodyFigures& body : bodies) {
    add(volume_warning(parameters, body));
    add(resting_warning(parameters, body));
    add(stiffness_warning(parameters, body));
    add(band_warning(parameters, body));
    add(strength_warning(parameters, body));
    add(softening_warning(parameters, body));
    add(temperature_warning(parameters, body));
    add(resolution_warning(parameters, body));
  }
  return found;
}

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
