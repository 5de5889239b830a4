// Permutation of items with a buffer provided by the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/aligned.hpp"
#include "base/parallel.hpp"

namespace thawslide {

// One entry per item, of up to eight bytes.
using ReorderBuffer = std::vector<std::uint64_t>;

// Moves the item at order[k] to k. order: a permutation. get(k) and set(k, item) access the items.
template <class Item, class Get, class Set>
void reorder(const std::vector<std::uint32_t>& order, ReorderBuffer& buffer, const Get& get, const Set& set) {
  static_assert(sizeof(Item) <= sizeof(ReorderBuffer::value_type));
  constexpr std::size_t at_a_time = 4096;
  resize_sparingly(buffer, order.size());
  parallel_for(order.size(), at_a_time, [&](std::size_t k) {
    const Item item = get(static_cast<std::size_t>(order[k]));
    std::memcpy(&buffer[k], &item, sizeof item);
  });
  parallel_for(order.size(), at_a_time, [&](std::size_t k) {
    Item item;
    std::memcpy(&item, &buffer[k], sizeof item);
    set(k, item);
  });
}

}  // namespace thawslide
