// Data exchanged between the run and a step on a device: model and host callbacks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "band/basal_segments.hpp"
#include "band/columns.hpp"
#include "band/parameters.hpp"
#include "device/step_sums.hpp"
#include "mpm/between_bodies.hpp"
#include "mpm/map_sums.hpp"
#include "mpm/mapping.hpp"
#include "mpm/node_conditions.hpp"
#include "mpm/parameters.hpp"
#include "mpm/records.hpp"
#include "mpm/section_width.hpp"
#include "mpm/tile.hpp"
#include "terrain/contact_stage.hpp"

namespace thawslide::device {

template <int Dim>
struct StepModel {
  double cell = 0;  // mesh size [m]
  mpm::Mapping mapping;
  terrain::ColumnChunks<Dim> columns;  // of nodes; only with ground
  std::vector<double> half_sizes;      // of particles, by body, in cells
  mpm::MotionParameters<Dim> motion;
  bool moves = true;  // off: heat and pore pressure only
  std::function<bool(double time, double dt)> filters_in_step;
  Vector<double, Dim> extent;  // upper corner of the domain [m]; the lower corner is the origin
  std::vector<mpm::NodeCondition<Dim>> conditions;
  mpm::SectionWidth width;
  mpm::BetweenBodies between_bodies;
  std::function<std::vector<std::uint8_t>(double time)> layers_of_bodies;  // by body; empty: all share nodes
  Vector<double, Dim> lower, upper;                                        // bounds of particle positions [m]
  bool finds_extremes = false;                                             // StepSums::extremes is required
  bool counts_escaped = false;                                             // StepSums::escapes is required
  terrain::ContactModel contact;
  bool starts = true;  // the next step is the first one, from t = 0
  double time = 0;     // at its beginning [s]
  band::BandParameters<Dim> band;
  std::vector<double> free_gaps;                      // as in band::FreeGaps
  std::function<double(double time)> band_thickness;  // [m]; 0: no band, xi = 1
  std::optional<band::ColumnsModel> band_columns;     // empty unless the band consists of columns
  band::SegmentsState<Dim> segments;                  // with columns, at `time`

  [[nodiscard]] bool has_band() const { return band.heat || band.pressure; }
};

// Returns the ground data of all nodes of a block, x fastest. The result is true if the ground is known everywhere
// below the block and within one cell around it. Empty without ground.
template <int Dim>
using GroundQuery = std::function<bool(std::uint64_t block, terrain::GroundAtNode<Dim>* nodes)>;

// CPU functions called, and data used, during a step.
template <int Dim>
struct HostCallbacks {
  GroundQuery<Dim> ground;
  // Heights of all columns of nodes [m] (terrain/following_ground.hpp). Empty without ground.
  std::function<std::vector<double>()> column_heights;
  // As in band/slide_columns.hpp. Without slope_cosine, thickness is vertical; normal_gravity is only needed for loads.
  band::OfPosition<Dim> slope_cosine, normal_gravity;
  band::OfPosition<Dim> width;       // relative; empty if uniform
  terrain::Bed<Dim>* bed = nullptr;  // erodible, on the CPU; null if there is none
};

}  // namespace thawslide::device
