// Base of the sliding mass as segments that each carry a band column, and their exchange with contact nodes, on an
// executor. Segments move with the sliding mass, split when they become long, and are created where it reaches new
// ground.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "band/base_sums.hpp"
#include "band/segment_creation.hpp"
#include "exec/ordered_sum.hpp"
#include "exec/selection.hpp"

namespace thawslide::band {

template <int Dim>
struct SegmentsState {
  std::vector<BasalSegment<Dim>> segments;
  ColumnLedger budget;  // since the start
  std::int64_t next_id = 0;
  bool checks_gaps = true;     // segments have moved since the last search for ground without segments
  double time_since_step = 0;  // of the columns [s]
};

// Grid, nodes and ground of a step. Nodes: access to records of nodes (mpm/nodes.hpp, device/node_access.hpp). Ground,
// Normals: as in band/segment_motion.hpp.
template <class Nodes, class Ground, class Normals, int Dim>
struct BaseInStep {
  mpm::BlockTables<Dim> tables;
  Nodes nodes;
  Ground ground;
  Normals normal_at;
};

template <class Executor, int Dim>
class BasalSegments {
  using Segment = BasalSegment<Dim>;
  using Patch = BasePatch<Dim>;

 public:
  // cell: mesh size [m]. gravity [m/s2].
  BasalSegments(Executor& executor, const ColumnsModel& model, double cell, const Vector<double, Dim>& gravity)
      : executor_(executor), model_(model), cell_(cell), gravity_(gravity) {}

  // Computes the state of the base at the nodes of layer 0.
  void to_nodes(const mpm::BlockTables<Dim>& tables) {
    ground_block_.resize(tables.blocks);
    executor_.for_each(tables.blocks, FindGroundBlock<Dim>{tables, ground_block_.data()});
    locate(tables, segments_.data(), segments_.size());
    states_of_segments_.resize(segments_.size());
    areas_.resize(segments_.size());
    executor_.for_each(segments_.size(),
                       StateOfSegment<Dim>{segments_.data(), states_of_segments_.data(), areas_.data()});
    records_.resize((tables.blocks + 1) * Patch::nodes_of_layer);
    add_to_nodes(tables, false);
  }
  // The result, until the blocks change.
  [[nodiscard]] mpm::BaseStates<Dim> states() const {
    return {ground_block_.data(), reinterpret_cast<const double*>(records_.data())};
  }

  // Applies contact over dt to all segments (load, heat, slip) at the positions used by to_nodes, then moves them by
  // dt. First creates segments where the sliding mass touches ground without one. Every model.step, segments stretch,
  // split and merge, and all columns are stepped. thickness: prescribed band thickness [m].
  template <class Nodes, class Ground, class Normals>
  void update(const BaseInStep<Nodes, Ground, Normals, Dim>& base, double thickness, double dt) {
    const std::size_t of_layers = base.tables.blocks * Patch::nodes_of_layer;
    contact_.resize(of_layers);
    executor_.for_each(of_layers,
                       SumContact<Nodes, Dim>{base.tables, ground_block_.data(), base.nodes, contact_.data()});
    if (std::exchange(state_.checks_gaps, false) || some_node_is_bare(base)) {
      create(base, thickness);
    }
    divided_.resize(of_layers);
    executor_.for_each(of_layers,
                       DivideContact<Dim>{ground_block_.data(), records_.data(), contact_.data(), divided_.data()});
    executor_.for_each(segments_.size(), GatherContact<Dim>{base.tables, model_, gravity_, dt, stencils_.data(),
                                                            divided_.data(), segments_.data()});
    state_.time_since_step += dt;
    if (state_.time_since_step + 0.5 * dt > model_.step) {
      const double duration = std::exchange(state_.time_since_step, 0.0);
      follow(base, duration);
      step(thickness, duration);
    }
  }

  [[nodiscard]] const ColumnsModel& model() const { return model_; }
  // In the memory of the executor.
  [[nodiscard]] std::span<const Segment> segments() const { return {segments_.data(), segments_.size()}; }
  [[nodiscard]] BaseTotals totals() {
    executor_.for_each(segments_.size(), SumSegment<Dim>{model_, segments_.data(), base_sums_.parts(segments_.size())});
    return {base_sums_.total(), state_.budget};
  }
  [[nodiscard]] double time_since_step() const { return state_.time_since_step; }
  void set_time_since_step(double time) { state_.time_since_step = time; }
  // For maps; empty in 2D.
  [[nodiscard]] std::vector<SegmentBelow> summaries() {
    if constexpr (Dim == 3) {
      summaries_.resize(segments_.size());
      executor_.for_each(segments_.size(), SummarizeSegment{segments_.data(), summaries_.data()});
    }
    return summaries_.get();
  }
  [[nodiscard]] SegmentsState<Dim> state() const {
    SegmentsState<Dim> state = state_;
    state.segments = segments_.get();
    return state;
  }
  void set(const SegmentsState<Dim>& state) {
    segments_.set(state.segments);
    state_ = state;
    state_.segments.clear();
  }

 private:
  // Stencils of segments, and the segments above each block.
  void locate(const mpm::BlockTables<Dim>& tables, const Segment* segments, std::size_t count) {
    stencils_.resize(count);
    for (exec::Array<std::uint64_t, Executor>* keys : {&keys_, &sorted_keys_}) {
      keys->resize(count);
    }
    for (exec::Array<std::uint32_t, Executor>* numbers : {&numbers_, &by_block_}) {
      numbers->resize(count);
    }
    executor_.for_each(count,
                       LocateSegment<Dim>{tables, cell_, segments, stencils_.data(), keys_.data(), numbers_.data()});
    executor_.sort(keys_.data(), numbers_.data(), sorted_keys_.data(), by_block_.data(), count);
    first_of_block_.resize(tables.blocks + 1);
    executor_.for_each(first_of_block_.size(), FirstOfBlock{sorted_keys_.data(), count, first_of_block_.data()});
  }
  [[nodiscard]] SegmentsOfBlocks of_blocks() const { return {first_of_block_.data(), by_block_.data()}; }

  // Sums the states of the located segments times their areas at the nodes.
  void add_to_nodes(const mpm::BlockTables<Dim>& tables, bool adds) {
    patches_.resize(tables.blocks * Patch::nodes);
    executor_.for_each(
        tables.blocks * Patch::rows,
        AddToPatch<Dim>{of_blocks(), stencils_.data(), states_of_segments_.data(), areas_.data(), patches_.data()});
    executor_.for_each(records_.size(), SumPatches<Dim>{tables, ground_block_.data(), of_blocks(), patches_.data(),
                                                        adds, records_.data()});
  }

  template <class Base>
  [[nodiscard]] auto bare_nodes(const Base& base, std::uint32_t* is_bare) {
    return FindBareNodes<decltype(base.nodes), decltype(base.ground), Dim>{states(),    cell_,   base.nodes,
                                                                           base.ground, is_bare, any_.data()};
  }
  template <class Base>
  bool some_node_is_bare(const Base& base) {
    any_.resize(1);
    executor_.for_each(1, exec::Fill<std::uint32_t>{any_.data(), 0});
    executor_.for_each(base.tables.blocks * block_nodes, bare_nodes(base, nullptr));
    return any_.get(0) != 0;
  }

  // Creates segments in the lattice cells of nodes in contact that no segment covers.
  template <class Nodes, class Ground, class Normals>
  void create(const BaseInStep<Nodes, Ground, Normals, Dim>& base, double thickness) {
    const Lattice<Dim> lattice{cell_};
    const std::size_t all_nodes = base.tables.blocks * block_nodes;
    std::uint32_t* is_bare = selection_.marks(all_nodes);
    any_.resize(1);
    executor_.for_each(all_nodes, bare_nodes(base, is_bare));
    keys_.resize(selection_.count());
    if (keys_.size() == 0) {
      return;
    }
    executor_.for_each(all_nodes,
                       ListBareCells<Nodes, Dim>{lattice, base.nodes, is_bare, selection_.before(), keys_.data()});
    sorted_keys_.resize(keys_.size());
    executor_.sort(keys_.data(), sorted_keys_.data(), keys_.size());
    unique_.find(sorted_keys_, 0, cells_, nullptr);
    std::uint32_t* is_kept = selection_.marks(cells_.size());
    executor_.for_each(cells_.size(), exec::Fill<std::uint32_t>{is_kept, 1});
    executor_.for_each(segments_.size(),
                       LeaveOutCovered<Dim>{lattice, segments_.data(), cells_.data(), cells_.size(), is_kept});
    selection_.keep(selection_.count(), cells_, bare_cells_);
    const std::size_t count = bare_cells_.size(), known = segments_.size();
    if (count == 0) {
      return;
    }
    segments_.grow(known + count);
    states_of_segments_.resize(count);
    areas_.resize(count);
    executor_.for_each(count,
                       CreateSegment<Ground, Dim>{lattice, base.ground, bare_cells_.data(), state_.next_id,
                                                  segments_.data() + known, states_of_segments_.data(), areas_.data()});
    state_.next_id += static_cast<std::int64_t>(count);
    locate(base.tables, segments_.data() + known, count);
    add_to_nodes(base.tables, true);
    sum_motion(base);
    Segment* created = segments_.data() + known;
    executor_.for_each(count, StartSegment<Ground, Dim>{base.tables, model_, gravity_, base.ground, records_.data(),
                                                        contact_.data(), stencils_.data(), created, areas_.data()});
    executor_.for_each(count, StartColumn<Dim>{model_, thickness, created, budgets_.parts(count)});
    executor_.for_each(count, SetVelocity<Dim>{base.tables, cell_, motion_.data(), stencils_.data(), created});
    state_.budget += budgets_.total();
    add_to_nodes(base.tables, true);
    locate(base.tables, segments_.data(), segments_.size());
  }

  template <class Nodes, class Ground, class Normals>
  void sum_motion(const BaseInStep<Nodes, Ground, Normals, Dim>& base) {
    motion_.resize(base.tables.blocks * Patch::nodes_of_layer);
    executor_.for_each(motion_.size(),
                       SumColumnMotion<Nodes, Normals, Dim>{base.tables, ground_block_.data(), base.nodes,
                                                            base.normal_at, motion_.data()});
  }

  // Updates segment velocities and stretches segments with the flow over the last `duration` [s]; then splits long
  // segments and merges small ones.
  template <class Nodes, class Ground, class Normals>
  void follow(const BaseInStep<Nodes, Ground, Normals, Dim>& base, double duration) {
    locate(base.tables, segments_.data(), segments_.size());
    sum_motion(base);
    const std::size_t count = segments_.size();
    executor_.for_each(
        count, FollowSlide<Ground, Dim>{base.tables, cell_, duration, base.ground, stencils_.data(), motion_.data(),
                                        segments_.data(), selection_.marks(count), budgets_.parts(count)});
    state_.budget += budgets_.total();
    keep_marked();
    split(base.ground);
    merge(base.ground);
    state_.checks_gaps = true;
  }
  void keep_marked() {
    if (const std::size_t count = selection_.count(); count < segments_.size()) {
      selection_.keep(count, segments_, kept_);
      segments_.swap(kept_);
    }
  }
  template <class Ground>
  void split(const Ground& ground) {
    constexpr double longest = 1.5;  // side of a segment along an axis, in cells
    const std::size_t count = segments_.size();
    const Splitting<Ground, Dim> splitting{longest * cell_, ground};
    numbers_.resize(count);
    executor_.for_each(count,
                       CountSplits<Ground, Dim>{splitting, segments_.data(), numbers_.data(), selection_.marks(count)});
    const std::size_t added = selection_.count();
    if (added == 0) {
      return;
    }
    segments_.grow(count + added);
    executor_.for_each(count, SplitLong<Ground, Dim>{splitting, count, state_.next_id, numbers_.data(),
                                                     selection_.before(), segments_.data()});
    state_.next_id += static_cast<std::int64_t>(added);
  }
  template <class Ground>
  void merge(const Ground& ground) {
    const std::size_t count = segments_.size();
    for (exec::Array<std::uint64_t, Executor>* keys : {&keys_, &sorted_keys_}) {
      keys->resize(count);
    }
    for (exec::Array<std::uint32_t, Executor>* numbers : {&numbers_, &by_block_}) {
      numbers->resize(count);
    }
    std::uint32_t* is_kept = selection_.marks(count);
    executor_.for_each(count,
                       LatticeCellOfSegment<Dim>{{cell_}, segments_.data(), keys_.data(), numbers_.data(), is_kept});
    executor_.sort(keys_.data(), numbers_.data(), sorted_keys_.data(), by_block_.data(), count);
    unique_.find(sorted_keys_, 0, cells_, &first_of_cell_);
    executor_.for_each(cells_.size(), MergeSmall<Ground, Dim>{model_, cell_, ground, count, cells_.size(),
                                                              first_of_cell_.data(), by_block_.data(), segments_.data(),
                                                              is_kept, budgets_.parts(cells_.size())});
    state_.budget += budgets_.total();
    keep_marked();
  }

  void step(double thickness, double duration) {
    executor_.for_each(segments_.size(), StepColumns<Dim>{model_, thickness, duration, segments_.data(),
                                                          budgets_.parts(segments_.size())});
    state_.budget += budgets_.total();
  }

  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  Executor& executor_;
  ColumnsModel model_;
  double cell_;
  Vector<double, Dim> gravity_;
  SegmentsState<Dim> state_;  // but for the segments
  exec::Array<Segment, Executor> segments_{executor_}, kept_{executor_};
  exec::Array<BaseStencil<Dim>, Executor> stencils_{executor_};  // of this step, by segment
  exec::Array<std::uint64_t, Executor> keys_{executor_}, sorted_keys_{executor_}, cells_{executor_},
      bare_cells_{executor_};
  exec::Array<std::uint32_t, Executor> numbers_{executor_}, by_block_{executor_}, first_of_block_{executor_},
      first_of_cell_{executor_}, any_{executor_};
  exec::Array<std::int32_t, Executor> ground_block_{executor_};
  exec::Array<BaseRecord<Dim>, Executor> states_of_segments_{executor_}, patches_{executor_}, records_{executor_};
  exec::Array<double, Executor> areas_{executor_};              // of segments, to be added to the nodes [m2]
  exec::Array<InContact, Executor> contact_{executor_};         // of nodes of layer 0
  exec::Array<ContactOfNode, Executor> divided_{executor_};     // the same
  exec::Array<ColumnMotion<Dim>, Executor> motion_{executor_};  // the same
  exec::Array<SegmentBelow, Executor> summaries_{executor_};
  exec::Selection<Executor> selection_{executor_};
  exec::UniqueKeys<Executor> unique_{executor_};
  exec::OrderedSum<ColumnLedger, Executor> budgets_{executor_};
  exec::OrderedSum<BaseSums, Executor> base_sums_{executor_};
};

}  // namespace thawslide::band
