// The ground at the nodes of the active blocks, in a device's memory: what terrain/ground_on_grid.hpp has. The
// processor learns of blocks that the slide comes to; the device finds which tiles and cells see candidate nodes.
#pragma once

#include <algorithm>
#include <array>
#include <unordered_map>
#include <vector>

#include "device/array.hpp"
#include "device/step_model.hpp"
#include "device/tile_tables.hpp"
#include "mpm/vectors_in_records.hpp"
#include "terrain/near_ground_kernel.hpp"

namespace thawslide::device {

// Marks the cells of a tile whose particles see a candidate node with any shape functions. A thread a cell.
template <int Dim, class Real>
struct FindNear {
  TileTables<Dim> tables;
  const terrain::GroundAtNode<Dim, Real>* known;
  std::uint8_t* near;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    using T = mpm::Tile<Dim>;
    constexpr auto nodes = static_cast<std::size_t>(T::nodes), stencil = static_cast<std::size_t>(T::stencil);
    const std::size_t tile = k / nodes;
    const typename T::Index nearest = T::node({}, static_cast<int>(k % nodes));
    std::uint8_t any = 0;
    for (std::size_t n = 0; n < stencil; ++n) {
      typename T::Index seen = nearest;
      std::size_t rest = n;
      for (std::size_t a = 0; a < Dim; ++a) {
        seen[a] += static_cast<int>(rest % 3) - 1;
        rest /= 3;
      }
      const PlaceInBlock<Dim> place = place_in_block<Dim>(static_cast<std::size_t>(T::in_patch(seen)));
      const std::int32_t block = tables.blocks_about_tile[tile * stencil + place.direction];
      any = known[static_cast<std::size_t>(block) * nodes + place.node].candidate ? 1 : any;
    }
    near[k] = any;
  }
};
template <int Dim>
struct FindNearTile {
  const std::uint8_t* near;
  std::uint8_t* any_near;

  THAWSLIDE_HD void operator()(std::size_t tile) const {
    constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    std::uint8_t any = 0;
    for (std::size_t k = 0; k < nodes; ++k) {
      any = near[tile * nodes + k] != 0 ? 1 : any;
    }
    any_near[tile] = any;
  }
};

// The tiles, and of these the particles by their cell, that see candidate nodes.
template <int Dim>
struct SeesCandidates {
  const std::uint8_t *near, *any_near;

  THAWSLIDE_HD bool operator()(std::size_t tile) const { return any_near[tile] != 0; }
  THAWSLIDE_HD bool operator()(std::size_t tile, std::size_t cell) const {
    return near[tile * static_cast<std::size_t>(mpm::Tile<Dim>::nodes) + cell] != 0;
  }
};

template <class Backend, int Dim, class Real>
class Ground {
  using T = mpm::Tile<Dim>;
  using AtNode = terrain::GroundAtNode<Dim, Real>;
  static constexpr auto nodes = static_cast<std::size_t>(T::nodes);
  static constexpr std::size_t size = mpm::record_size(mpm::components_of<terrain::Ground, Dim>);

 public:
  Ground(Backend& backend, AskGround<Dim, Real> ask) : backend_(backend), ask_(std::move(ask)) {}

  [[nodiscard]] bool exists() const { return static_cast<bool>(ask_); }

  // To be called after blocks or tiles changed.
  void update(const TileTables<Dim>& tables, const std::vector<std::uint64_t>& blocks) {
    std::vector<AtNode> known(blocks.size() * nodes);
    std::vector<Real> records(known.size() * size);
    std::vector<std::uint32_t> candidates;
    std::vector<std::int32_t> number(known.size(), absent);
    std::vector<std::uint8_t> partly_unknown(blocks.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const auto [place, is_new] = known_.try_emplace(blocks[b]);
      Block& block = place->second;
      if (is_new) {
        block.is_known = ask_(blocks[b], block.at.data());
      }
      std::copy(block.at.begin(), block.at.end(), known.begin() + static_cast<std::ptrdiff_t>(b * nodes));
      partly_unknown[b] = block.is_known ? 0 : 1;
    }
    for (std::size_t k = 0; k < known.size(); ++k) {
      Real* record = &records[k * size];
      record[terrain::Ground::distance] = known[k].distance;
      mpm::set_vector<Dim>(record, terrain::Ground::normal, known[k].normal);
      if (known[k].candidate) {
        number[k] = static_cast<std::int32_t>(candidates.size());
        candidates.push_back(static_cast<std::uint32_t>(k));
      }
    }
    known_of_node_.set(known);
    records_.set(records);
    candidates_.set(candidates);
    number_.set(number);
    partly_unknown_.set(partly_unknown);
    near_.resize(tables.tiles * nodes);
    any_near_.resize(tables.tiles);
    backend_.for_each(near_.size(), FindNear<Dim, Real>{tables, known_of_node_.data(), near_.data()});
    backend_.for_each(any_near_.size(), FindNearTile<Dim>{near_.data(), any_near_.data()});
  }

  [[nodiscard]] const AtNode* known() const { return known_of_node_.data(); }
  [[nodiscard]] const Real* records() const { return records_.data(); }
  // Nodes with a candidate; by node, which of them it is, or absent.
  [[nodiscard]] const std::uint32_t* candidates() const { return candidates_.data(); }
  [[nodiscard]] std::vector<std::uint32_t> list_candidates() const { return candidates_.get(); }
  [[nodiscard]] std::size_t candidate_count() const { return candidates_.size(); }
  [[nodiscard]] const std::int32_t* number() const { return number_.data(); }
  // By block: whether the ground below it, and a cell about it, is not known everywhere.
  [[nodiscard]] const std::uint8_t* partly_unknown() const { return partly_unknown_.data(); }
  [[nodiscard]] SeesCandidates<Dim> sees_candidates() const { return {near_.data(), any_near_.data()}; }

 private:
  struct Block {
    std::array<AtNode, nodes> at;
    bool is_known = true;  // everywhere
  };

  Backend& backend_;
  AskGround<Dim, Real> ask_;
  std::unordered_map<std::uint64_t, Block> known_;  // by key; blocks once seen are kept
  Array<AtNode, Backend> known_of_node_{backend_};
  Array<Real, Backend> records_{backend_};
  Array<std::uint32_t, Backend> candidates_{backend_};
  Array<std::int32_t, Backend> number_{backend_};
  Array<std::uint8_t, Backend> near_{backend_}, any_near_{backend_}, partly_unknown_{backend_};
};

}  // namespace thawslide::device
