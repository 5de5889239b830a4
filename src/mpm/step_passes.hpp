// Passes of the stages that CPU and devices share (mpm/motion_stages.hpp, band/stages.hpp), on the CPU.
// device/step_passes.hpp provides the same functions.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::mpm {

// Runs the kernel of a particle's material, which all particles of a batch share.
template <class Kernels>
struct ByMaterial;
template <class Kernel, class... Others>
struct ByMaterial<std::variant<Kernel, Others...>> {
  using Reads = typename Kernel::Reads;
  using Adds = typename Kernel::Adds;
  using Totals = typename Kernel::Totals;

  const std::variant<Kernel, Others...>* by_material;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen, Scatter& added,
                                          Totals& totals) const {
    std::visit([&](const auto& kernel) { kernel(particles, at, seen, added, totals); },
               by_material[static_cast<std::size_t>(particles.material(at.particle[0]))]);
  }
};

template <int Dim>
class StepPasses {
 public:
  // weights: of momentum. All other arguments must outlive it.
  StepPasses(const SparseGrid<Dim>& grid, const MomentumWeights<Dim>& weights, Particles<Dim>& particles,
             Nodes<Dim>& nodes)
      : grid_(grid), weights_(weights), particles_(particles), nodes_(nodes) {}

  [[nodiscard]] double cell() const { return grid_.cell(); }
  [[nodiscard]] NodeAccess<Dim> node_access() { return {grid_, nodes_}; }

  // Weights and tiles of a pass.
  template <class TileFilter = decltype(every_tile)>
  [[nodiscard]] static auto linear(const TileFilter& accepts = every_tile) {
    return std::pair{LinearWeights{}, accepts};
  }
  template <class TileFilter = decltype(every_tile)>
  [[nodiscard]] auto momentum(const TileFilter& accepts = every_tile) const {
    return std::pair{weights_, accepts};
  }
  // With the weights of APIC.
  [[nodiscard]] auto affine() const { return std::pair{AffineWeights<Dim>{weights_}, every_tile}; }
  // Runs a kernel over particles; `total` also stores its total, and `add_total` adds it.
  template <class Over, class Kernel>
  auto run(const Over& over, const Kernel& kernel) {
    return std::get<0>(particle_pass(grid_, over.first, particles_, nodes_, over.second, kernel));
  }
  template <class Over, class Kernel>
  void total(const Over& over, const Kernel& kernel, typename Kernel::Totals* to) {
    *to = run(over, kernel);
  }
  template <class Over, class Kernel>
  void add_total(const Over& over, const Kernel& kernel, typename Kernel::Totals* to) {
    *to += run(over, kernel);
  }
  // Adds the totals of the kernels of each material, in the order of their numbers.
  template <class Over, class Kernel, class Totals>
  void add_total_by_material(const Over& over, const std::vector<Kernel>& by_material, Totals* to) {
    add_total(over, ByMaterial<Kernel>{by_material.data()}, to);
  }

  template <class... Names>
  void resize_records() {
    (nodes_.template of<Names>().resize(grid_.blocks().size()), ...);
  }
  // Sums the contributions of particles to all nodes.
  template <class Name>
  void sum_all() {
    sum_patches(grid_, nodes_.template of<Name>());
  }

  // Total over nodes, accessed like a pointer to memory of a device.
  template <class Sum>
  struct Total {
    Sum sum;
    const Sum& operator*() const { return sum; }
    const Sum* operator->() const { return &sum; }
  };
  // Sums the contributions of particles to the nodes of marked blocks, all blocks if `blocks` is null, and calls
  // solve(node, total) for these nodes; with `others`, also for those of other blocks.
  template <class Name, class Solve>
  Total<typename Solve::Totals> solve(const std::uint8_t* blocks, const Solve& solve, bool others = false) {
    auto& records = nodes_.template of<Name>();
    const std::size_t count = grid_.blocks().size();
    const auto is_summed = [blocks](std::size_t b) { return blocks == nullptr || blocks[b] != 0; };
    if constexpr (requires { records.allocate(count, is_summed); }) {
      records.allocate(count, is_summed);
    } else {
      records.resize(count);
    }
    const auto begin = [&](std::size_t b) {
      return is_summed(b) ? sum_block<Name>(grid_, b, nodes_) : others ? rows_seen_in_block(grid_, b) : 0;
    };
    return {node_pass<typename Solve::Totals>(grid_, begin, solve)};
  }
  template <class Sum>
  static void keep(const Sum* from, std::type_identity_t<Sum>* to) {
    *to = *from;
  }
  // True if a count is known to be 0 without waiting for it.
  [[nodiscard]] static bool is_known_zero(const std::uint64_t* count) { return *count == 0; }

  // Conditions are those of band/tile_conditions.hpp.
  // Marks the tiles with a particle that meets the condition, or that reaches a node that does, and the blocks around.
  template <class Condition>
  void mark(const Condition& condition) {
    ActivityMarks& marks = nodes_.marks;
    marks.tiles.resize(grid_.tiles().size());
    parallel_for(marks.tiles.size(), [&](std::size_t t) { marks.tiles[t] = is_met_in(t, condition) ? 1 : 0; });
    grid_.mark_blocks_about(marks.tiles, marks.blocks);
  }
  // The same, and then the tiles around these blocks. Returns false if there are none.
  template <class Condition>
  [[nodiscard]] bool mark_around(const Condition& condition) {
    mark(condition);
    ActivityMarks& marks = nodes_.marks;
    if (std::find(marks.tiles.begin(), marks.tiles.end(), 1) == marks.tiles.end()) {
      return false;
    }
    parallel_for(marks.tiles.size(),
                 [&](std::size_t t) { marks.tiles[t] = grid_.any_about_tile(t, marks.blocks) ? 1 : 0; });
    return true;
  }
  [[nodiscard]] const std::uint8_t* marked_blocks() const { return nodes_.marks.blocks.data(); }
  [[nodiscard]] auto marked_tiles() const {
    return [marks = nodes_.marks.tiles.data()](std::size_t t) { return marks[t] != 0; };
  }

  // Tiles, and their batches, in reach of nodes that meet a condition.
  template <class Condition>
  struct TilesInReach {
    const StepPasses& passes;
    Condition condition;

    [[nodiscard]] bool operator()(std::size_t tile) const {
      return (passes.nodes_.marks.rows[tile] = passes.rows_in_reach(tile, condition)) != 0;
    }
    [[nodiscard]] bool operator()(std::size_t tile, const BatchNodes& nodes) const {
      const std::uint64_t rows = passes.nodes_.marks.rows[tile];
      return std::any_of(nodes.first.begin(), nodes.first.end(),
                         [rows](std::int32_t lowest) { return (Tile<Dim>::rows_from(lowest) & rows) != 0; });
    }
  };
  template <class Condition>
  [[nodiscard]] TilesInReach<Condition> in_reach(const Condition& condition) {
    nodes_.marks.rows.resize(grid_.tiles().size());
    return {*this, condition};
  }

 private:
  template <class Condition>
  [[nodiscard]] bool is_met_in(std::size_t tile, const Condition& condition) const {
    const auto& batches = grid_.batches(tile);
    const auto of_particles = [&] {
      return std::any_of(batches.begin(), batches.end(),
                         [&](const auto& batch) { return condition.of_particles(particles_, batch); });
    };
    if constexpr (std::is_void_v<typename Condition::Reads>) {
      return of_particles();
    } else {
      return is_met_in_own_block(tile, condition) || of_particles() || rows_in_reach(tile, condition) != 0;
    }
  }
  // Most tiles that meet a condition meet it here, without a copy of the records around them.
  template <class Condition>
  [[nodiscard]] bool is_met_in_own_block(std::size_t tile, const Condition& condition) const {
    constexpr std::size_t own = static_cast<std::size_t>(Tile<Dim>::stencil) / 2;
    constexpr int edge = Tile<Dim>::edge;
    const auto* records = nodes_.template of<typename Condition::Reads>().of_block(
        static_cast<std::size_t>(grid_.blocks_about_tile(tile)[own]));
    for (auto rows = rows_in_block<Dim, own>(grid_.rows_seen(tile)); rows != 0; rows &= rows - 1) {
      const auto* row = records + std::countr_zero(rows) * edge;
      if (std::any_of(row, row + edge, [&](const auto& record) { return condition.of_node(record); })) {
        return true;
      }
    }
    return false;
  }
  template <class Condition>
  [[nodiscard]] std::uint64_t rows_in_reach(std::size_t tile, const Condition& condition) const {
    PatchOf<typename Condition::Reads, Dim> patch;
    load_patch(grid_, tile, nodes_.template of<typename Condition::Reads>(), patch);
    return patch.rows_with(grid_.rows_seen(tile), [&](const auto& record) { return condition.of_node(record); });
  }

  const SparseGrid<Dim>& grid_;
  MomentumWeights<Dim> weights_;
  Particles<Dim>& particles_;
  Nodes<Dim>& nodes_;
};

}  // namespace thawslide::mpm
