#include "sim/setup/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "sim/setup/body_shape.hpp"
#include "sim/setup/initial_state.hpp"
#include "sim/setup/seed.hpp"

namespace thawslide::sim {

namespace {

// True if the part of a body that begins at `low` is on the terrain, directly or through bodies below it.
template <int Dim>
bool stands(const std::vector<BodyShape<Dim>>& shapes, const Vector<double, Dim>& position, double low, double terrain,
            double tie) {
  return low <= terrain + tie || std::any_of(shapes.begin(), shapes.end(), [&](const BodyShape<Dim>& below) {
           if (below.release() || (Dim == 3 && !(below.lower(1) <= position[1] && position[1] <= below.upper(1)))) {
             return false;
           }
           const auto parts = below.parts_over(position[0]);
           return std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
             return part.first < low - tie && std::abs(part.second - low) <= tie &&
                    stands(shapes, position, part.first, terrain, tie);
           });
         });
}

// With ground: columns of particles of equal height. Parts of bodies that stand on the terrain,
// also on each other, are lifted with the ground of the grid.
template <int Dim>
void seed_columns(const config::Case& parameters, const Model<Dim>& model, const config::Body& body,
                  const std::vector<BodyShape<Dim>>& shapes, int number, std::vector<Seed<Dim>>& seeds) {
  const BodyShape<Dim>& shape = shapes[static_cast<std::size_t>(number)];
  const double spacing = parameters.grid.cell / body.particles_per_axis, tie = 1e-9 * parameters.grid.cell;
  std::array<long, 2> first{}, last{};
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    first[a] = std::lround(std::ceil((shape.lower(a) - tie - parameters.grid.min[a]) / spacing - 0.5));
    last[a] = std::lround(std::floor((shape.upper(a) + tie - parameters.grid.min[a]) / spacing - 0.5));
  }
  for (long j = first[1]; j <= last[1]; ++j) {
    for (long i = first[0]; i <= last[0]; ++i) {
      const std::array<long, 2> index{i, j};
      Vector<double, Dim> position;
      std::array<std::uint32_t, 3> lattice{};
      for (std::size_t a = 0; a + 1 < Dim; ++a) {
        position[static_cast<int>(a)] = parameters.grid.min[a] + (static_cast<double>(index[a]) + 0.5) * spacing;
        lattice[a] = static_cast<std::uint32_t>(index[a] - first[a]);
      }
      const Vector<double, Dim - 1> below = (position - model.origin).template head<Dim - 1>();
      const double terrain = model.ground->terrain().height(below) + model.origin[Dim - 1];
      const double ground = model.ground->height(below, static_cast<std::size_t>(number)) + model.origin[Dim - 1];
      for (const auto& [low, high] : shape.parts_over(position[0])) {
        const double lift =
            stands(shapes, position, low, terrain, 1e-6 * parameters.grid.cell) ? ground - terrain : 0.0;
        const double bottom = std::max(low + lift, ground), top = high + lift;
        const long count = top > bottom ? std::lround((top - bottom) / spacing) : 0;
        const double height = (top - bottom) / static_cast<double>(std::max(1L, count));
        for (long k = 0; k < count; ++k) {
          position[Dim - 1] = bottom + (static_cast<double>(k) + 0.5) * height;
          seeds.push_back(
              {number, position, top - position[Dim - 1], height * std::pow(spacing, Dim - 1), lattice, lift});
          ++lattice[Dim - 1];
        }
      }
    }
  }
}

// Places particles at the centres of equal parts of the cells.
template <int Dim>
void seed_body(const config::Case& parameters, const Model<Dim>& model, const config::Body& body,
               const std::vector<BodyShape<Dim>>& shapes, int number, std::vector<Seed<Dim>>& seeds) {
  const BodyShape<Dim>& shape = shapes[static_cast<std::size_t>(number)];
  const double spacing = parameters.grid.cell / body.particles_per_axis;
  const double volume = std::pow(spacing, Dim);
  if constexpr (Dim == 3) {
    if (shape.release()) {
      const Vector<double, 3> corner(parameters.grid.min[0], parameters.grid.min[1], parameters.grid.min[2]);
      shape.release()->seed(corner, spacing, number, seeds);
      return;
    }
  }
  if (model.ground) {
    seed_columns(parameters, model, body, shapes, number, seeds);
    return;
  }
  std::array<long, 3> first{}, last{};
  for (std::size_t a = 0; a < Dim; ++a) {
    first[a] = static_cast<long>(std::floor((shape.lower(a) - parameters.grid.min[a]) / spacing)) - 1;
    last[a] = static_cast<long>(std::ceil((shape.upper(a) - parameters.grid.min[a]) / spacing)) + 1;
  }
  for (long k = first[2]; k <= last[2]; ++k) {
    for (long j = first[1]; j <= last[1]; ++j) {
      for (long i = first[0]; i <= last[0]; ++i) {
        const std::array<long, 3> index{i, j, k};
        Vector<double, Dim> position;
        for (std::size_t a = 0; a < Dim; ++a) {
          position[static_cast<int>(a)] = parameters.grid.min[a] + (static_cast<double>(index[a]) + 0.5) * spacing;
        }
        if (shape.contains(position)) {
          std::array<std::uint32_t, 3> lattice{};
          for (std::size_t a = 0; a < Dim; ++a) {
            lattice[a] = static_cast<std::uint32_t>(index[a] - first[a]);
          }
          seeds.push_back(
              {number, position, shape.top(position[0], position[Dim - 1]) - position[Dim - 1], volume, lattice});
        }
      }
    }
  }
}

// Tolerance of the particle volume relative to the body's volume. A larger deviation means that the spacing is too
// coarse for the shape.
constexpr double volume_tolerance = 0.15;
// Maximum fraction of a release's volume that columns at its rim cannot represent; all particles are scaled to conserve
// the volume. Upright sides that are poorly aligned with the lattice change the volume of a body 8 columns wide by 2 %.
constexpr double release_tolerance = 0.05;

// seeds: those of the body begin at index `first`.
template <int Dim>
void require_volume(const config::Case& parameters, const Model<Dim>& model, const std::string& name,
                    const config::Body& body, const BodyShape<Dim>& shape, std::size_t first,
                    std::vector<Seed<Dim>>& seeds) {
  const double spacing = parameters.grid.cell / body.particles_per_axis;
  double seeded = 0.0;
  for (std::size_t p = first; p < seeds.size(); ++p) {
    seeded += seeds[p].volume;
  }
  const double fraction = shape.volume() / seeded;
  if (shape.release() && !(seeded >= (1.0 - release_tolerance) * shape.volume())) {
    throw UserError(fmt::format(
        "{}: body '{}': particles {} m apart cannot represent {} % of its {} m3, because it is too thin there, or "
        "lies at its rim (allowed: {:g} %). Set a smaller grid.cell or a larger particles_per_axis, or check the unit "
        "of the thickness.",
        config::location_of(parameters, "body." + name), name, spacing,
        rounded_text(100.0 * (1.0 - seeded / shape.volume()), 2), rounded_text(shape.volume(), 3),
        100.0 * release_tolerance));
  }
  if (!(std::abs(1.0 / fraction - 1.0) <= volume_tolerance)) {
    throw UserError(fmt::format(
        "{}: body '{}' has a volume of {} {}, and its {} particles, {} m apart, {}; allowed: within {:g} %. Place its "
        "corners at multiples of the spacing, or use a smaller grid.cell or more particles_per_axis.",
        config::location_of(parameters, "body." + name), name, rounded_text(shape.volume(), 3),
        Dim == 2 ? "m3 per m" : "m3", seeds.size() - first, spacing, rounded_text(seeded, 3),
        100.0 * volume_tolerance));
  }
  // Scales columns to the body's exact volume, because its edges are not aligned with the lattice.
  for (std::size_t p = first; (shape.release() || model.ground) && p < seeds.size(); ++p) {
    seeds[p].volume *= fraction;
  }
}

template <int Dim>
Vector<double, Dim> place_in_shape(const Seed<Dim>& seed) {
  return seed.position - seed.lift * Vector<double, Dim>::Unit(Dim - 1);
}

// Requires that no two bodies fill the same place.
template <int Dim>
void require_apart(const config::Case& parameters, const std::vector<std::string>& names,
                   const std::vector<BodyShape<Dim>>& shapes, const std::vector<Seed<Dim>>& seeds) {
  for (const Seed<Dim>& seed : seeds) {
    for (std::size_t other = static_cast<std::size_t>(seed.body) + 1; other < shapes.size(); ++other) {
      if (shapes[other].contains(place_in_shape(seed))) {
        throw UserError(
            fmt::format("{}: body '{}' and body '{}' both fill the place x = {} m, {}elevation {} m; allowed: bodies "
                        "that touch but do not overlap. Move one of them.",
                        config::location_of(parameters, "body." + names[other]),
                        names[static_cast<std::size_t>(seed.body)], names[other], coordinate_text(seed.position[0]),
                        Dim == 3 ? fmt::format("y = {} m, ", coordinate_text(seed.position[1])) : "",
                        coordinate_text(seed.position[Dim - 1])));
      }
    }
  }
}

// Geostatic normal stress and K0 in the axes of the ground below (of gravity if there is no ground). With slope shear,
// if requested, the stress balances an infinite slope.
template <int Dim>
SymmetricTensor<double> initial_stress(const config::Case& parameters, const Model<Dim>& model, const Seed<Dim>& seed,
                                       double density, double poisson_ratio) {
  SymmetricTensor<double> stress = SymmetricTensor<double>::Zero();
  if (parameters.mechanics.initial_stress != config::InitialStress::geostatic) {
    return stress;
  }
  const Vector<double, Dim> gravity = model.motion.gravity;
  Vector<double, Dim> up = -gravity;
  double cosine = 1.0;
  if (model.ground) {
    const Vector<double, Dim - 1> below = (seed.position - model.origin).template head<Dim - 1>();
    up = -model.ground->normal_below(below, parameters.grid.cell);
    cosine = model.ground->slope_cosine(below, parameters.grid.cell);
  }
  if (up.norm() == 0.0) {
    return stress;
  }
  up.normalize();
  const double depth = seed.depth * cosine;
  const double normal = density * gravity.dot(up) * depth;  // negative: compression
  const double k0 = parameters.mechanics.k0 >= 0.0 ? parameters.mechanics.k0 : poisson_ratio / (1.0 - poisson_ratio);
  Matrix<double, 3> full = Matrix<double, 3>::Identity() * (k0 * normal);
  Vector<double, 3> m = Vector<double, 3>::Zero();
  Vector<double, 3> along = Vector<double, 3>::Zero();
  const Vector<double, Dim> tangential = gravity - gravity.dot(up) * up;
  for (int a = 0; a < Dim; ++a) {
    m[a] = up[a];
    along[a] = tangential[a];
  }
  full += (1.0 - k0) * normal * m * m.transpose();
  if (parameters.mechanics.slope_shear) {
    full += density * depth * (along * m.transpose() + m * along.transpose());
  }
  const double components[6] = {full(0, 0), full(1, 1), full(2, 2), full(0, 1), full(1, 2), full(0, 2)};
  for (int c = 0; c < 6; ++c) {
    stress[c] = components[c];
  }
  return stress;
}

template <int Dim>
std::optional<ReleaseBody> release_of(const config::Site& site, const Model<Dim>& model, const std::string& name,
                                      const config::Body& body) {
  if constexpr (Dim == 3) {
    if (body.shape == config::BodyShape::release) {
      return ReleaseBody(site.releases, name, *model.ground, model.origin);
    }
  }
  return std::nullopt;
}

// Checks bodies on a DEM; on other terrain, the case was checked when it was read.
template <int Dim>
void require_above_ground(const config::Case& parameters, const Model<Dim>& model, const std::string& name,
                          std::size_t first, const std::vector<Seed<Dim>>& seeds) {
  if (parameters.terrain.kind != config::TerrainKind::dem) {
    return;
  }
  for (std::size_t p = first; p < seeds.size(); ++p) {
    const Vector<double, Dim> position = seeds[p].position - model.origin;
    const double ground = model.ground->height(position.template head<Dim - 1>());
    if (position[Dim - 1] < ground) {
      throw UserError(fmt::format(
          "{}: body '{}' is below the terrain: at x = {} m, y = {} m it has a particle at an elevation of {} m "
          "and the ground is at {} m; allowed: above the ground. Lift the body, or use the shape \"release\".",
          config::location_of(parameters, "body." + name), name, coordinate_text(seeds[p].position[0]),
          coordinate_text(seeds[p].position[1]), coordinate_text(seeds[p].position[Dim - 1]),
          coordinate_text(ground + model.origin[Dim - 1])));
    }
  }
}

// Checks releases; the extent of other bodies was checked when the case was read.
template <int Dim>
void require_within_domain(const config::Case& parameters, const std::string& name, std::size_t first,
                           const std::vector<Seed<Dim>>& seeds) {
  constexpr const char* axes[] = {"x", "y", "elevation"};
  const config::Grid& grid = parameters.grid;
  for (std::size_t p = first; p < seeds.size(); ++p) {
    for (std::size_t a = 0; a < Dim; ++a) {
      const double position = seeds[p].position[static_cast<int>(a)];
      if (position < grid.min[a] || position > grid.max[a]) {
        throw UserError(
            fmt::format("{}: body '{}' has a particle at x = {} m, y = {} m, elevation {} m, outside the domain, whose "
                        "{} is from {} to {} m. Widen grid.min and grid.max, or correct terrain.file.",
                        config::location_of(parameters, "body." + name), name, coordinate_text(seeds[p].position[0]),
                        coordinate_text(seeds[p].position[1]), coordinate_text(seeds[p].position[Dim - 1]), axes[a],
                        coordinate_text(grid.min[a]), coordinate_text(grid.max[a])));
      }
    }
  }
}

// Position of a seed displaced by initial.noise, or its regular position if the displacement would move it out of its
// body or below the ground. All other properties of the particle follow from the regular position.
template <int Dim>
Vector<double, Dim> starting_position(const config::Case& parameters, const Model<Dim>& model, const config::Body& body,
                                      const BodyShape<Dim>& shape, const Seed<Dim>& seed) {
  if (parameters.initial.noise == 0.0) {
    return seed.position;
  }
  const double spacing = parameters.grid.cell / body.particles_per_axis;
  const Vector<double, Dim> position = seed.position + starting_displacement(parameters.initial, spacing, seed);
  const Vector<double, Dim> relative = position - model.origin;
  const bool is_above_ground =
      !model.ground || relative[Dim - 1] > model.ground->height(relative.template head<Dim - 1>());
  return is_above_ground && shape.contains(position) ? position : seed.position;
}

}  // namespace

template <int Dim>
void fill_bodies(const config::Case& parameters, const config::Site& site, const Model<Dim>& model,
                 mpm::Particles<Dim>& particles) {
  std::vector<Seed<Dim>> seeds;
  std::vector<const config::Body*> bodies;
  std::vector<std::size_t> material_of;
  std::vector<BodyShape<Dim>> shapes;
  std::vector<const config::Release*> releases;
  for (const auto& [name, body] : parameters.bodies) {
    shapes.emplace_back(parameters, site, body, release_of(site, model, name, body));
  }
  for (const auto& [name, body] : parameters.bodies) {
    const std::size_t before = seeds.size();
    const BodyShape<Dim>& shape = shapes[bodies.size()];
    seed_body(parameters, model, body, shapes, static_cast<int>(bodies.size()), seeds);
    require_volume(parameters, model, name, body, shape, before, seeds);
    require_above_ground(parameters, model, name, before, seeds);
    if (shape.release()) {
      require_within_domain(parameters, name, before, seeds);
    }
    releases.push_back(site.releases.count(name) != 0 ? &site.releases.at(name) : nullptr);
    bodies.push_back(&body);
    const auto material = std::find(model.material_names.begin(), model.material_names.end(), body.material);
    material_of.push_back(static_cast<std::size_t>(material - model.material_names.begin()));
  }
  require_apart(parameters, model.body_names, shapes, seeds);
  particles.resize(seeds.size());
  for (std::size_t p = 0; p < seeds.size(); ++p) {
    const Seed<Dim>& seed = seeds[p];
    const config::Body& body = *bodies[static_cast<std::size_t>(seed.body)];
    const config::Release* release = releases[static_cast<std::size_t>(seed.body)];
    particles.id(p) = static_cast<std::int64_t>(p);
    particles.body(p) = seed.body;
    particles.material(p) = static_cast<std::int32_t>(material_of[static_cast<std::size_t>(seed.body)]);
    const Vector<double, Dim> position =
        starting_position(parameters, model, body, shapes[static_cast<std::size_t>(seed.body)], seed);
    const double width = model.motion.width.at(position[0] - model.origin[0]);
    particles.initial_volume(p) = particles.volume(p) = width * seed.volume;
    particles.temperature(p) = initial_temperature(model, body, release, seed);
    const double saturation = model.band.with_heat_content(
        [&](const auto& content) { return content.curve.saturation(particles.temperature(p)); });
    particles.porosity(p) = particles.initial_porosity(p) = initial_porosity(body, release, seed, saturation);
    particles.thermal_scaling(p) = 1.0;
    const double density = physics::mixture_density(model.motion.phases, particles.porosity(p), saturation);
    particles.mass(p) = density * particles.volume(p);
    for (int a = 0; a < Dim; ++a) {
      particles.position(p, a) = position[a] - model.origin[a];
      particles.velocity(p, a) = body.velocity[static_cast<std::size_t>(a)];
    }
    const auto stress =
        initial_stress(parameters, model, seed, density, parameters.materials.at(body.material).poisson_ratio);
    for (int c = 0; c < mpm::tensor_components<Dim>; ++c) {
      particles.stress(p, c) = stress[c];
    }
  }
}

template void fill_bodies(const config::Case&, const config::Site&, const Model<2>&, mpm::Particles<2>&);
template void fill_bodies(const config::Case&, const config::Site&, const Model<3>&, mpm::Particles<3>&);

}  // namespace thawslide::sim
