// Ground at the nodes of active blocks, in device memory, as in terrain/ground_on_grid.hpp. The CPU evaluates new
// blocks; the device finds the tiles and cells whose particles reach candidate nodes.
#pragma once

#include <utility>
#include <vector>

#include "device/array.hpp"
#include "device/step_model.hpp"
#include "device/tile_tables.hpp"
#include "mpm/vectors_in_records.hpp"
#include "terrain/near_ground_kernel.hpp"

namespace thawslide::device {

// Marks the cells of a tile whose particles reach a candidate node with any shape function. One thread per cell.
template <int Dim>
struct FindNear {
  TileTables<Dim> tables;
  const terrain::GroundAtNode<Dim>* known;
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
      const NodeInBlock<Dim> found = node_in_block<Dim>(static_cast<std::size_t>(T::in_patch(seen)));
      const std::int32_t block = tables.blocks_about_tile[tile * stencil + found.direction];
      any = known[static_cast<std::size_t>(block) * nodes + found.node].candidate ? 1 : any;
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

// Copies the ground data of each node, from the former blocks or from newly queried blocks; sets its record and
// candidate flag. One thread per node.
template <int Dim>
struct CopyGround {
  using AtNode = terrain::GroundAtNode<Dim>;

  const std::int32_t* block_before;  // by block; from `before` on: index among newly queried blocks
  std::size_t before;
  const AtNode *known_before, *queried;
  AtNode* known;
  Real* records;
  std::uint32_t* is_candidate;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    constexpr std::size_t size = mpm::record_size(mpm::components_of<mpm::Planes, Dim>);
    const auto block = static_cast<std::size_t>(block_before[k / nodes]);
    const AtNode* from = block < before ? known_before + block * nodes : queried + (block - before) * nodes;
    const AtNode node = from[k % nodes];
    known[k] = node;
    Real* record = records + k * size;
    for (std::size_t c = 0; c < size; ++c) {
      record[c] = Real(0);
    }
    record[mpm::Planes::offset] = node.plane;
    mpm::set_vector<Dim>(record, mpm::Planes::normal, node.plane_scale * node.normal);
    is_candidate[k] = node.candidate ? 1 : 0;
  }
};
// Lists the candidate nodes. number: index of each node among them, or absent.
struct ListCandidates {
  const std::uint32_t *is_candidate, *before;
  std::uint32_t* candidates;
  std::int32_t* number;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    number[k] = absent;
    if (is_candidate[k] != 0) {
      candidates[before[k]] = static_cast<std::uint32_t>(k);
      number[k] = static_cast<std::int32_t>(before[k]);
    }
  }
};

// Filter for tiles that reach candidate nodes, and for the particles of their cells.
template <int Dim>
struct SeesCandidates {
  const std::uint8_t *near, *any_near;

  THAWSLIDE_HD bool operator()(std::size_t tile) const { return any_near[tile] != 0; }
  THAWSLIDE_HD bool operator()(std::size_t tile, std::size_t cell) const {
    return near[tile * static_cast<std::size_t>(mpm::Tile<Dim>::nodes) + cell] != 0;
  }
};

template <class Backend, int Dim>
class Ground {
  using T = mpm::Tile<Dim>;
  using AtNode = terrain::GroundAtNode<Dim>;
  static constexpr auto nodes = static_cast<std::size_t>(T::nodes);
  static constexpr std::size_t size = mpm::record_size(mpm::components_of<mpm::Planes, Dim>);

 public:
  Ground(Backend& backend, GroundQuery<Dim> query) : backend_(backend), host_(std::move(query)) {}

  [[nodiscard]] bool exists() const { return static_cast<bool>(host_); }

  // Call after blocks or tiles have changed.
  void update(const TileTables<Dim>& tables, const std::vector<std::uint64_t>& blocks) {
    update_blocks(blocks);
    list_candidates_of(blocks.size() * nodes);
    near_.resize(tables.tiles * nodes);
    any_near_.resize(tables.tiles);
    backend_.for_each(near_.size(), FindNear<Dim>{tables, known_.data(), near_.data()});
    backend_.for_each(any_near_.size(), FindNearTile<Dim>{near_.data(), any_near_.data()});
  }

  [[nodiscard]] const AtNode* known() const { return known_.data(); }
  [[nodiscard]] const Real* records() const { return records_.data(); }
  // Candidate nodes, and the index of each node among them (absent for others).
  [[nodiscard]] const std::uint32_t* candidates() const { return candidates_.data(); }
  [[nodiscard]] std::vector<std::uint32_t> list_candidates() const { return candidates_.get(); }
  [[nodiscard]] std::size_t candidate_count() const { return candidates_.size(); }
  [[nodiscard]] const std::int32_t* number() const { return number_.data(); }
  // By block: 1 if the ground below it or within one cell around it has no-data parts.
  [[nodiscard]] const std::uint8_t* partly_unknown() const { return partly_unknown_.data(); }
  [[nodiscard]] SeesCandidates<Dim> sees_candidates() const { return {near_.data(), any_near_.data()}; }

 private:
  // Queries the CPU for new blocks only.
  void update_blocks(const std::vector<std::uint64_t>& blocks) {
    std::vector<std::int32_t> before = index_map(blocks_, blocks);
    std::vector<AtNode> queried;
    std::vector<std::uint8_t> partly_unknown(blocks.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (before[b] != absent) {
        partly_unknown[b] = is_partly_unknown_[static_cast<std::size_t>(before[b])];
        continue;
      }
      before[b] = static_cast<std::int32_t>(blocks_.size() + queried.size() / nodes);
      queried.resize(queried.size() + nodes);
      partly_unknown[b] = host_(blocks[b], &queried[queried.size() - nodes]) ? 0 : 1;
    }
    block_before_.set(before);
    queried_.set(queried);
    partly_unknown_.set(partly_unknown);
    known_before_.swap(known_);
    known_.resize(blocks.size() * nodes);
    records_.resize(known_.size() * size);
    is_candidate_.resize(known_.size());
    backend_.for_each(known_.size(),
                      CopyGround<Dim>{block_before_.data(), blocks_.size(), known_before_.data(), queried_.data(),
                                      known_.data(), records_.data(), is_candidate_.data()});
    blocks_ = blocks;
    is_partly_unknown_ = std::move(partly_unknown);
  }

  void list_candidates_of(std::size_t count) {
    candidates_before_.resize(count);
    number_.resize(count);
    backend_.sum_before(is_candidate_.data(), candidates_before_.data(), count);
    candidates_.resize(count > 0 ? candidates_before_.get(count - 1) + is_candidate_.get(count - 1) : 0);
    backend_.for_each(
        count, ListCandidates{is_candidate_.data(), candidates_before_.data(), candidates_.data(), number_.data()});
  }

  Backend& backend_;
  GroundQuery<Dim> host_;
  std::vector<std::uint64_t> blocks_;            // known blocks
  std::vector<std::uint8_t> is_partly_unknown_;  // by block
  Array<std::int32_t, Backend> block_before_{backend_};
  Array<AtNode, Backend> queried_{backend_}, known_before_{backend_}, known_{backend_};
  Array<Real, Backend> records_{backend_};
  Array<std::uint32_t, Backend> is_candidate_{backend_}, candidates_before_{backend_}, candidates_{backend_};
  Array<std::int32_t, Backend> number_{backend_};
  Array<std::uint8_t, Backend> near_{backend_}, any_near_{backend_}, partly_unknown_{backend_};
};

}  // namespace thawslide::device
