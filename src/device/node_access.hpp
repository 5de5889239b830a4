// Access to records of nodes in device memory, by the node's number over all blocks.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "mpm/records.hpp"
#include "mpm/tile.hpp"

namespace thawslide::device {

// Position [m, relative to the domain's lower corner] of a node, by its number over all blocks.
template <int Dim>
THAWSLIDE_HD Vector<double, Dim> position_of_node(const std::uint64_t* block_keys, std::size_t node, double cell) {
  using T = mpm::Tile<Dim>;
  constexpr auto block_nodes = static_cast<std::size_t>(T::nodes);
  const typename T::Index index =
      T::node(T::index(block_keys[node / block_nodes]), static_cast<int>(node % block_nodes));
  Vector<double, Dim> position;
  for (int a = 0; a < Dim; ++a) {
    position[a] = static_cast<double>(index[static_cast<std::size_t>(a)]) * cell;
  }
  return position;
}

// Access to records of nodes by name (as mpm::NodeAccess). A node is its number over all blocks.
template <int Dim, class... Names>
struct NodeAccess {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  mpm::ByName<mpm::Named<Names, double*>...> numbers;
  const std::uint64_t* block_keys;
  double cell;

  template <class Name>
  [[nodiscard]] THAWSLIDE_HD double* write(std::size_t node) const {
    return numbers.template of<Name>() + node * mpm::record_size(mpm::components_of<Name, Dim>);
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD const double* read(std::size_t node) const {
    return write<Name>(node);
  }
  [[nodiscard]] THAWSLIDE_HD static std::size_t node(std::size_t block, std::size_t in_block) {
    return block * block_nodes + in_block;
  }
  [[nodiscard]] THAWSLIDE_HD static std::size_t block(std::size_t node) { return node / block_nodes; }
  [[nodiscard]] THAWSLIDE_HD static std::size_t in_block(std::size_t node) { return node % block_nodes; }
  [[nodiscard]] THAWSLIDE_HD Vector<double, Dim> position(std::size_t node) const {
    return position_of_node<Dim>(block_keys, node, cell);
  }
};

// Records that contact with the ground and between bodies reads and writes.
template <int Dim>
using ContactNodes = NodeAccess<Dim, mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::NearGround, mpm::BaseLoad,
                                mpm::Contact, mpm::Motion, mpm::Velocity>;

}  // namespace thawslide::device
