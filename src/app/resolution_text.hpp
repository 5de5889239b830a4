// What `thawslide new` says of the resolution of a case and of those it offers.
#pragma once

#include <string>

#include "config/case_proposal.hpp"

namespace thawslide::app {

// Of a run to time.end.
struct RunCost {
  double steps = 0.0;
  double seconds = 0.0;  // of wall time
  int threads = 1;
};

// The first lines are of the proposed cell and its cost. The others are of the named resolutions except `chosen`, whose
// times follow from that cost and the cells. chosen: a name, or empty if the user gave the cell.
[[nodiscard]] std::string resolution_text(const config::Proposal& proposal, const std::string& chosen,
                                          const RunCost& cost);

}  // namespace thawslide::app
