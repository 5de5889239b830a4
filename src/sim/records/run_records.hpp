// Records of a 3D run after every step, in addition to its history: maps, path of the centre of mass, probes; its key
// figures. All are empty in 2D.
#pragma once

#include <cmath>
#include <functional>
#include <optional>

#include "base/state_numbers.hpp"
#include "config/site.hpp"
#include "sim/maps/flow_maps.hpp"
#include "sim/maps/path_line.hpp"
#include "sim/maps/probes.hpp"
#include "sim/records/history.hpp"

namespace thawslide::sim {

// Reach angle [degrees], atan(H/L): slope of the straight line from the highest point of the release to the front of
// the slide, which is H [m] lower and L [m] away (the Fahrboeschung of Heim 1932). NaN at zero distance.
[[nodiscard]] double angle_of_reach(double drop_height, double travel_distance);

struct RunFigures {
  double covered_volume = 0.0;   // current, of cells thicker than maps.arrival_thickness [m3]
  double covered_area = 0.0;     // horizontal, of the same cells (sim/maps/covered_area.hpp) [m2]
  double affected_area = 0.0;    // covered at any time [m2]
  double deposit_area = 0.0;     // of cells now thicker than maps.area_thickness [m2]
  double inundated_area = 0.0;   // of cells ever thicker than it [m2]
  double front_distance = 0.0;   // of the front, along the path from its first corner [m]
  double travel_distance = 0.0;  // horizontal, along the path, from the release's rear end to the front [m]
  double drop_height = 0.0;      // of the ground at the front below the highest point of the release [m]
  double reach_angle = 0.0;      // [degrees]
};

// Name with unit and value, as in run.json.
[[nodiscard]] std::vector<std::pair<std::string, double>> named(const RunFigures& figures);

// Front of a 3D slide.
struct Front {
  double along;      // arc length of the path that has 99.5 % of the mass behind it [m]
  Point2 position;   // of the particle at the front [m]
  double travelled;  // distance along the path from the rear end of the same bodies at t = 0 [m]
  double top;        // elevation of the highest point of these bodies at t = 0 [m]
};

// Elevation of the ground of a simulation at x, y, all in the case's coordinates [m]; NaN without terrain. The
// simulation must outlive it.
template <int Dim>
[[nodiscard]] std::function<double(double x, double y)> ground_height_of(const Simulation<Dim>& simulation) {
  return [&model = simulation.model()](double x, double y) {
    typename terrain::Surface<Dim>::Point point;
    point[0] = x - model.origin[0];
    if constexpr (Dim == 3) {
      point[1] = y - model.origin[1];
    }
    return model.ground ? model.ground->height(point) + model.origin[Dim - 1] : std::nan("");
  };
}

template <int Dim>
class RunRecords {
 public:
  using Simulation = sim::Simulation<Dim>;

  // Creates empty records for the simulation of a case on a site. Throws UserError for maps with too many cells, and
  // for probes outside the maps.
  RunRecords(const Simulation& simulation, const config::Site& site);

  // Records the state at t = 0, after initialization and settling.
  void start(const Simulation& simulation);
  // Records the state after a step.
  void after_step(const Simulation& simulation);
  // Clears the current maps after a step that removed the last of the slide.
  void slide_left();

  // State for checkpoints; restore() replaces start() on resume.
  [[nodiscard]] NamedNumbers state() const;
  void restore(const NamedNumbers& blocks);

  // Null in 2D.
  [[nodiscard]] const FlowMaps* maps() const { return maps_ ? &*maps_ : nullptr; }
  // Given path, or path of the centre of mass so far, with a corner per cell of the grid. Empty in 2D, and while the
  // centre has barely moved (CentrePath).
  [[nodiscard]] const PathLine& path() const { return path_given_ ? given_ : centre_path_.line(); }
  [[nodiscard]] bool path_given() const { return path_given_; }
  // Front of the mass that has moved, along the path; empty without a path, without particles, or after a device
  // failed.
  [[nodiscard]] std::optional<Front> front(const Simulation& simulation) const;
  // Row of the history. In 3D, front and runout are measured along the path: arc length, and its distance from the rear
  // end of the release; NaN while there is no front.
  [[nodiscard]] HistoryRow history_row(const Simulation& simulation) const;
  [[nodiscard]] bool has_probes() const { return !probes_.empty(); }
  // Current state; empty without probes.
  [[nodiscard]] HistoryRow probe_row(const Simulation& simulation) const;
  // Current state; empty in 2D. ground_height: elevation of the ground at x, y, all in the case's coordinates [m].
  // Quantities along the path are NaN while the path is empty.
  [[nodiscard]] std::optional<RunFigures> figures(const Simulation& simulation,
                                                  const std::function<double(double x, double y)>& ground_height) const;

 private:
  void add_to_path(const Simulation& simulation, const mpm::MassMoments& sums);

  std::optional<FlowMaps> maps_;
  PathLine given_;
  bool path_given_ = false;
  CentrePath centre_path_;
  Probes probes_;
  std::vector<config::Polyline2> corners_at_start_;  // by body
  std::vector<double> tops_at_start_;                // elevation of the highest point, by body [m]
};

}  // namespace thawslide::sim
