// Exchange of basal segments with contact nodes: state of the base at nodes, and contact of segments. Kernels for host
// and device.
#pragma once

#include "band/base_stencil.hpp"
#include "band/segment_step.hpp"
#include "mpm/base_states.hpp"

namespace thawslide::band {

using mpm::BaseState, mpm::Contact;

template <int Dim>
using BaseRecord = std::array<double, mpm::BaseStates<Dim>::size>;

// Segments above each block on the ground, in ascending order.
struct SegmentsOfBlocks {
  const std::uint32_t* first;    // of a block, in `segments`; with the end appended
  const std::uint32_t* segment;  // by block

  [[nodiscard]] THAWSLIDE_HD bool any(std::size_t block) const { return first[block] < first[block + 1]; }
};

// One thread per segment. Segments that are above no active block follow the others.
template <int Dim>
struct LocateSegment {
  mpm::BlockTables<Dim> tables;
  double cell;
  const BasalSegment<Dim>* segments;
  BaseStencil<Dim>* stencils;
  std::uint64_t* block;
  std::uint32_t* number;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    stencils[p] = BaseStencil<Dim>(tables, cell, segments[p].position);
    block[p] = stencils[p].block() == exec::absent ? tables.blocks : static_cast<std::uint64_t>(stencils[p].block());
    number[p] = static_cast<std::uint32_t>(p);
  }
};
// block: of the segments, ascending. One thread per block, and one for the end.
struct FirstOfBlock {
  const std::uint64_t* block;
  std::size_t segments;
  std::uint32_t* first;

  THAWSLIDE_HD void operator()(std::size_t b) const {
    first[b] = static_cast<std::uint32_t>(exec::first_not_below(block, 0, segments, b));
  }
};

// State of a segment, per area. One thread per segment.
template <int Dim>
struct StateOfSegment {
  const BasalSegment<Dim>* segments;
  BaseRecord<Dim>* states;
  double* areas;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    const BasalSegment<Dim>& segment = segments[p];
    const physics::BandMeans means = current_means(segment);
    BaseRecord<Dim> state{};
    state[BaseState::area] = 1.0;
    state[BaseState::temperature] = means.temperature;
    state[BaseState::pressure_ratio] = pressure_ratio(means, segment);
    state[BaseState::saturation] = means.saturation;
    state[BaseState::solid_fraction] = means.solid_fraction;
    state[BaseState::slip] = segment.slip;
    states[p] = state;
    areas[p] = segment.area;
  }
};
// Sums the states of the segments above a block, times their area, in one row of its patch. One thread per block and
// row.
template <int Dim>
struct AddToPatch {
  static constexpr std::size_t of_task = 64;
  using Patch = BasePatch<Dim>;

  SegmentsOfBlocks of_block;
  const BaseStencil<Dim>* stencils;
  const BaseRecord<Dim>* states;
  const double* areas;
  BaseRecord<Dim>* patches;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t b = k / Patch::rows, row = k % Patch::rows;
    if (!of_block.any(b)) {
      return;
    }
    BaseRecord<Dim> sums[Patch::edge] = {};
    for (std::uint32_t n = of_block.first[b]; n < of_block.first[b + 1]; ++n) {
      const std::uint32_t p = of_block.segment[n];
      stencils[p].for_each_in_row(static_cast<int>(row), [&](int x, double weight) THAWSLIDE_INLINE_LAMBDA {
        const double part = weight * areas[p];
        for (std::size_t c = 0; c < sums[x].size(); ++c) {
          sums[x][c] += part * states[p][c];
        }
      });
    }
    for (std::size_t x = 0; x < Patch::edge; ++x) {
      patches[b * Patch::nodes + row * Patch::edge + x] = sums[x];
    }
  }
};
// Block of layer 0 in the column of a block on the ground or below it, as in mpm::BaseStates. One thread per block.
template <int Dim>
struct FindGroundBlock {
  using T = mpm::Tile<Dim>;

  mpm::BlockTables<Dim> tables;
  std::int32_t* ground_block;

  THAWSLIDE_HD void operator()(std::size_t b) const {
    auto tile = T::index(tables.block_keys[b]);
    std::int32_t found = tile[Dim - 1] == 0 ? static_cast<std::int32_t>(b) : exec::absent;
    if (tile[Dim - 1] < 0) {
      tile[Dim - 1] = 0;
      found = exec::index_of_key(tables.block_keys, tables.blocks, T::key(tile));
      found = found == exec::absent ? static_cast<std::int32_t>(tables.blocks) : found;
    }
    ground_block[b] = found;
  }
};
// Sums the patches at the nodes of layer 0. One thread per block and node, and one more block of zeros.
template <int Dim>
struct SumPatches {
  using Patch = BasePatch<Dim>;

  mpm::BlockTables<Dim> tables;
  const std::int32_t* ground_block;
  SegmentsOfBlocks of_block;
  const BaseRecord<Dim>* patches;
  bool adds;  // to the present records
  BaseRecord<Dim>* records;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t b = k / Patch::nodes_of_layer, node = k % Patch::nodes_of_layer;
    BaseRecord<Dim> sum = adds ? records[k] : BaseRecord<Dim>{};
    const bool is_on_ground = b < tables.blocks && static_cast<std::size_t>(ground_block[b]) == b;
    for (int direction = 0; is_on_ground && direction < Patch::directions; ++direction) {
      const std::int32_t other = Patch::block_about(tables, b, direction);
      const std::int32_t place = Patch::place_in(direction, node);
      if (other == exec::absent || place == exec::absent || !of_block.any(static_cast<std::size_t>(other))) {
        continue;
      }
      const BaseRecord<Dim>& part =
          patches[static_cast<std::size_t>(other) * Patch::nodes + static_cast<std::size_t>(place)];
      for (std::size_t c = 0; c < sum.size(); ++c) {
        sum[c] += part[c];
      }
    }
    records[k] = sum;
  }
};

// Contact of a node of layer 0 with those below it, or the part of a segment.
struct InContact {
  double area = 0, normal_force = 0;   // [m2], [N]
  double slip = 0, friction_heat = 0;  // slip speed times area [m3/s], [W]
};
// Particles that have sunk in reach the nodes below the ground. One thread per block and node of layer 0.
template <class Nodes, int Dim>
struct SumContact {
  using Patch = BasePatch<Dim>;

  mpm::BlockTables<Dim> tables;
  const std::int32_t* ground_block;
  Nodes nodes;
  InContact* sums;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t b = k / Patch::nodes_of_layer, node = k % Patch::nodes_of_layer;
    if (static_cast<std::size_t>(ground_block[b]) != b) {
      return;
    }
    InContact sum;
    add(b, node, sum);
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    constexpr std::size_t below = stencil / 2 - static_cast<std::size_t>(Patch::directions);
    std::int32_t block = tables.blocks_about_block[b * stencil + below];
    while (block != exec::absent) {
      const auto at = static_cast<std::size_t>(block);
      for (std::size_t in_block = node; in_block < mpm::Tile<Dim>::nodes; in_block += Patch::nodes_of_layer) {
        add(at, in_block, sum);
      }
      block = tables.blocks_about_block[at * stencil + below];
    }
    sums[k] = sum;
  }

 private:
  THAWSLIDE_HD void add(std::size_t block, std::size_t node, InContact& sum) const {
    const double* contact = nodes.template read<Contact>(nodes.node(block, node));
    if (contact[Contact::touching] > 0.0) {
      sum.area += contact[Contact::area];
      sum.normal_force += contact[Contact::normal_force];
      sum.slip += contact[Contact::area] * contact[Contact::slip_speed];
      sum.friction_heat += contact[Contact::friction_heat];
    }
  }
};

// Contact of a node in the form that segments average: with heat [W/m2] and load [Pa] per area of the segments in
// reach; as many numbers as fill a register.
struct ContactOfNode {
  enum : std::size_t { normal_force, area, slip, heat, load, count = 8 };
  double number[count] = {};
};
// One thread per block and node of layer 0.
template <int Dim>
struct DivideContact {
  const std::int32_t* ground_block;
  const BaseRecord<Dim>* records;
  const InContact* contact;
  ContactOfNode* divided;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t b = k / BasePatch<Dim>::nodes_of_layer;
    if (static_cast<std::size_t>(ground_block[b]) != b) {
      return;
    }
    const double seen = records[k][BaseState::area];
    const InContact& of_node = contact[k];
    divided[k] = seen > 0.0 ? ContactOfNode{{of_node.normal_force, of_node.area, of_node.slip,
                                             of_node.friction_heat / seen, of_node.normal_force / seen}}
                            : ContactOfNode{};
  }
};

// The flow depth follows from the load borne by the segment [Pa]: its part of the nodal normal forces, which are
// distributed over segments completely. N equals this load under full contact and exceeds it if the sliding mass has
// holes. If gravity does not press on the ground, the depth is undefined; the largest thickness is used.
template <int Dim>
THAWSLIDE_HD void update_load(const ColumnsModel& model, const Vector<double, Dim>& gravity, double normal_pressure,
                              double borne, double dt, BasalSegment<Dim>& segment) {
  const double weight = model.density * gravity.dot(segment.normal);  // [N/m3]
  follow_load(model, normal_pressure, weight > 0.0 ? borne / weight : model.largest_thickness, dt, segment);
}

// Applies contact over dt to a segment (load, heat, slip), then moves it. One thread per segment.
template <int Dim>
struct GatherContact {
  static constexpr std::size_t of_task = 64;

  mpm::BlockTables<Dim> tables;
  ColumnsModel model;
  Vector<double, Dim> gravity;
  double dt;
  const BaseStencil<Dim>* stencils;
  const ContactOfNode* nodes;
  BasalSegment<Dim>* segments;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    BasalSegment<Dim>& segment = segments[p];
    ContactOfNode around;
    stencils[p].for_each_node(tables, [&](const auto& node, double weight) THAWSLIDE_INLINE_LAMBDA {
      for (std::size_t c = 0; c < ContactOfNode::count; ++c) {
        around.number[c] += weight * nodes[node.number()].number[c];
      }
    });
    const double area = around.number[ContactOfNode::area];
    if (segment.touched || area > 0.0) {
      update_load(model, gravity, area > 0.0 ? around.number[ContactOfNode::normal_force] / area : 0.0,
                  around.number[ContactOfNode::load], dt, segment);
    }
    segment.speed = area > 0.0 ? around.number[ContactOfNode::slip] / area : 0.0;
    segment.slip += dt * segment.speed;
    segment.heat += dt * around.number[ContactOfNode::heat] * segment.area;
    segment.position += dt * segment.velocity;
  }
};

}  // namespace thawslide::band
