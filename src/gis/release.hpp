// The release of one body: its thickness and what else maps tell of it, at the points of the ground.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/dem.hpp"

namespace thawslide::gis {

// `ground` as the terrain model has it, before anything is cut out of it. Adds to the notes.
[[nodiscard]] config::Release load_release(const config::Case& parameters, const std::string& body, const Dem& ground,
                                           std::vector<std::string>& notes);

// Throws UserError where two releases have a thickness at the same point.
void check_overlaps(const config::Case& parameters, const std::map<std::string, config::Release>& releases);

}  // namespace thawslide::gis
