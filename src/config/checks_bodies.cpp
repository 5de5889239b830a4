// Checks of bodies and frames against the grid, the terrain and the materials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/portability.hpp"
#include "base/rounding.hpp"
#include "config/checks.hpp"

namespace thawslide::config {

namespace {

constexpr double radians_per_degree = pi / 180.0;
constexpr double rounding_depth =
    1e-3;                      // fraction of a cell: depth to which a body may extend into the ground by rounding
constexpr double flat = 1e-9;  // fraction of the squared size of a polygon: an area due to rounding

// Elevation of the ground; -infinity without terrain, and on a DEM, which is not read here.
double ground_at(const Case& checked, const ProfileTable& profile, double x) {
  switch (checked.terrain.kind) {
    case TerrainKind::none:
    case TerrainKind::dem:
      break;
    case TerrainKind::flat:
      return checked.terrain.elevation;
    case TerrainKind::plane:
      return checked.terrain.elevation - std::tan(checked.terrain.slope * radians_per_degree) * x;
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
  if (!reading.are_valid({table + ".min", table + ".max"})) {
    return false;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    if (!(low[a] < high[a])) {
      reading.report({table + ".max", table + ".min"},
                     "{}.max is {}, not above {}.min, which is {}, in every direction; give the highest corner "
                     "of the box.",
                     table, point_text(high, dimension), table, point_text(low, dimension));
      return false;
    }
  }
  return true;
}

// low_key, high_key: keys that determine the lowest and the highest corner.
void check_in_domain(const Case& checked, const Point& low, const Point& high, const std::string& table,
                     const std::string& low_key, const std::string& high_key, Reading& reading) {
  const Grid& grid = checked.grid;
  if (!reading.are_valid({"grid.min", "grid.max"})) {
    return;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(checked.general.dimension); ++a) {
    if (low[a] < grid.min[a] || high[a] > grid.max[a]) {
      const bool is_low = low[a] < grid.min[a];
      reading.report({is_low ? low_key : high_key, is_low ? "grid.min" : "grid.max"},
                     "{} reaches from {} to {}, outside the domain, which is {} to {}; move the body, or "
                     "widen grid.min and grid.max.",
                     table, point_text(low, checked.general.dimension), point_text(high, checked.general.dimension),
                     point_text(grid.min, checked.general.dimension), point_text(grid.max, checked.general.dimension));
      return;
    }
  }
}

void report_below_ground(const Case& checked, double x, double height, double ground, const std::string& table,
                         const std::string& key, Reading& reading) {
  const char* const height_key = checked.terrain.kind == TerrainKind::profile ? "terrain.file" : "terrain.elevation";
  reading.report({key, height_key, "terrain.slope", "terrain.type"},
                 "{} is below the terrain: at x = {} m its elevation is {} m and the ground's {} m; "
                 "allowed: on the ground or above it. Lift the body, or lower the terrain.",
                 table, coordinate_text(x), coordinate_text(height), coordinate_text(ground));
}

void check_box(const Case& checked, const ProfileTable& profile, const Body& body, const std::string& table,
               Reading& reading) {
  const int dimension = checked.general.dimension;
  if (!check_box_order(body.min, body.max, table, dimension, reading)) {
    return;
  }
  check_in_domain(checked, body.min, body.max, table, table + ".min", table + ".max", reading);
  const double bottom = body.min[static_cast<std::size_t>(dimension - 1)];
  std::vector<double> stations{body.min[0], body.max[0]};
  for (const double x : profile.distance) {
    if (x > body.min[0] && x < body.max[0]) {
      stations.push_back(x);
    }
  }
  for (const double x : stations) {
    const double ground = ground_at(checked, profile, x);
    if (bottom < ground - rounding_depth * checked.grid.cell) {
      report_below_ground(checked, x, bottom, ground, table, table + ".min", reading);
      return;
    }
  }
}

using Vertex = std::array<double, 2>;
using Vertices = std::vector<Vertex>;

// Twice the signed area of a triangle.
double turn(const Vertex& a, const Vertex& b, const Vertex& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// True if the segments ab and cd cross at a point inside both.
bool cross(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  return turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
}

// Checks that the polygon encloses one area once; `size` is its maximum extent.
bool check_outline(const Vertices& vertices, double size, const std::string& key, Reading& reading) {
  const std::size_t count = vertices.size();
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t k = j + 2; k < count; ++k) {
      if (cross(vertices[j], vertices[j + 1], vertices[k], vertices[(k + 1) % count])) {
        reading.report({key},
                       "{} make sides that cross: the one after vertex {} and the one after vertex {}; "
                       "allowed: corners in order around the body. Put them in order.",
                       key, j + 1, k + 1);
        return false;
      }
    }
  }
  double twice_area = 0.0;
  for (std::size_t k = 1; k + 1 < vertices.size(); ++k) {
    twice_area += turn(vertices[0], vertices[k], vertices[k + 1]);
  }
  if (std::abs(twice_area) <= flat * size * size) {
    reading.report({key},
                   "{} are {} points that hold no area; allowed: at least 3 that are not on one line. "
                   "Give the corners in order around the body.",
                   key, vertices.size());
    return false;
  }
  return true;
}

// Points of a side that may lie deepest in the ground: its first end, and the profile points along it.
Vertices low_points(const ProfileTable& profile, const Vertex& a, const Vertex& b) {
  Vertices points{a};
  for (const double x : profile.distance) {
    if ((x - a[0]) * (x - b[0]) < 0.0) {
      points.push_back({x, a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1])});
    }
  }
  return points;
}

void check_polygon(const Case& checked, const ProfileTable& profile, const Body& body, const std::string& table,
                   Reading& reading) {
  const std::string key = table + ".vertices";
  if (!reading.are_valid({key})) {
    return;
  }
  const Vertices& vertices = body.vertices;
  Point low{INFINITY, INFINITY, 0.0}, high{-INFINITY, -INFINITY, 0.0};
  for (const Vertex& vertex : vertices) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], vertex[axis]);
      high[axis] = std::max(high[axis], vertex[axis]);
    }
  }
  if (!check_outline(vertices, std::max(high[0] - low[0], high[1] - low[1]), key, reading)) {
    return;
  }
  check_in_domain(checked, low, high, table, key, key, reading);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    for (const Vertex& point : low_points(profile, vertices[k], vertices[(k + 1) % vertices.size()])) {
      const double ground = ground_at(checked, profile, point[0]);
      if (point[1] < ground - rounding_depth * checked.grid.cell) {
        report_below_ground(checked, point[0], point[1], ground, table, key, reading);
        return;
      }
    }
  }
}

// Bounding box of the body on a profile, which thins out to the rows next to it. Empty if it is nowhere higher.
std::array<Point, 2> surface_extent(const ProfileTable& profile) {
  Point low{INFINITY, INFINITY, 0.0}, high{-INFINITY, -INFINITY, 0.0};
  const std::size_t rows = profile.distance.size();
  for (std::size_t k = 0; k < rows; ++k) {
    if (!(profile.surface[k] > profile.terrain[k])) {
      continue;
    }
    for (std::size_t near = k == 0 ? 0 : k - 1; near < std::min(k + 2, rows); ++near) {
      low = {std::min(low[0], profile.distance[near]), std::min(low[1], profile.terrain[near]), 0.0};
      high = {std::max(high[0], profile.distance[near]), std::max(high[1], profile.surface[near]), 0.0};
    }
  }
  return {low, high};
}

void check_surface(const Case& checked, const ProfileTable& profile, const std::string& table, Reading& reading) {
  const std::string shape = table + ".shape";
  if (checked.terrain.kind != TerrainKind::profile) {
    reading.report({shape, "terrain.type"},
                   "{}.shape is \"surface\", and terrain.type is not \"profile\"; that shape takes the body from the "
                   "profile's surface_elevation_m. Set terrain.type and terrain.file, or use the shape \"box\" or "
                   "\"polygon\".",
                   table);
  }
  if (profile.empty()) {
    return;
  }
  if (profile.surface.empty()) {
    reading.report({shape, "terrain.file"},
                   "{}.shape is \"surface\", and the profile has no column surface_elevation_m; add it to {}, or use "
                   "the shape \"box\" or \"polygon\".",
                   table, checked.terrain.file);
  } else if (const auto [low, high] = surface_extent(profile); low[0] < high[0]) {
    check_in_domain(checked, low, high, table, shape, shape, reading);
  } else {
    reading.report({shape, "terrain.file"},
                   "{}.shape is \"surface\", and surface_elevation_m is nowhere above the terrain in {}: the body "
                   "holds nothing. Raise the surface there, or use the shape \"box\" or \"polygon\".",
                   table, checked.terrain.file);
  }
}

void check_release_time(const Case& checked, const Body& body, const std::string& table, Reading& reading) {
  const std::string key = table + ".release_time";
  if (!reading.are_valid({key, "time.end"})) {
    return;
  }
  const ReleaseTime& release = body.release_time;
  if (!release.attribute.empty() && (body.shape != BodyShape::release || body.release.empty())) {
    reading.report({key},
                   "{} is the attribute \"{}\", and the body has no release polygons. Give the time in "
                   "seconds, or the polygons as {}.release.",
                   key, release.attribute, table);
    return;
  }
  const bool is_staged = release.number > 0.0 || !release.attribute.empty();
  reading.refuse_if(
      release.number >= checked.time.end, {key, "time.end"},
      "{} is {} s, and time.end is {} s: the body would be held for the whole run. Set an earlier time, or "
      "a later time.end.",
      key, release.number, checked.time.end);
  if (is_staged && reading.are_valid({table + ".velocity"}) && body.velocity != Point{}) {
    reading.report({table + ".velocity", key},
                   "{}.velocity is {}, and {} holds the body at rest until its release. Remove one.", table,
                   point_text(body.velocity, checked.general.dimension), key);
  }
}

void check_body(const Case& checked, const ProfileTable& profile, const std::string& name, const Body& body,
                Reading& reading) {
  const std::string table = "body." + name;
  check_material(checked, table, body.material, reading);
  check_release_time(checked, body, table, reading);
  if (!reading.are_valid({table + ".shape", "grid.cell"}) || body.shape == BodyShape::release) {
    return;
  }
  if (body.shape != BodyShape::box && checked.general.dimension == 3) {
    reading.report({table + ".shape", "case.dimension"},
                   "{}.shape is for 2D cases; allowed in 3D: \"box\", \"release\". Use the shape \"box\" with min and "
                   "max, or on a DEM the shape \"release\".",
                   table);
  } else if (body.shape == BodyShape::box) {
    check_box(checked, profile, body, table, reading);
  } else if (body.shape == BodyShape::polygon) {
    check_polygon(checked, profile, body, table, reading);
  } else {
    check_surface(checked, profile, table, reading);
  }
}

// A frame may extend out of the domain, but must meet it at some time of the run.
void check_frame_meets_domain(const Case& checked, const Frame& frame, const std::string& table, Reading& reading) {
  const int dimension = checked.general.dimension;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    const double displacement = frame.axis == axis_names[a] ? frame.velocity * checked.time.end : 0.0;
    const double low = frame.min[a] + std::min(0.0, displacement);
    const double high = frame.max[a] + std::max(0.0, displacement);
    if (high <= checked.grid.min[a] || low >= checked.grid.max[a]) {
      reading.report({table + ".min", table + ".velocity", "grid.min", "grid.max", "time.end"},
                     "{} reaches from {} to {} and stays outside the domain, which is {} to {}, until time.end; move "
                     "the frame, or widen grid.min and grid.max.",
                     table, point_text(frame.min, dimension), point_text(frame.max, dimension),
                     point_text(checked.grid.min, dimension), point_text(checked.grid.max, dimension));
      return;
    }
  }
}

void check_frame(const Case& checked, const std::string& name, const Frame& frame, Reading& reading) {
  const std::string table = "frame." + name;
  const bool ordered = check_box_order(frame.min, frame.max, table, checked.general.dimension, reading);
  if (ordered && reading.are_valid({"grid.min", "grid.max", "time.end", table + ".axis", table + ".velocity"})) {
    check_frame_meets_domain(checked, frame, table, reading);
  }
  reading.refuse_if(frame.axis == "z" && checked.general.dimension == 2, {table + ".axis"},
                    "{}.axis is \"z\" in a 2D case; allowed: \"x\" or \"y\". Up is \"y\" there.", table);
}

}  // namespace

void check_bodies(const Case& checked, const ProfileTable& profile, Reading& reading) {
  if (checked.bodies.empty() && reading.are_valid({"body"})) {
    reading.report({"body"}, "the case has no body; add a table [body.NAME] with its material and shape.");
  }
  for (const auto& [name, body] : checked.bodies) {
    check_body(checked, profile, name, body, reading);
  }
  for (const auto& [name, frame] : checked.frames) {
    check_frame(checked, name, frame, reading);
  }
}

}  // namespace thawslide::config
