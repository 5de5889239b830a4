// Checks of bodies and frames against the grid, the terrain and the materials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/checks.hpp"

namespace thawslide::config {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double hair = 1e-3;  // of a cell: how far a body may reach into the ground by rounding

// Elevation of the ground; -infinity where there is none.
double ground_at(const Case& checked, const ProfileTable& profile, double x) {
  switch (checked.terrain.kind) {
    case TerrainKind::none:
      break;
    case TerrainKind::flat:
      return checked.terrain.elevation;
    case TerrainKind::plane:
      return checked.terrain.elevation - std::tan(checked.terrain.slope * degree) * x;
    case TerrainKind::profile:
      return profile.empty() ? -INFINITY : profile.terrain_at(x);
  }
  return -INFINITY;
}

std::string point_text(const Point& point, int dimension) {
  return dimension == 2 ? fmt::format("({}, {})", point[0], point[1])
                        : fmt::format("({}, {}, {})", point[0], point[1], point[2]);
}

bool check_box_order(const Point& low, const Point& high, const std::string& table, int dimension, Reading& reading) {
  if (!reading.sound({table + ".min", table + ".max"})) {
    return false;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    if (!(low[a] < high[a])) {
      reading.report(
          table + ".max",
          fmt::format("{}.max is {}, not above {}.min, which is {}, in every direction; give the highest corner "
                      "of the box.",
                      table, point_text(high, dimension), table, point_text(low, dimension)));
      return false;
    }
  }
  return true;
}

void check_in_domain(const Case& checked, const Point& low, const Point& high, const std::string& table,
                     const std::string& key, Reading& reading) {
  const Grid& grid = checked.grid;
  if (!reading.sound({"grid.min", "grid.max"})) {
    return;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(checked.general.dimension); ++a) {
    if (low[a] < grid.min[a] || high[a] > grid.max[a]) {
      reading.report(
          key, fmt::format("{} reaches from {} to {}, outside the domain, which is {} to {}; move the body, or "
                           "widen grid.min and grid.max.",
                           table, point_text(low, checked.general.dimension),
                           point_text(high, checked.general.dimension), point_text(grid.min, checked.general.dimension),
                           point_text(grid.max, checked.general.dimension)));
      return;
    }
  }
}

void report_below_ground(double x, double height, double ground, const std::string& table, const std::string& key,
                         Reading& reading) {
  reading.report(
      key, fmt::format("{} is below the terrain: at x = {:.6g} m its elevation is {:.6g} m and the ground's {:.6g} "
                       "m; allowed: on the ground or above it. Lift the body, or lower the terrain.",
                       table, x, height, ground));
}

void check_box(const Case& checked, const ProfileTable& profile, const Body& body, const std::string& table,
               Reading& reading) {
  const int dimension = checked.general.dimension;
  if (!check_box_order(body.min, body.max, table, dimension, reading)) {
    return;
  }
  check_in_domain(checked, body.min, body.max, table, table + ".min", reading);
  const double bottom = body.min[static_cast<std::size_t>(dimension - 1)];
  std::vector<double> places{body.min[0], body.max[0]};
  for (const double x : profile.distance) {
    if (x > body.min[0] && x < body.max[0]) {
      places.push_back(x);
    }
  }
  for (const double x : places) {
    const double ground = ground_at(checked, profile, x);
    if (bottom < ground - hair * checked.grid.cell) {
      report_below_ground(x, bottom, ground, table, table + ".min", reading);
      return;
    }
  }
}

void check_polygon(const Case& checked, const ProfileTable& profile, const Body& body, const std::string& table,
                   Reading& reading) {
  const std::string key = table + ".vertices";
  if (!reading.sound({key})) {
    return;
  }
  const auto& vertices = body.vertices;
  double twice_area = 0.0;
  Point low{INFINITY, INFINITY, 0.0}, high{-INFINITY, -INFINITY, 0.0};
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const auto& a = vertices[k];
    const auto& b = vertices[(k + 1) % vertices.size()];
    twice_area += a[0] * b[1] - b[0] * a[1];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], a[axis]);
      high[axis] = std::max(high[axis], a[axis]);
    }
  }
  if (vertices.size() < 3 || twice_area == 0.0) {
    reading.report(
        key, fmt::format("{} are {} points that hold no area; allowed: at least 3, in order around the body.", key,
                         vertices.size()));
    return;
  }
  check_in_domain(checked, low, high, table, key, reading);
  for (const auto& vertex : vertices) {
    const double ground = ground_at(checked, profile, vertex[0]);
    if (vertex[1] < ground - hair * checked.grid.cell) {
      report_below_ground(vertex[0], vertex[1], ground, table, key, reading);
      return;
    }
  }
}

void check_surface(const Case& checked, const ProfileTable& profile, const std::string& table, Reading& reading) {
  if (checked.terrain.kind != TerrainKind::profile) {
    reading.report(table + ".shape",
                   fmt::format("{}.shape is \"surface\", and terrain.type is not \"profile\"; that shape "
                               "takes the body from the profile's surface_elevation_m.",
                               table));
    return;
  }
  if (profile.empty()) {
    return;
  }
  if (profile.surface.empty()) {
    reading.report(
        table + ".shape",
        fmt::format("{}.shape is \"surface\", and the profile has no column surface_elevation_m; add it to {}, or "
                    "use the shape \"box\" or \"polygon\".",
                    table, checked.terrain.file));
    return;
  }
  Point low{INFINITY, INFINITY, 0.0}, high{-INFINITY, -INFINITY, 0.0};
  const auto up = static_cast<std::size_t>(checked.general.dimension - 1);
  for (std::size_t k = 0; k < profile.distance.size(); ++k) {
    if (profile.surface[k] > profile.terrain[k]) {
      low = {std::min(low[0], profile.distance[k]), std::min(low[1], profile.terrain[k]), 0.0};
      high = {std::max(high[0], profile.distance[k]), std::max(high[1], profile.surface[k]), 0.0};
    }
  }
  if (!(low[0] < high[0])) {
    reading.report(table + ".shape",
                   fmt::format("the profile's surface is nowhere above its terrain: {} holds nothing.", table));
    return;
  }
  if (up == 1) {
    check_in_domain(checked, low, high, table, table + ".shape", reading);
  }
}

void check_body(const Case& checked, const ProfileTable& profile, const std::string& name, const Body& body,
                Reading& reading) {
  const std::string table = "body." + name;
  std::vector<std::string> known;
  for (const auto& [material, unused] : checked.materials) {
    known.push_back(material);
  }
  if (reading.sound({table + ".material"}) && checked.materials.count(body.material) == 0) {
    const std::string hint = did_you_mean(body.material, known);
    reading.report(table + ".material",
                   fmt::format("{}.material is '{}', and there is no [material.{}]{} Allowed: {}.", table,
                               body.material, body.material, hint.empty() ? "." : hint,
                               known.empty() ? "none, as the case has no [material.NAME]" : list_words(known)));
  }
  if (!reading.sound({table + ".shape", "grid.cell"})) {
    return;
  }
  if (body.shape != BodyShape::box && checked.general.dimension == 3) {
    reading.report(table + ".shape", fmt::format("{}.shape is for sections; in 3D a body is a \"box\".", table));
  } else if (body.shape == BodyShape::box) {
    check_box(checked, profile, body, table, reading);
  } else if (body.shape == BodyShape::polygon) {
    check_polygon(checked, profile, body, table, reading);
  } else {
    check_surface(checked, profile, table, reading);
  }
}

void check_frame(const Case& checked, const std::string& name, const Frame& frame, Reading& reading) {
  const std::string table = "frame." + name;
  check_box_order(frame.min, frame.max, table, checked.general.dimension, reading);
  if (reading.sound({table + ".axis"}) && frame.axis == "z" && checked.general.dimension == 2) {
    reading.report(table + ".axis", fmt::format("{}.axis is \"z\" in a 2D case; allowed: \"x\" or \"y\".", table));
  }
}

}  // namespace

void check_bodies(const Case& checked, const ProfileTable& profile, Reading& reading) {
  if (checked.bodies.empty() && reading.sound({"body"})) {
    reading.report("body", "the case has no body; add a table [body.NAME] with its material and shape.");
  }
  for (const auto& [name, body] : checked.bodies) {
    check_body(checked, profile, name, body, reading);
  }
  for (const auto& [name, frame] : checked.frames) {
    check_frame(checked, name, frame, reading);
  }
}

}  // namespace thawslide::config
