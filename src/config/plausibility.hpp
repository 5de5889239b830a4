// What in a case is sound and yet most likely not meant.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// A slide of matter with a smaller Young's modulus [Pa] is squeezed flat by its own weight.
inline constexpr double softest_modulus = 1e6;

// Each with the place of what it is about and what to do; none for a case that has nothing of the kind.
[[nodiscard]] std::vector<std::string> implausible(const Case& parameters);

}  // namespace thawslide::config
