// Values that are valid but probably unintended.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Young's modulus [Pa] below which a slide collapses under its own weight.
inline constexpr double softest_modulus = 1e6;

// Each warning specifies its location and the remedy; empty if there are none.
[[nodiscard]] std::vector<std::string> implausible(const Case& parameters);

}  // namespace thawslide::config
