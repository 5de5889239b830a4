// Initial 2D case for a section from a DEM.
#pragma once

#include <optional>
#include <string>

#include "config/case_proposal.hpp"
#include "config/profile_csv.hpp"

namespace thawslide::config {

// Extent of the body on a section [m].
struct SurfaceBody {
  double begin = 0.0, end = 0.0;  // distances of the rows before the first and after the last row with a thickness
  double area = 0.0;              // [m2]
  double thickness = 0.0;         // vertical, mean weighted by area [m]
};

// Requires a profile with a surface; returns a body of zero area if the surface is nowhere above the ground.
[[nodiscard]] SurfaceBody body_on(const ProfileTable& profile);

// Proposes a domain as long as the section, in whole cells, and as high as its ground and body with a margin of some
// cells. The cell gives at least six particles across the mean thickness.
[[nodiscard]] Proposal propose_section(const ProfileTable& profile, const SurfaceBody& body);

// Case file with comments; `profile_file` as named in the case.
[[nodiscard]] std::string section_text(const std::string& title, const std::string& profile_file,
                                       const Proposal& proposal, const std::optional<ProposedBase>& base = {});

}  // namespace thawslide::config
