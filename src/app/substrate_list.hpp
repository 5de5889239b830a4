// Substrates with separate laws, for reports.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::app {

struct SubstrateFacts {
  std::string name;       // empty: ground with the laws of [basal]
  std::string location;   // as text
  double covered = 0.0;   // part of the domain: [m2], in 2D [m]
  double fraction = 0.0;  // fraction of the domain
  std::string strength;   // laws as text
};

// Each substrate, and last the remaining ground with [basal]; empty if the case has no substrates.
[[nodiscard]] std::vector<SubstrateFacts> substrate_facts(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::app
