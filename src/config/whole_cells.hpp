// Domain of a case whose grid.cell was changed without its corners.
#pragma once

#include "config/case.hpp"
#include "config/reading.hpp"

namespace thawslide::config {

// Moves grid.max to whole cells if grid.cell is given elsewhere than grid.min and grid.max: by `--set`, or in another
// file of a variant. The domain grows, except where the ground is known only inside it: horizontally on a DEM, and on a
// profile that does not continue. Corners given in the same place as the cell are unchanged; check_case reports them.
void fit_domain_to_cells(Case& parameters, Reading& reading);

}  // namespace thawslide::config
