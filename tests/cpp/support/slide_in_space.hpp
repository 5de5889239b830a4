// Small 3D slide for tests of run records.
#pragma once

#include "base_cases.hpp"

namespace thawslide::testing_support {

// Box of 6 x 4 x 3 m of warm ice on a plane of 25 degrees that falls towards +x, on a grid of 1 m.
inline config::Case slide_in_space(const Sets& sets = {}) { return published_case("box", sets); }

}  // namespace thawslide::testing_support
