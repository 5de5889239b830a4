// Rigid-block model: the same case without deformation. The body is cut into vertical slices that keep their
// arrangement and slide along the terrain. Below it, one column of particle rows carries temperature and pore pressure
// of the band, computed by the stages of the MPM step. The rows lie where MPM particles lie on flat ground, so both
// models agree on a plane aligned with the grid. The model omits deformation, variation of the band along the base,
// and, unless block.bends is on, the pressure due to curvature of the path. A 3D case on a DEM is reduced to the
// section along a path (path_section.hpp).
#pragma once

#include <optional>

#include "base/table.hpp"
#include "config/site.hpp"
#include "sim/records/history.hpp"

namespace thawslide::sim {

// Throws UserError if the case has more than one body.
void require_one_body(const config::Case& parameters);

// Extent of a slide at t = 0, from which travel distance and drop height are measured.
struct BlockStart {
  double from, to;  // x coordinates of its ends [m]
  double top;       // height of its highest point, against gravity [m]
};

// Runs the case as a rigid block until time.end, with the fixed step of the case or the limit of the adaptive one.
// Returns one row per time.history_interval (0: each step), beginning with the state at t = 0, with the
// columns of block_columns() (records/output_columns.hpp). site: contains the profile of a section. valley_factor: over
// x. start: by default that of the particles, which is not that of a release wider than its section. Throws UserError
// for a case without terrain, with more than one body, or with a step above a limit.
std::vector<HistoryRow> run_block(const config::Case& parameters, const config::Site& site = {},
                                  Table valley_factor = Table(1.0), const std::optional<BlockStart>& start = {});

}  // namespace thawslide::sim
