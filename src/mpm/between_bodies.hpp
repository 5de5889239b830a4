// Bodies that share nodes, and interaction between bodies that do not (mpm/body_contact.hpp). Layers of the grid are
// numbered from 0: first those of bodies that move, then one for the held bodies of each of these.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/portability.hpp"

namespace thawslide::mpm {

// Friction coefficient of a contact that sticks while it is closed.
inline constexpr double rough = std::numeric_limits<double>::max();

struct BetweenBodies {
  std::vector<std::uint8_t> layer_of_body;  // while it moves, by body number; empty: all share nodes
  std::size_t layers = 1;                   // of moving bodies
  bool has_held = false;                    // some bodies are held for a time
  std::vector<double> friction;             // coefficient, by layer * layers + other layer

  [[nodiscard]] bool any() const { return all_layers() > 1; }
  [[nodiscard]] std::size_t all_layers() const { return has_held ? 2 * layers : layers; }
  [[nodiscard]] bool is_held(std::size_t layer) const { return layer >= layers; }
  [[nodiscard]] std::uint64_t first_held_layer() const {
    return has_held ? layers : std::numeric_limits<std::uint64_t>::max();
  }
  [[nodiscard]] double friction_between(std::size_t layer, std::size_t other) const {
    return friction[layer % layers * layers + other % layers];
  }
};

// Contribution of contact between bodies to the energy budget [J].
struct BodyContactWork {
  double loss = 0;       // dissipated by impact and friction
  double numerical = 0;  // correction of mapped_back, which counts contact among internal forces

  THAWSLIDE_HD BodyContactWork& operator+=(const BodyContactWork& part) {
    loss += part.loss;
    numerical += part.numerical;
    return *this;
  }
};

}  // namespace thawslide::mpm
