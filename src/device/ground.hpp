// Ground at the nodes of active blocks, in device memory, as in terrain/ground_on_grid.hpp. The CPU evaluates new
// blocks.
#pragma once

#include <utility>
#include <vector>

#include "device/step_model.hpp"
#include "device/tile_tables.hpp"
#include "exec/array.hpp"
#include "mpm/vectors_in_records.hpp"
#include "terrain/near_ground_kernels.hpp"

namespace thawslide::device {

// Copies the ground data of each node, from the former blocks or from newly queried blocks; sets its record and
// candidate flag. One thread per node.
template <int Dim>
struct CopyGround {
  using AtNode = terrain::GroundAtNode<Dim>;

  const std::int32_t* block_before;  // by block; from `before` on: index among newly queried blocks
  std::size_t before;
  const AtNode *known_before, *queried;
  AtNode* known;
  double* records;
  std::uint32_t* is_candidate;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    constexpr std::size_t size = mpm::record_size(mpm::components_of<mpm::Planes, Dim>);
    const auto block = static_cast<std::size_t>(block_before[k / nodes]);
    const AtNode* from = block < before ? known_before + block * nodes : queried + (block - before) * nodes;
    const AtNode node = from[k % nodes];
    known[k] = node;
    double* record = records + k * size;
    for (std::size_t c = 0; c < size; ++c) {
      record[c] = 0.0;
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
  using T = mpm::Tile<Dim>;

  const std::uint64_t* tile_keys;

  THAWSLIDE_HD bool operator()(std::size_t tile) const { return (*this)(tile, 0); }
  // Cells are numbered like the nodes nearest to their particles; the first ones are the lowest.
  THAWSLIDE_HD bool operator()(std::size_t tile, std::size_t cell) const {
    return T::node(T::index(tile_keys[tile]), static_cast<int>(cell))[Dim - 1] <= 1;
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

  // Call after blocks have changed.
  void update(const std::vector<std::uint64_t>& blocks) {
    update_blocks(blocks);
    list_candidates_of(blocks.size() * nodes);
  }

  [[nodiscard]] const AtNode* known() const { return known_.data(); }
  [[nodiscard]] const double* records() const { return records_.data(); }
  // Candidate nodes, and the index of each node among them (absent for others).
  [[nodiscard]] const std::uint32_t* candidates() const { return candidates_.data(); }
  [[nodiscard]] std::vector<std::uint32_t> list_candidates() const { return candidates_.get(); }
  [[nodiscard]] std::size_t candidate_count() const { return candidates_.size(); }
  [[nodiscard]] const std::int32_t* number() const { return number_.data(); }
  // By block: 1 if the ground below it or within one cell around it has no-data parts.
  [[nodiscard]] const std::uint8_t* partly_unknown() const { return partly_unknown_.data(); }

 private:
  // Queries the CPU for new blocks only.
  void update_blocks(const std::vector<std::uint64_t>& blocks) {
    std::vector<std::int32_t> before = exec::index_map(blocks_, blocks);
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
  exec::Array<std::int32_t, Backend> block_before_{backend_};
  exec::Array<AtNode, Backend> queried_{backend_}, known_before_{backend_}, known_{backend_};
  exec::Array<double, Backend> records_{backend_};
  exec::Array<std::uint32_t, Backend> is_candidate_{backend_}, candidates_before_{backend_}, candidates_{backend_};
  exec::Array<std::int32_t, Backend> number_{backend_};
  exec::Array<std::uint8_t, Backend> partly_unknown_{backend_};
};

}  // namespace thawslide::device
