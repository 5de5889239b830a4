// Initial sweep.toml of a new case: ranges of the keys of the base that `thawslide new` proposes (case_proposal.hpp).
#pragma once

#include <optional>
#include <string>

#include "config/case_proposal.hpp"

namespace thawslide::config {

// Sweep file with comments. thickness: of the release [m]. base: of the case. quick: proposal on cells of `quick`, if
// those of the case are others. outlines: by proposed substrate.
[[nodiscard]] std::string sweep_text(double thickness, const ProposedBase& base, const std::optional<Proposal>& quick,
                                     const Outlines& outlines);

}  // namespace thawslide::config
