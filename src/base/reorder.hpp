// Items take another order in their own memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thawslide {

// The item at k becomes the one that stood at order[k], a permutation; get(k) and set(k, item) reach them.
template <class Item, class Get, class Set>
void reorder(const std::vector<std::uint32_t>& order, const Get& get, const Set& set) {
  thread_local std::vector<Item> room;  // kept: a step allocates nothing
  room.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    room[k] = get(static_cast<std::size_t>(order[k]));
  }
  for (std::size_t k = 0; k < order.size(); ++k) {
    set(k, room[k]);
  }
}

}  // namespace thawslide
