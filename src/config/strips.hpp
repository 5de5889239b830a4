// Substrates along x in sequence.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct Strip {
  std::string name;
  double from, to;  // [m], either may be infinite
};

// Sorted by their beginning.
[[nodiscard]] std::vector<Strip> strips_of(const Case& parameters);

// Gaps between strips in the domain: a sentence each, without a full stop.
[[nodiscard]] std::vector<std::string> warnings_of_gaps(const Case& parameters);

}  // namespace thawslide::config
