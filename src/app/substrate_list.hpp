// What of the ground has laws of its own, and which.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::app {

struct SubstrateFacts {
  std::string name;      // empty: what [basal] holds for, elsewhere
  std::string place;     // in words
  double covered = 0.0;  // of the domain: [m2], in the plane [m]
  double share = 0.0;    // of the domain
  std::string strength;  // its laws in words
};

// Each substrate, and last what is left to [basal]; empty where the case has none.
[[nodiscard]] std::vector<SubstrateFacts> substrate_facts(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::app
