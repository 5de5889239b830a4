// Data common to all stages of a step on a device: particles, cells, nodal records, and the passes over them.
#pragma once

#include <variant>
#include <vector>

#include "device/add_up.hpp"
#include "device/body_sizes.hpp"
#include "device/cells.hpp"
#include "device/ground.hpp"
#include "device/marks.hpp"
#include "device/node_memory.hpp"
#include "device/particles.hpp"
#include "device/tile_tables.hpp"
#include "mpm/kernel.hpp"
#include "mpm/prescribed_motion.hpp"

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

// Work of a block pass that calls solve(node, total) at the nodes of blocks with a mark. blocks: marks; null: all.
template <class Solve, int Dim>
struct SolveAtNodes {
  using Part = typename Solve::Totals;
  using Sum = Part;

  Solve solve;
  const std::uint8_t* blocks;

  THAWSLIDE_HD void visit(std::size_t node, Part& part) const {
    if (blocks == nullptr || blocks[node / static_cast<std::size_t>(mpm::Tile<Dim>::nodes)] != 0) {
      solve(node, part);
    }
  }
  THAWSLIDE_HD void add(const Part* parts, std::size_t count, Sum& sum) const {
    for (std::size_t k = 0; k < count; ++k) {
      sum += parts[k];
    }
  }
  THAWSLIDE_HD void operator()(std::size_t node) const {
    Part none;
    visit(node, none);
  }
};

// Kernel that adds up Of::Sums: a function of one particle, of(particles, particle).
template <class Of>
struct SumOf {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = typename Of::Sums;

  Of of;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& sums) const {
    sums = of(particles, at.particle[0]);
  }
};

// Kernel for the particles of one material.
template <class Kernel>
struct OfMaterial {
  using Reads = typename Kernel::Reads;
  using Adds = typename Kernel::Adds;
  using Totals = typename Kernel::Totals;

  Kernel kernel;
  std::int32_t number;  // of the material
  bool is_only_one;     // all particles have this material

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& seen, Scatter& added,
                               Totals& totals) const {
    if (is_only_one || particles.material(at.particle[0]) == number) {
      kernel(particles, at, seen, added, totals);
    }
  }
};

// Shape: shape functions of momentum (mpm/shape.hpp).
template <class Backend, class Shape, int Dim>
class StepPasses {
 public:
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  // Copies `count` particles from CPU memory.
  StepPasses(Backend& used, const StepModel<Dim>& known, const mpm::ParticleView<Dim>& of_cpu, std::size_t count,
             const GroundQuery<Dim>& query_ground)
      : backend(used),
        model(known),
        particles(used, of_cpu, count),
        cells(used, known.cell, known.mapping),
        ground(used, query_ground),
        sizes_(used, known.half_sizes, 1.0) {
    conditions_.set(known.conditions);
    places_.set(known.width.places());
    relative_widths_.set(known.width.relative());
  }
  StepPasses(const StepPasses&) = delete;
  StepPasses& operator=(const StepPasses&) = delete;

  Backend& backend;
  StepModel<Dim> model;
  Particles<Backend, Dim> particles;
  Cells<Backend, Dim> cells;
  Ground<Backend, Dim> ground;
  NodeMemory<Backend, Dim> nodes{backend};
  PassMemory<Backend> memory{backend};
  Marks<Backend, Dim> marks{backend};

  [[nodiscard]] double cell() const { return model.cell; }
  [[nodiscard]] mpm::WidthView width() const { return {places_.data(), relative_widths_.data(), places_.size()}; }
  [[nodiscard]] mpm::SizesOfBodies body_sizes() const { return sizes_.view(); }  // in cells
  [[nodiscard]] MomentumWeights<Shape, Dim> weights() const { return {sizes_.view(), model.motion.sides}; }
  // Pass arguments with linear shape functions, or with those of momentum.
  template <class TileFilter = AllTiles>
  [[nodiscard]] auto linear(const TileFilter& accepts = {}) const {
    return over(LinearWeights{}, accepts);
  }
  template <class TileFilter = AllTiles>
  [[nodiscard]] auto momentum(const TileFilter& accepts = {}) const {
    return over(weights(), accepts);
  }
  [[nodiscard]] auto affine() const { return over(AffineWeights<Shape, Dim>{weights()}, AllTiles{}); }
  template <class Weights, class TileFilter>
  [[nodiscard]] PassOver<Weights, TileFilter, Dim> over(const Weights& weights, const TileFilter& accepts) const {
    return {cells.tables(), particles.view(), weights, accepts, model.cell, model.mapping};
  }
  template <class Over, class... Kernels>
  SumsOf<Kernels...>* run(const Over& over, const Kernels&... kernels) {
    return particle_pass(backend, memory, over, *this, kernels...);
  }
  template <class Over, class Kernel>
  void total(const Over& over, const Kernel& kernel, typename Kernel::Totals* to) {
    keep(&run(over, kernel)->template of<Kernel>(), to);
  }
  template <class Over, class Kernel>
  void add_total(const Over& over, const Kernel& kernel, typename Kernel::Totals* to) {
    backend.for_each(1, Add<typename Kernel::Totals>{&run(over, kernel)->template of<Kernel>(), to});
  }
  // As in mpm::StepPasses, in one pass per material.
  template <class Over, class Kernels, class Totals>
  void add_total_by_material(const Over& over, const std::vector<Kernels>& by_material, Totals* to) {
    for (std::size_t k = 0; k < by_material.size(); ++k) {
      std::visit(
          [&]<class Kernel>(const Kernel& kernel) {
            add_total(over, OfMaterial<Kernel>{kernel, static_cast<std::int32_t>(k), by_material.size() == 1}, to);
          },
          by_material[k]);
    }
  }
  template <class... Names>
  void resize_records() {
    nodes.template resize_for<Names...>(cells.tables().blocks * block_nodes);
  }
  template <class Name>
  void sum_all() {
    sum<Name, void>(AllTiles{});
  }
  // blocks: marks of those to sum at; null: all.
  template <class Name, class MinReduced, class TileFilter>
  void sum(const TileFilter& accepts, const std::uint8_t* blocks = nullptr) {
    backend.for_each(of<Name>().size(), SumPatches<Name, MinReduced, TileFilter, Dim>{
                                            cells.tables(), accepts, blocks, memory.patches(0), of<Name>().data()});
  }
  // As mpm::StepPasses::solve. Returns a pointer to the total, valid until the next pass, if there is one.
  template <class Name, class Solve>
  auto solve(const std::uint8_t* blocks, const Solve& solve, bool others = false) {
    sum<Name, void>(AllTiles{}, blocks);
    const std::size_t all = cells.tables().blocks;
    const SolveAtNodes<Solve, Dim> work{solve, others ? nullptr : blocks};
    if constexpr (std::is_same_v<typename Solve::Totals, mpm::NoTotals>) {
      backend.for_each(all * block_nodes, work);
    } else {
      using Totals = typename Solve::Totals;
      return block_pass<Dim>(backend, all, work, memory.template sums<Totals>(partial_sum_count(all)));
    }
  }
  // of: as in SumOf.
  template <class Of>
  typename Of::Sums sum_over_particles(const Of& of) {
    typename Of::Sums sums;
    backend.copy_out(&sums, &run(linear(), SumOf<Of>{of})->template of<SumOf<Of>>(), 1);
    return sums;
  }
  // Copies a sum from memory that the next pass reuses.
  template <class Sum>
  void keep(const Sum* from, std::type_identity_t<Sum>* to) {
    backend.for_each(1, Keep<Sum>{from, to});
  }
  // Only the device knows counts.
  [[nodiscard]] static bool is_known_zero(const std::uint64_t* /*count*/) { return false; }

  // As in mpm::StepPasses.
  template <class Condition>
  void mark(const Condition& condition) {
    mark_tiles(condition);
    marks.mark_blocks(cells.tables());
  }
  template <class Condition>
  [[nodiscard]] bool mark_around(const Condition& condition) {
    mark(condition);
    return marks.mark_tiles_about(cells.tables());
  }
  template <class Condition>
  [[nodiscard]] MarkedTiles in_reach(const Condition& condition) {
    mark_tiles(condition);
    return marks.tiles();
  }
  [[nodiscard]] MarkedTiles marked_tiles() const { return marks.tiles(); }
  [[nodiscard]] const std::uint8_t* marked_blocks() const { return marks.blocks(); }

  template <class Name>
  [[nodiscard]] exec::Array<double, Backend>& of() {
    return nodes.template of<Name>();
  }
  [[nodiscard]] auto node_access() {
    return nodes.template access<mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::Contact, mpm::HeatRates,
                                 mpm::SecantRates, mpm::UnreachedHeat, mpm::Seepage, mpm::SeepingWater,
                                 mpm::FilterMoments, mpm::FilterMomentum, mpm::FilterIncrement, mpm::FilterTotal>(
        cells.tables().block_keys, model.cell);
  }
  [[nodiscard]] ContactNodes<Dim> contact_nodes() {
    return nodes.template access<mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::NearGround, mpm::BaseLoad,
                                 mpm::Contact, mpm::Motion, mpm::Velocity>(cells.tables().block_keys, model.cell);
  }
  [[nodiscard]] mpm::PrescribedMotion<Dim> prescribed_motion() const {
    return {conditions_.data(), conditions_.size()};
  }
  [[nodiscard]] mpm::BlockTables<Dim> block_tables() const {
    const TileTables<Dim> tables = cells.tables();
    return {tables.blocks, tables.block_keys, tables.blocks_about_block};
  }

  // Nodal records that a pass reads (device/passes.hpp).
  template <class Name>
  [[nodiscard]] const double* numbers() const {
    if constexpr (std::is_same_v<Name, mpm::Planes>) {
      return ground.records();
    } else {
      return nodes.template of<typename mpm::OwnerOf<Name>::Type>().data();
    }
  }

 private:
  template <class Condition>
  void mark_tiles(const Condition& condition) {
    const double* records = nullptr;
    if constexpr (!std::is_void_v<typename Condition::Reads>) {
      records = numbers<typename Condition::Reads>();
    }
    marks.mark_tiles(cells.tables(), particles.view(), records, condition);
  }

  BodySizes<Backend> sizes_;
  exec::Array<mpm::NodeCondition<Dim>, Backend> conditions_{backend};
  exec::Array<double, Backend> places_{backend}, relative_widths_{backend};
};

}  // namespace thawslide::device
