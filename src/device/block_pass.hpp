// Pass over the nodes of all blocks, one thread group per block, with sums over nodes in the order of blocks.
#pragma once

#include "device/add_up.hpp"
#include "device/tile_tables.hpp"

namespace thawslide::device {

// Work provides visit(node, part), which fills the part of one node (numbered over all blocks), and add(parts, count,
// sum), which reduces the parts of one block.
template <class Work, int Dim>
struct BlockPass {
  using Part = typename Work::Part;
  using Sum = typename Work::Sum;
  static constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  static constexpr std::size_t bytes = nodes * sizeof(Part);

  Work work;
  Sum* sums;  // by block

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t block) const {
    auto* parts = reinterpret_cast<Part*>(group.shared());
    group.each(nodes, [this, block, parts](std::size_t k) {
      Part part{};
      work.visit(block * nodes + k, part);
      parts[k] = part;
    });
    group.barrier();
    group.each(1, [this, block, parts](std::size_t /*k*/) {
      Sum sum{};
      work.add(parts, nodes, sum);
      sums[block] = sum;
    });
  }
};

// sums: buffer of partial_sum_count(blocks) entries. Returns a pointer to the total within it.
template <int Dim, class Backend, class Work>
typename Work::Sum* block_pass(Backend& backend, std::size_t blocks, const Work& work, typename Work::Sum* sums) {
  using Pass = BlockPass<Work, Dim>;
  backend.for_groups(blocks, Pass::nodes, Pass::bytes, Pass{work, sums});
  return add_up(backend, sums, blocks);
}

}  // namespace thawslide::device
