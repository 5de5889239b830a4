#include "sim/records/run_records.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "band/basal_segments.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/state_numbers.hpp"
#include "device/solver.hpp"
#include "sim/setup/release_body.hpp"

namespace thawslide::sim {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Half sizes of particles by body [m].
template <int Dim>
std::vector<double> half_sizes(const Simulation<Dim>& simulation) {
  std::vector<double> halves;
  for (std::size_t body = 0; body < simulation.model().body_names.size(); ++body) {
    halves.push_back(simulation.model().motion.sizes.half(body) * simulation.grid().cell());
  }
  return halves;
}

// Elevation of the highest point of each body [m].
std::vector<double> highest_points(const Simulation<3>& simulation) {
  const auto& particles = simulation.particles();
  const std::vector<double> halves = half_sizes(simulation);
  std::vector<double> highest(halves.size(), -HUGE_VAL);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto body = static_cast<std::size_t>(particles.body(p));
    highest[body] = std::max(highest[body], particles.position(p, 2) + halves[body] + simulation.model().origin[2]);
  }
  return highest;
}

// Corners that bound each body at the start: release outlines, raster cells of releases, and boxes.
std::vector<config::Polyline2> corners_at_start(const config::Case& parameters,
                                                const std::map<std::string, config::Release>& releases) {
  std::vector<config::Polyline2> of_bodies;
  for (const auto& [name, body] : parameters.bodies) {
    config::Polyline2& corners = of_bodies.emplace_back();
    const auto release = releases.find(name);
    if (release == releases.end()) {
      for (const double x : {body.min[0], body.max[0]}) {
        for (const double y : {body.min[1], body.max[1]}) {
          corners.push_back({x, y});
        }
      }
      continue;
    }
    corners = corners_of(release->second);
  }
  return of_bodies;
}

}  // namespace

double angle_of_reach(double drop_height, double travel_distance) {
  constexpr double degrees_per_radian = 57.29577951308232;
  return travel_distance > 0.0 ? degrees_per_radian * std::atan2(drop_height, travel_distance) : unknown;
}

std::vector<std::pair<std::string, double>> named(const RunFigures& figures) {
  return {{"covered_volume_m3", figures.covered_volume},  {"covered_area_m2", figures.covered_area},
          {"affected_area_m2", figures.affected_area},    {"deposit_area_m2", figures.deposit_area},
          {"inundated_area_m2", figures.inundated_area},  {"front_distance_m", figures.front_distance},
          {"travel_distance_m", figures.travel_distance}, {"drop_height_m", figures.drop_height},
          {"reach_angle_degrees", figures.reach_angle}};
}

template <int Dim>
RunRecords<Dim>::RunRecords(const Simulation& simulation, const config::Site& site)
    : centre_path_(simulation.parameters().grid.cell) {
  if constexpr (Dim == 3) {
    given_ = PathLine(site.path);
    path_given_ = !site.path.empty();
    const config::Case& parameters = simulation.parameters();
    const MapGrid map_grid = map_grid_of(parameters, site);
    const auto& origin = simulation.model().origin;
    maps_.emplace(map_grid, std::array<double, 2>{origin[0], origin[1]}, half_sizes(simulation),
                  parameters.maps.arrival_thickness, DrawnArea(parameters, site.releases, map_grid));
    probes_ = Probes(parameters, site.probes, map_grid);
    corners_at_start_ = corners_at_start(parameters, site.releases);
    tops_at_start_.resize(simulation.model().body_names.size());
    if (path_given_ && given_.empty()) {
      throw UserError(fmt::format("{}: the path has no length; allowed: a line of at least two different points.",
                                  config::location_of(parameters, "maps.path")));
    }
  }
}

template <int Dim>
void RunRecords<Dim>::start(const Simulation& simulation) {
  if constexpr (Dim == 3) {
    maps_->start(*simulation.sample_map(maps_->cells()));
    add_to_path(simulation, simulation.sum_over_particles(mpm::MomentsOfParticle{}));
    tops_at_start_ = highest_points(simulation);
  }
}

template <int Dim>
void RunRecords<Dim>::after_step(const Simulation& simulation) {
  if constexpr (Dim == 3) {
    const band::MapSample& sample = *simulation.sample_map(maps_->cells());
    const double mass = std::accumulate(sample.sums.begin(), sample.sums.end(), 0.0,
                                        [](double sum, const mpm::MapSums& cell) { return sum + cell.column.mass; });
    const mpm::MassMoments moments = simulation.sum_over_particles(mpm::MomentsOfParticle{});
    THAWSLIDE_ASSERT(std::abs(mass - moments.mass) <= round_off * moments.mass,
                     "{} kg of {} kg lie over map cells that particles may reach", mass, moments.mass);
    maps_->gather(sample, simulation.time());
    add_to_path(simulation, moments);
  }
}

template <int Dim>
void RunRecords<Dim>::slide_left() {
  if (maps_) {
    maps_->slide_left();
  }
}

// Adds the centre of mass in the horizontal plane.
template <int Dim>
void RunRecords<Dim>::add_to_path(const Simulation& simulation, const mpm::MassMoments& sums) {
  if (!path_given_) {
    const auto& origin = simulation.model().origin;
    centre_path_.add_position({sums.mass_x / sums.mass + origin[0], sums.mass_y / sums.mass + origin[1]});
  }
}

template <int Dim>
NamedNumbers RunRecords<Dim>::state() const {
  if (!maps_) {
    return {};
  }
  return {{"maps", maps_->state()}, {"centre_path", centre_path_.state()}, {"tops_at_start", tops_at_start_}};
}

template <int Dim>
void RunRecords<Dim>::restore(const NamedNumbers& blocks) {
  if (maps_) {
    maps_->restore(block_of(blocks, "maps"));
    centre_path_.restore(block_of(blocks, "centre_path"));
    StateNumbers tops(block_of(blocks, "tops_at_start"), "bodies' tops");
    for (double& top : tops_at_start_) {
      top = tops.next();
    }
  }
}

template <int Dim>
std::optional<Front> RunRecords<Dim>::front(const Simulation& simulation) const {
  if (path().empty() || simulation.particle_count() == 0 || simulation.device_has_failed()) {
    return {};
  }
  const MovedMass moved = simulation.moved_mass();
  const mpm::PathSample foremost = simulation.front(moved, path().view());
  double rear = HUGE_VAL, top = -HUGE_VAL;
  for (std::size_t body = 0; body < corners_at_start_.size(); ++body) {
    if (moved.has(body)) {
      for (const Point2& corner : corners_at_start_[body]) {
        rear = std::min(rear, path().project(corner).along);
      }
      top = std::max(top, tops_at_start_[body]);
    }
  }
  return Front{foremost.along, foremost.position, foremost.along - rear, top};
}

template <int Dim>
HistoryRow RunRecords<Dim>::history_row(const Simulation& simulation) const {
  if (!maps_) {
    return sim::history_row(simulation);
  }
  const std::optional<Front> foremost = front(simulation);
  return sim::history_row(simulation,
                          foremost ? FrontInRow{foremost->along, foremost->travelled} : FrontInRow{unknown, unknown});
}

template <int Dim>
HistoryRow RunRecords<Dim>::probe_row(const Simulation& simulation) const {
  return maps_ && !probes_.empty() ? probes_.row(*maps_, simulation.time()) : HistoryRow{};
}

template <int Dim>
std::optional<RunFigures> RunRecords<Dim>::figures(
    const Simulation& simulation, const std::function<double(double x, double y)>& ground_height) const {
  if (!maps_) {
    return {};
  }
  const double arrival = maps_->arrival_thickness();
  const double least = simulation.parameters().maps.area_thickness;
  RunFigures figures{maps_->covered_volume(arrival),
                     maps_->covered_cells(arrival).area(),
                     maps_->affected_cells(arrival).area(),
                     maps_->covered_cells(least).area(),
                     maps_->affected_cells(least).area(),
                     unknown,
                     unknown,
                     unknown,
                     unknown};
  if (const std::optional<Front> foremost = front(simulation)) {
    figures.front_distance = foremost->along;
    figures.travel_distance = foremost->travelled;
    figures.drop_height = foremost->top - ground_height(foremost->position[0], foremost->position[1]);
    figures.reach_angle = angle_of_reach(figures.drop_height, figures.travel_distance);
  }
  return figures;
}

template class RunRecords<2>;
template class RunRecords<3>;

}  // namespace thawslide::sim
