// A first 2D case for a section that was cut out of a DEM.
#pragma once

#include <string>

#include "config/case_proposal.hpp"
#include "config/profile_csv.hpp"

namespace thawslide::config {

// Where the body stands on a section [m].
struct SurfaceBody {
  double begin = 0.0, end = 0.0;  // distance of the rows beside its first and after its last one with a thickness
  double area = 0.0;              // [m2]
  double thickness = 0.0;         // vertical, mean weighted by area [m]
};

// Of a profile with a surface; a body of no area where that is nowhere above the ground.
[[nodiscard]] SurfaceBody body_on(const ProfileTable& profile);

// The domain is as long as the section, in whole cells, and as high as its ground and body with some cells about them.
// The cell gives at least six particles across the mean thickness.
[[nodiscard]] Proposal propose_section(const ProfileTable& profile, const SurfaceBody& body);

// The commented case file; `profile_file` as the case is to name it.
[[nodiscard]] std::string section_text(const std::string& title, const std::string& profile_file,
                                       const Proposal& proposal);

}  // namespace thawslide::config
