// Bodies that share nodes, and interaction between bodies that do not (mpm/body_contact.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/portability.hpp"

namespace thawslide::mpm {

struct BetweenBodies {
  std::vector<std::uint8_t> layer_of_body;  // by body number; empty: all share nodes
  std::size_t layers = 1;
  std::vector<Real> friction;  // coefficient, by layer * layers + other layer

  [[nodiscard]] bool any() const { return layers > 1; }
};

}  // namespace thawslide::mpm
