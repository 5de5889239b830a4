// Values of a valid case outside the usual range, reported before a run; they are not errors.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Each notice specifies the location, the value, the usual range and the consequence.
std::vector<std::string> notices(const Case& parameters);

}  // namespace thawslide::config
