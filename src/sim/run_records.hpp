// What a run in space gathers after every step beside its history: maps, the way of its centre of mass, probes. In 2D
// there is nothing to gather, and all of this is empty.
#pragma once

#include <functional>
#include <optional>

#include "base/named_numbers.hpp"
#include "config/site.hpp"
#include "sim/flow_maps.hpp"
#include "sim/history.hpp"
#include "sim/path_line.hpp"
#include "sim/probes.hpp"
#include "sim/run_figures.hpp"

namespace thawslide::sim {

// The front of a slide in space.
struct Front {
  double along;  // arc length of the path up to which 99.5 % of the mass has come [m]
  Place2 place;  // of the particle there [m]
};

template <int Dim>
class RunRecords {
 public:
  using Simulation = sim::Simulation<Dim, double>;

  // For the simulation of a case on a site; nothing is gathered yet. Throws UserError for maps of too many cells, and
  // for probes beside them.
  RunRecords(const Simulation& simulation, const config::Site& site);

  // At t = 0, with everything settled.
  void start(const Simulation& simulation);
  // After every step.
  void after_step(const Simulation& simulation);
  // After a step that none of the slide stayed on: nothing of it lies on the maps any more.
  void slide_left();

  // All that gathering goes on from, for a checkpoint; and its way back, in place of start().
  [[nodiscard]] NamedNumbers state() const;
  void restore(const NamedNumbers& blocks);

  // Null in 2D.
  [[nodiscard]] const FlowMaps* maps() const { return maps_ ? &*maps_ : nullptr; }
  // The given one, or the way of the centre of mass so far, a corner each cell of the grid; empty in 2D, and while the
  // centre has hardly moved (CentrePath).
  [[nodiscard]] const PathLine& path() const { return path_given_ ? given_ : centre_path_.line(); }
  [[nodiscard]] bool path_given() const { return path_given_; }
  // The front along the path; none where that is empty, no particle is left, or a device failed with them.
  [[nodiscard]] std::optional<Front> front(const Simulation& simulation) const;
  // A row of the history, in space with the front and the runout along the path: arc length, and how far that is from
  // the rear end of the release; NaN while there is no front.
  [[nodiscard]] HistoryRow history_row(const Simulation& simulation) const;
  [[nodiscard]] bool has_probes() const { return !probes_.empty(); }
  // Of the state now. Empty where there are no probes.
  [[nodiscard]] HistoryRow probe_row(const Simulation& simulation) const;
  // Of the state now; nothing in 2D. ground_height: elevation of the ground at x, y, all in the case's coordinates [m].
  // What is measured along the path is NaN while that is empty.
  [[nodiscard]] std::optional<RunFigures> figures(const Simulation& simulation,
                                                  const std::function<double(double x, double y)>& ground_height) const;

 private:
  void add_to_path(const Simulation& simulation, const mpm::MassMoments& sums);
  // Arc length of the path at which the release begins: the least of the corners between which it lies [m].
  [[nodiscard]] double rear_of_release() const;

  std::optional<FlowMaps> maps_;
  PathLine given_;
  bool path_given_ = false;
  CentrePath centre_path_;
  Probes probes_;
  config::Polyline2 corners_at_start_;  // of bodies
  double release_top_ = 0.0;            // elevation of the highest point of the slide at t = 0 [m]
};

}  // namespace thawslide::sim
