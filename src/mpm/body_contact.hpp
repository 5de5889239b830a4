// Contact between bodies that do not share nodes, on an executor. Each body has separate blocks (a layer of the grid).
// At nodes where two bodies have mass, they exchange momentum if they approach and the gap between their particles is
// closed. A held body is a fixed wall for the others.
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "exec/array.hpp"
#include "mpm/body_contact_kernels.hpp"

namespace thawslide::mpm {

template <class Executor, int Dim>
class BodyContact {
 public:
  explicit BodyContact(Executor& executor) : executor_(executor) {}

  // Call after the active blocks have changed. blocks: their keys, ascending.
  void update_pairs(const std::vector<std::uint64_t>& blocks, const BetweenBodies& between) {
    const std::vector<Found> found = find_pairs(blocks, between);
    std::vector<BlockPair> pairs;
    std::vector<std::uint32_t> first_of_place;
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (k == 0 || found[k].place != found[k - 1].place) {
        first_of_place.push_back(static_cast<std::uint32_t>(k));
      }
      pairs.push_back(found[k].pair);
    }
    first_of_place.push_back(static_cast<std::uint32_t>(found.size()));
    pairs_.set(pairs);
    first_of_place_.set(first_of_place);
  }
  // Length of `works` in constrain_mapped_back.
  [[nodiscard]] std::size_t work_count() const { return (first_of_place_.size() - 1) * block_nodes; }

  // Adds the contact forces between bodies in this step to the nodes.
  template <class Nodes>
  void add_forces(const BodyContactArgs<Nodes, Dim>& args) {
    const std::size_t count = pairs_.size() * block_nodes;
    if (count == 0) {
      return;
    }
    counts_.resize(count);
    before_.resize(count);
    meetings_.resize(count);
    executor_.for_each(count, CountAtMeetings<Nodes, Dim>{args, pairs_.data(), counts_.data()});
    executor_.sum_before(counts_.data(), before_.data(), count);
    constexpr std::size_t at_a_time = 1 << 15;  // bounds the memory of the lists of particles
    for (std::size_t start = 0; start < count; start += at_a_time) {
      const std::size_t here = std::min(at_a_time, count - start), last = start + here - 1;
      edges_.resize(before_.get(last) + counts_.get(last) - before_.get(start));
      executor_.for_each(here, FindGaps<Nodes, Dim>{args, pairs_.data(), counts_.data(), before_.data(), edges_.data(),
                                                    meetings_.data(), start});
    }
    executor_.for_each(work_count(),
                       ExchangeMomentum<Nodes, Dim>{args, pairs_.data(), first_of_place_.data(), meetings_.data()});
  }
  // Removes the approach of bodies in contact from the mapped-back velocities, without friction. works: of the nodes of
  // each place.
  template <class Nodes>
  void constrain_mapped_back(const BodyContactArgs<Nodes, Dim>& args, BodyContactWork* works) {
    executor_.for_each(work_count(), SeparateMappedBack<Nodes, Dim>{args, pairs_.data(), first_of_place_.data(),
                                                                    meetings_.data(), works});
  }

 private:
  using T = Tile<Dim>;
  static constexpr auto block_nodes = static_cast<std::size_t>(T::nodes);
  struct Found {
    std::uint64_t place;  // key of the blocks without their layers
    BlockPair pair;
  };

  // Pairs of blocks at the same place whose bodies may touch, by place, then by block.
  static std::vector<Found> find_pairs(const std::vector<std::uint64_t>& blocks, const BetweenBodies& between) {
    std::vector<Found> pairs;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const std::uint64_t place = T::without_layer(blocks[b]);
      const auto own_layer = static_cast<std::size_t>(T::layer(blocks[b]));
      // Held bodies are in the last layers, and do not act on one another.
      for (std::size_t layer = own_layer + 1; !between.is_held(own_layer) && layer < between.all_layers(); ++layer) {
        const std::int32_t other = exec::index_of_key(blocks.data(), blocks.size(), T::in_layer(place, layer));
        if (other != exec::absent) {
          pairs.push_back({place,
                           {static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(other), between.is_held(layer),
                            between.friction_between(own_layer, layer)}});
        }
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Found& a, const Found& b) {
      return std::tie(a.place, a.pair.block, a.pair.other) < std::tie(b.place, b.pair.block, b.pair.other);
    });
    return pairs;
  }

  Executor& executor_;
  exec::Array<BlockPair, Executor> pairs_{executor_};
  exec::Array<std::uint32_t, Executor> first_of_place_{executor_, 1};  // pairs of each place, with the end appended
  exec::Array<std::uint32_t, Executor> counts_{executor_}, before_{executor_};  // by pair and node
  exec::Array<BoxEdge, Executor> edges_{executor_};
  exec::Array<Meeting<Dim>, Executor> meetings_{executor_};  // by pair and node
};

}  // namespace thawslide::mpm
