// Items take another order in their own memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace thawslide {

// The item at k becomes the one that stood at order[k], a permutation; get(k) and set(k, item) reach them. Cycle by
// cycle: one item is set aside, and each place takes the next one until that is due. done: room for the work.
template <class Get, class Set>
void reorder_in_place(const std::vector<std::uint32_t>& order, std::vector<std::uint8_t>& done, const Get& get,
                      const Set& set) {
  done.resize(std::max(done.size(), order.size()));
  std::fill_n(done.begin(), order.size(), std::uint8_t{0});
  for (std::size_t first = 0; first < order.size(); ++first) {
    if (done[first] != 0 || order[first] == first) {
      continue;
    }
    const auto aside = get(first);
    std::size_t place = first;
    for (std::size_t next = order[place]; next != first; next = order[place]) {
      set(place, get(next));
      done[place] = 1;
      place = next;
    }
    set(place, aside);
    done[place] = 1;
  }
}

}  // namespace thawslide
