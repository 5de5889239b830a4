// Substrates that lie along x, one after another.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct Strip {
  std::string name;
  double from, to;  // [m], either may be infinite
};

// By where they begin.
[[nodiscard]] std::vector<Strip> strips_of(const Case& parameters);

// Of the domain, between strips that do not meet: a sentence each, without a full stop.
[[nodiscard]] std::vector<std::string> warnings_of_gaps(const Case& parameters);

}  // namespace thawslide::config
