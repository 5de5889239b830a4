#include "sim/direction.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "config/input_limits.hpp"
#include "sim/maps/path_line.hpp"
#include "terrain/height_field.hpp"

namespace thawslide::sim {

namespace {

constexpr double least_sum = 1e-6;  // of the maximum momentum or force: smaller values are round-off

// Direction along a line in which bodies leave: momentum and force along it, with their magnitudes if fully aligned
// with it.
class Departure {
 public:
  void add_momentum(double mass, double along, double speed) {
    mass_ += mass;
    momentum_ += mass * along;
    most_momentum_ += mass * speed;
  }
  // slope: dz/de; g_e and g_z: gravity along e and downwards.
  void add_force(double mass, double slope, double g_e, double g_z) {
    force_ += mass * (g_e - g_z * slope) / std::hypot(1.0, slope);
    most_force_ += mass * std::hypot(g_e, g_z);
  }
  // Returns 0 if there is no direction. length: of all bodies together, along the direction [m].
  [[nodiscard]] int direction(double length) const {
    const int moving = sign_of(momentum_, most_momentum_), pulled = sign_of(force_, most_force_);
    const bool turns_back = moving * pulled < 0 && momentum_ * momentum_ <= mass_ * std::abs(force_) * length;
    return moving != 0 && !turns_back ? moving : pulled;
  }

 private:
  static int sign_of(double sum, double most) { return std::abs(sum) <= least_sum * most ? 0 : sum > 0.0 ? 1 : -1; }

  double mass_ = 0.0, momentum_ = 0.0, most_momentum_ = 0.0, force_ = 0.0, most_force_ = 0.0;
};

// Extent of the bodies along an axis [m].
class Extent {
 public:
  void add(double point, double half) {
    least_ = std::min(least_, point - half);
    greatest_ = std::max(greatest_, point + half);
  }
  [[nodiscard]] double length() const { return std::max(0.0, greatest_ - least_); }

 private:
  double least_ = HUGE_VAL, greatest_ = -HUGE_VAL;
};

// Part of a body at t = 0 in the horizontal plane [m].
struct Part {
  Point2 point;
  Point2 half;    // half side lengths
  double volume;  // [m3], or a fraction of it that is equal for all parts of a body
  const config::Body* body;
};

std::vector<Part> parts_of_bodies(const config::Case& parameters, const config::Site& site) {
  std::vector<Part> parts;
  for (const auto& [name, body] : parameters.bodies) {
    const auto found = site.releases.find(name);
    if (found == site.releases.end()) {  // a box
      double volume = 1.0;
      for (std::size_t a = 0; a < 3; ++a) {
        volume *= body.max[a] - body.min[a];
      }
      parts.push_back({{0.5 * (body.min[0] + body.max[0]), 0.5 * (body.min[1] + body.max[1])},
                       {0.5 * (body.max[0] - body.min[0]), 0.5 * (body.max[1] - body.min[1])},
                       volume,
                       &body});
      continue;
    }
    const Raster& thickness = found->second.thickness;
    config::for_points_of_release(thickness, [&, &of = body](int column, int row) {
      parts.push_back({{thickness.x_of(column), thickness.y_of(row)},
                       {0.5 * thickness.cell_x, 0.5 * thickness.cell_y},
                       thickness.at(column, row) * thickness.cell_x * thickness.cell_y,
                       &of});
    });
  }
  return parts;
}

// Direction of the line, from half a length before a distance to half a length after it [m].
Point2 direction_at(const PathLine& line, double along, double length) {
  const Point2 from = line.point_at(along - 0.5 * length), to = line.point_at(along + 0.5 * length);
  const double x = to[0] - from[0], y = to[1] - from[1], distance = std::hypot(x, y);
  return distance > 0.0 ? Point2{x / distance, y / distance} : Point2{0.0, 0.0};  // the line turns back there
}

// Length of all bodies together along a mean of directions.
double length_along(const Point2& e, const std::vector<Part>& parts) {
  const double norm = std::hypot(e[0], e[1]);
  Extent extent;
  for (const Part& part : parts) {
    extent.add((part.point[0] * e[0] + part.point[1] * e[1]) / norm,
               (part.half[0] * std::abs(e[0]) + part.half[1] * std::abs(e[1])) / norm);
  }
  return norm > 0.0 ? extent.length() : 0.0;
}

bool bodies_leave_against(const PathLine& line, const std::vector<Part>& parts, const config::Case& parameters,
                          const terrain::HeightField& ground, double width) {
  const double gravity = parameters.general.gravity, tilt = parameters.general.gravity_tilt * std::numbers::pi / 180.0;
  Departure departure;
  double middle = 0.0, volume = 0.0;
  Point2 mean{0.0, 0.0};
  for (const Part& part : parts) {
    const double along = line.project(part.point).along;
    const Point2 e = direction_at(line, along, width);
    const auto& v = part.body->velocity;
    departure.add_momentum(part.volume, v[0] * e[0] + v[1] * e[1], std::hypot(v[0], v[1]));
    const auto gradient = ground.gradient(Vector<double, 2>(part.point[0], part.point[1]), width);
    departure.add_force(part.volume, gradient[0] * e[0] + gradient[1] * e[1], gravity * std::sin(tilt) * e[0],
                        gravity * std::cos(tilt));
    mean = {mean[0] + part.volume * e[0], mean[1] + part.volume * e[1]};
    middle += part.volume * along;
    volume += part.volume;
  }
  const int direction = departure.direction(length_along(mean, parts));
  return direction < 0 || (direction == 0 && middle / volume > 0.5 * line.length());
}

bool path_is_to_be_reversed(const config::Case& parameters, const config::Site& site, const std::vector<Part>& parts) {
  const PathLine line(site.path);
  if (line.empty()) {
    return false;
  }
  const terrain::HeightField ground(*site.ground);
  if (!parts.empty()) {
    const double points_apart = std::max(site.ground->cell_x, site.ground->cell_y);
    return bodies_leave_against(line, parts, parameters, ground, std::max(parameters.grid.cell, 2.0 * points_apart));
  }
  const auto height = [&](const Point2& point) { return ground.height(Vector<double, 2>(point[0], point[1])); };
  return height(line.corners().front()) < height(line.corners().back());
}

// Cross product a x b of two vectors, each given by its end points.
double cross(const Point2& a_from, const Point2& a_to, const Point2& b_from, const Point2& b_to) {
  return (a_to[0] - a_from[0]) * (b_to[1] - b_from[1]) - (a_to[1] - a_from[1]) * (b_to[0] - b_from[0]);
}

// First crossing of the line by the path: 1 from left to right, -1 from right to left, 0 if it does not cross.
int crossing(const config::Polyline2& path, const config::Polyline2& line) {
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    double earliest = HUGE_VAL;
    int found = 0;
    for (std::size_t n = 0; n + 1 < line.size(); ++n) {
      const double turn = cross(path[k], path[k + 1], line[n], line[n + 1]);
      const double on_path = cross(path[k], line[n], line[n], line[n + 1]) / turn;
      const double on_line = cross(path[k], line[n], path[k], path[k + 1]) / turn;
      if (turn != 0.0 && on_path >= 0.0 && on_path <= 1.0 && on_line >= 0.0 && on_line <= 1.0 && on_path < earliest) {
        earliest = on_path;
        found = turn > 0.0 ? 1 : -1;
      }
    }
    if (found != 0) {
      return found;
    }
  }
  return 0;
}

bool bodies_lie_to_the_right(const config::Polyline2& corners, const std::vector<Part>& parts) {
  const PathLine line(corners);
  if (line.empty() || parts.empty()) {
    return false;
  }
  Point2 centre{0.0, 0.0};
  double volume = 0.0;
  for (const Part& part : parts) {
    centre = {centre[0] + part.volume * part.point[0], centre[1] + part.volume * part.point[1]};
    volume += part.volume;
  }
  return line.project({centre[0] / volume, centre[1] / volume}).offset < 0.0;
}

}  // namespace

std::string orient_lines(const config::Case& parameters, config::Site& site) {
  if (!site.ground) {
    return "";
  }
  const std::vector<Part> parts = parts_of_bodies(parameters, site);
  const bool is_reversed = path_is_to_be_reversed(parameters, site, parts);
  if (is_reversed) {
    std::reverse(site.path.begin(), site.path.end());
  }
  for (auto& [name, line] : site.probes) {
    const int across = crossing(site.path, line);
    if (across < 0 || (across == 0 && bodies_lie_to_the_right(line, parts))) {
      std::reverse(line.begin(), line.end());
    }
  }
  return is_reversed ? fmt::format(
                           "maps.path: {} was drawn against the direction of the slide; distances count from its last "
                           "corner",
                           config::shown(std::filesystem::path(parameters.maps.path).filename().string()))
                     : "";
}

std::string warning_of_path(const config::Case& parameters, const config::Site& site) {
  const PathLine line(site.path);
  if (line.empty() || !site.ground) {
    return "";
  }
  double least = HUGE_VAL;  // from the path to a part of a body, minus half of its side
  for (const Part& part : parts_of_bodies(parameters, site)) {
    const Point2 nearest = line.point_at(line.project(part.point).along);
    least = std::min(least, std::hypot(part.point[0] - nearest[0], part.point[1] - nearest[1]) -
                                std::max(part.half[0], part.half[1]));
  }
  if (std::isinf(least) || least <= std::max(site.ground->cell_x, site.ground->cell_y)) {
    return "";
  }
  return fmt::format(
      "maps.path: {} misses the release by {} m. Front, travel distance and reach angle are nevertheless measured "
      "along it. Draw it through the release.",
      config::shown(std::filesystem::path(parameters.maps.path).filename().string()), rounded_text(least, 3));
}

template <int Dim>
std::vector<BodyAtStart> bodies_at_start(const Model<Dim>& model, const mpm::Particles<Dim>& particles, double cell) {
  std::vector<BodyAtStart> bodies(model.body_names.size());
  std::vector<Departure> departures(bodies.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto number = static_cast<std::size_t>(particles.body(p));
    const auto mass = particles.mass(p), speed = particles.velocity(p, 0);
    const auto x = particles.position(p, 0), half = model.motion.sizes.half(number) * cell;
    BodyAtStart& body = bodies[number];
    body.mass += mass;
    body.lower = std::min(body.lower, x - half + model.origin[0]);
    body.upper = std::max(body.upper, x + half + model.origin[0]);
    const auto point = particles.position.template get<Vector<double, Dim - 1>>(p);
    departures[number].add_momentum(mass, speed, std::abs(speed));
    departures[number].add_force(mass, model.ground ? model.ground->gradient(point, cell)[0] : 0.0,
                                 model.motion.gravity[0], -model.motion.gravity[Dim - 1]);
  }
  for (std::size_t number = 0; number < bodies.size() && Dim == 2; ++number) {
    BodyAtStart& body = bodies[number];
    body.direction = departures[number].direction(body.upper - body.lower) < 0 ? -1.0 : 1.0;
  }
  return bodies;
}

double direction_of(const std::vector<BodyAtStart>& bodies, const MovedMass& moved) {
  double mass = 0.0;
  for (std::size_t number = 0; number < bodies.size(); ++number) {
    mass += moved.has(number) ? bodies[number].direction * bodies[number].mass : 0.0;
  }
  return mass < 0.0 ? -1.0 : 1.0;
}

template <int Dim>
FrontAlongX front_along_x(const Simulation<Dim>& simulation) {
  const std::vector<BodyAtStart>& bodies = simulation.bodies_at_start();
  const MovedMass moved = simulation.moved_mass();
  const double at_start = direction_of(bodies, moved);
  double rear = HUGE_VAL;
  for (std::size_t number = 0; number < bodies.size(); ++number) {
    if (moved.has(number) && bodies[number].mass > 0.0) {
      rear = std::min(rear, at_start < 0.0 ? -bodies[number].upper : bodies[number].lower);
    }
  }
  rear *= at_start;
  const double ahead = simulation.front(moved).position[0];
  if (Dim == 3) {
    return {1.0, ahead, rear};
  }
  const PathLine towards_lower_x(config::Polyline2{{0.0, 0.0}, {-1.0, 0.0}});
  const double behind = simulation.front(moved, towards_lower_x.view()).position[0];
  return 0.5 * (ahead + behind) < rear ? FrontAlongX{-1.0, behind, rear} : FrontAlongX{1.0, ahead, rear};
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                               \
  template std::vector<BodyAtStart> bodies_at_start<Dim>(const Model<Dim>&, const mpm::Particles<Dim>&, double); \
  template FrontAlongX front_along_x<Dim>(const Simulation<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
