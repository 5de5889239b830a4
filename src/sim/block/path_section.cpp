#include "sim/block/path_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/table.hpp"
#include "sim/block/section.hpp"
#include "sim/maps/path_line.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/setup/substrates.hpp"
#include "terrain/height_field.hpp"

namespace thawslide::sim {

namespace {

constexpr double margin_cells = 4.0;  // of the domain around ground and release
constexpr double step_width = 1e-6;   // fraction of a cell over which the thickness rises at the release's ends

// Calls visit(x, y, thickness) for points of positive thickness.
template <class Visit>
void for_points(const Raster& thickness, const Visit& visit) {
  config::for_points_of_release(thickness, [&](int column, int row) {
    visit(thickness.x_of(column), thickness.y_of(row), thickness.at(column, row));
  });
}

// Release projected onto the path.
struct ReleaseOnPath {
  double from = HUGE_VAL, to = -HUGE_VAL;  // distances along the path [m]
  double nearest = HUGE_VAL;               // of its points to the path [m]
  double middle = 0.0;                     // of the volume, along the path [m]
  double width = 0.0, cross_area = 0.0;    // mean values across the path [m, m2]
  Table thickness;                         // mean across the path [m], over the distance

  [[nodiscard]] double at(double along) const { return along < from || along > to ? 0.0 : thickness.at(along); }
};

// length: averaging length of thicknesses [m].
ReleaseOnPath release_on_path(const PathLine& line, const config::Release& release, double length) {
  struct Point {
    double along, thickness;
  };
  std::vector<Point> points;
  ReleaseOnPath found;
  double sum = 0.0;
  for_points(release.thickness, [&](double x, double y, double thickness) {
    const LinePosition position = line.project({x, y});
    points.push_back({position.along, thickness});
    found.from = std::min(found.from, position.along);
    found.to = std::max(found.to, position.along);
    found.nearest = std::min(found.nearest, std::abs(position.offset));
    found.middle += thickness * position.along;
    sum += thickness;
  });
  THAWSLIDE_ASSERT(!points.empty(), "a release of {} x {} points without a thickness", release.thickness.columns,
                   release.thickness.rows);
  found.middle /= sum;
  const double half = 0.5 * std::min(release.thickness.cell_x, release.thickness.cell_y);
  found.from -= half;
  found.to += half;
  found.width = release.area / (found.to - found.from);
  found.cross_area = sum * release.thickness.cell_x * release.thickness.cell_y / (found.to - found.from);
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round((found.to - found.from) / length)));
  const double width = (found.to - found.from) / static_cast<double>(count);
  std::vector<double> thickness(count, 0.0), number(count, 0.0);
  for (const Point& point : points) {
    const auto k = std::min(count - 1, static_cast<std::size_t>((point.along - found.from) / width));
    thickness[k] += point.thickness;
    number[k] += 1.0;
  }
  // Points on the outline represent less than a cell each. This factor makes the areas sum to the release's area.
  const double fraction =
      release.area / (static_cast<double>(points.size()) * release.thickness.cell_x * release.thickness.cell_y);
  std::vector<double> middles;
  for (std::size_t k = 0; k < count; ++k) {
    middles.push_back(found.from + (static_cast<double>(k) + 0.5) * width);
    thickness[k] = number[k] > 0.0 ? thickness[k] / (number[k] * fraction) : 0.0;
  }
  found.thickness = Table(std::move(middles), std::move(thickness));
  return found;
}

// Reduces a field to the block's form: a number, or a table over depth.
void make_plain(InitialField& field, const std::string& key, const config::Release& release) {
  double volume = 0.0, sum = 0.0, east = 0.0;
  for_points(release.thickness, [&](double x, double y, double thickness) {
    volume += thickness;
    east += thickness * x;
    sum += field.is_map() ? thickness * nearest_value(release.fields.at(key), x, y) : 0.0;
  });
  if (field.is_map()) {
    field = InitialField(sum / volume);
  } else if (field.over == InitialField::Over::x) {
    field = InitialField(field.at(0.0, east / volume));
  }
}

// Extent of the whole release along the path, and its highest point, as in a run of the case.
BlockStart start_of(const PathLine& line, const config::Release& release, const Raster& ground) {
  BlockStart start{HUGE_VAL, -HUGE_VAL, top_of(release, ground)};
  for (const Point2& corner : corners_of(release)) {
    const double along = line.project(corner).along;
    start.from = std::min(start.from, along);
    start.to = std::max(start.to, along);
  }
  return start;
}

void require_section(const config::Case& parameters) {
  require_one_body(parameters);
  const auto& [name, body] = *parameters.bodies.begin();
  if (body.shape != config::BodyShape::release) {
    throw UserError(
        fmt::format("{}: on a DEM the block model slides a body of the shape \"release\". Give body.{} "
                    "polygons or a raster, or use `thawslide run`.",
                    config::location_of(parameters, fmt::format("body.{}.shape", name)), name));
  }
  if (parameters.general.gravity_tilt != 0.0) {
    throw UserError(
        fmt::format("{}: case.gravity_tilt is {} degrees towards +x, which a section along a path does not "
                    "know. Set it to 0, or use `thawslide run`.",
                    config::location_of(parameters, "case.gravity_tilt"), parameters.general.gravity_tilt));
  }
}

Point2 centre_of(const config::Release& release) {
  Point2 centre{0.0, 0.0};
  double sum = 0.0;
  for_points(release.thickness, [&](double x, double y, double thickness) {
    centre = {centre[0] + thickness * x, centre[1] + thickness * y};
    sum += thickness;
  });
  return {centre[0] / sum, centre[1] / sum};
}

// Line of steepest descent from the release's centre.
Descent descent_from(const config::Case& parameters, const config::Release& release, const Raster& ground) {
  const Point2 centre = centre_of(release);
  const double width = std::max(parameters.grid.cell, 2.0 * std::max(ground.cell_x, ground.cell_y));
  Descent descent = steepest_descent(ground, centre, width);
  if (descent.line.empty()) {
    throw UserError(
        fmt::format("{}: no downhill path starts at the centre of the release, x = {}, y = {}: over {:g} m the terrain "
                    "is {} there. Set maps.path to a file with a line from the release along the expected flow path.",
                    config::location_of(parameters, "maps"), coordinate_text(centre[0]), coordinate_text(centre[1]),
                    width, descent.pit ? "level or a pit" : "partly without data"));
  }
  return descent;
}

// Stations of the path, and the ends of the full release thickness.
std::vector<double> stations_about(const PathLine& line, const ReleaseOnPath& release, double cell, double spacing) {
  const double begin = std::floor(release.from / cell - margin_cells) * cell;
  const double end = std::max(line.length(), release.to + margin_cells * cell);
  std::vector<double> stations = stations_along(line, begin, end, spacing);
  const double step = step_width * cell;
  // Stations closer to the release's ends than the step width would coincide with them after a change of coordinates.
  const auto at_an_end = [&](double station) {
    return std::min(std::abs(station - release.from), std::abs(station - release.to)) < 2.0 * step;
  };
  stations.erase(std::remove_if(stations.begin(), stations.end(), at_an_end), stations.end());
  stations.insert(stations.end(), {release.from - step, release.from, release.to, release.to + step});
  std::sort(stations.begin(), stations.end());
  return stations;
}

// Substrate stretches below the path, from one midpoint between stations to the next.
std::vector<config::SubstrateStretch> stretches_along(const config::Case& parameters, const config::Site& site,
                                                      const PathLine& line, const std::vector<double>& stations) {
  std::vector<config::SubstrateStretch> stretches;
  const auto substrates = make_substrates(parameters, site);
  std::vector<std::string> names{""};
  for (const auto& [name, substrate] : parameters.substrates) {
    names.push_back(name);
  }
  for (std::size_t k = 0; substrates && k < stations.size(); ++k) {
    const Point2 point = line.point_at(stations[k]);
    const int number = substrates->at(point[0] - parameters.grid.min[0], point[1] - parameters.grid.min[1]);
    const double from = k == 0 ? -HUGE_VAL : 0.5 * (stations[k - 1] + stations[k]);
    const double to = k + 1 == stations.size() ? HUGE_VAL : 0.5 * (stations[k] + stations[k + 1]);
    if (number == 0) {
      continue;
    }
    const std::string& name = names[static_cast<std::size_t>(number)];
    if (!stretches.empty() && stretches.back().name == name && stretches.back().to == from) {
      stretches.back().to = to;
    } else {
      stretches.push_back({name, from, to});
    }
  }
  return stretches;
}

void set_domain(config::Grid& grid, const config::ProfileTable& profile) {
  const auto [lowest, unused] = std::minmax_element(profile.terrain.begin(), profile.terrain.end());
  const double highest = *std::max_element(profile.surface.begin(), profile.surface.end());
  const double cells = std::ceil((profile.distance.back() - profile.distance.front()) / grid.cell);
  grid.min = {profile.distance.front(), (std::floor(*lowest / grid.cell) - margin_cells) * grid.cell, 0.0};
  grid.max = {grid.min[0] + cells * grid.cell, (std::ceil(highest / grid.cell) + margin_cells) * grid.cell, 0.0};
  grid.boundary = {};
}

// Angle between the path and the steepest descent at a distance along it [degrees]; 0 on level or unknown ground.
double off_steepest(const PathLine& line, double along, const Raster& ground, double width) {
  const Point2 point = line.point_at(along), before = line.point_at(along - 0.5 * width),
               after = line.point_at(along + 0.5 * width);
  const Vector<double, 2> middle(point[0], point[1]), half = Vector<double, 2>::Constant(0.5 * width),
                                                      direction(after[0] - before[0], after[1] - before[1]);
  const terrain::HeightField field(ground);
  if (!field.is_known(middle - half, middle + half)) {
    return 0.0;
  }
  const Vector<double, 2> descent = -field.gradient(middle, width);
  return std::abs(std::atan2(direction[0] * descent[1] - direction[1] * descent[0], direction.dot(descent))) *
         (180.0 / std::numbers::pi);
}

}  // namespace

PathSection section_along_path(const config::Case& parameters, const config::Site& site) {
  require_section(parameters);
  const auto& [name, given] = *parameters.bodies.begin();
  const config::Release& release = site.releases.at(name);
  const Raster& ground = *site.ground;
  PathSection section;
  section.path_given = !site.path.empty();
  const Descent descent =
      section.path_given ? Descent{PathLine(site.path), {}} : descent_from(parameters, release, ground);
  const PathLine& line = descent.line;
  if (line.empty()) {
    throw UserError(fmt::format("{}: the path has no length; allowed: a line of at least two different points.",
                                config::location_of(parameters, "maps.path")));
  }
  const std::string source =
      section.path_given ? config::location_of(parameters, "maps.path")
                         : fmt::format("{}: the line of steepest descent", config::location_of(parameters, "maps"));
  const double points_apart = std::min(ground.cell_x, ground.cell_y), cell = parameters.grid.cell;
  const ReleaseOnPath on_path = release_on_path(line, release, std::max(cell, 2.0 * points_apart));
  if (on_path.nearest > std::max(ground.cell_x, ground.cell_y)) {
    throw UserError(
        fmt::format("{}: the path misses the release of body '{}' by {:.0f} m. Draw it through the release.", source,
                    name, on_path.nearest));
  }
  if (descent.pit && line.length() < on_path.to) {
    throw UserError(
        fmt::format("{} from the centre of the release ends in a pit at x = {}, y = {}, below the release. Set "
                    "maps.path to a file with a line from the release along the expected flow path.",
                    source, coordinate_text((*descent.pit)[0]), coordinate_text((*descent.pit)[1])));
  }
  if (descent.pit) {
    section.pit = PathSection::Pit{line.length(), *descent.pit};
  }

  section.off_steepest = off_steepest(line, on_path.middle, ground, std::max(cell, 2.0 * points_apart));

  config::ProfileTable& profile = section.site.profile;
  profile.distance = stations_about(line, on_path, cell, 0.5 * points_apart);
  profile.terrain = ground_along(line, profile.distance, ground);
  require_known(line, profile.distance, profile.terrain, on_path.to + cell, ground, source);
  const auto known =
      std::find_if(profile.terrain.begin(), profile.terrain.end(), [](double z) { return std::isnan(z); });
  profile.terrain.erase(known, profile.terrain.end());
  profile.distance.resize(profile.terrain.size());
  for (std::size_t k = 0; k < profile.distance.size(); ++k) {
    profile.surface.push_back(profile.terrain[k] + on_path.at(profile.distance[k]));
  }

  section.valley_factor =
      Table(profile.distance, valley_factors(line, profile.distance, ground,
                                             {on_path.width, on_path.cross_area, std::max(0.5 * cell, points_apart)}));
  section.start = start_of(line, release, ground);
  section.site.stretches = stretches_along(parameters, site, line, profile.distance);

  section.parameters = parameters;
  config::Case& flat = section.parameters;
  flat.general.dimension = 2;
  flat.terrain = {};
  flat.terrain.kind = config::TerrainKind::profile;
  set_domain(flat.grid, profile);
  flat.heat.boundary = {};
  flat.frames.clear();
  flat.probes.clear();
  config::Body& body = flat.bodies.begin()->second;
  body.shape = config::BodyShape::surface;
  if (!body.release_time.attribute.empty()) {
    body.release_time = {release.release_time, {}};
  }
  make_plain(body.temperature, "temperature", release);
  make_plain(body.saturation, "saturation", release);
  make_plain(body.porosity, "porosity", release);
  make_plain(body.ice_content, "ice_content", release);
  const Point2 here = line.point_at(on_path.middle), ahead = line.point_at(on_path.middle + points_apart);
  const double east = (ahead[0] - here[0]) / points_apart, north = (ahead[1] - here[1]) / points_apart;
  body.velocity = {given.velocity[0] * east + given.velocity[1] * north, given.velocity[2], 0.0};
  return section;
}

}  // namespace thawslide::sim
