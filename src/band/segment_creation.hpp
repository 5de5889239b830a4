// Creation of basal segments where the sliding mass reaches ground without segments. Kernels for host and device.
#pragma once

#include "band/segment_exchange.hpp"
#include "band/segment_motion.hpp"

namespace thawslide::band {

// Marks the nodes in contact that need a segment in their lattice cell: those out of reach of all segments, and those
// with a contact area large enough. One thread per node of all blocks.
template <class Nodes, class Ground, int Dim>
struct FindBareNodes {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  mpm::BaseStates<Dim> states;
  double cell;
  Nodes nodes;
  Ground ground;
  std::uint32_t* is_bare;  // null: not required
  std::uint32_t* any;      // set to 1 if a node is out of reach

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t b = k / block_nodes, node = k % block_nodes;
    const bool is_above = states.ground_block[b] == exec::absent;
    const bool touches = !is_above && nodes.template read<Contact>(nodes.node(b, node))[Contact::touching] > 0.0;
    const bool is_unseen = touches && !(states.at(b, node)[BaseState::area] > 0.0);
    if (is_unseen) {
      exec::set_mark(*any, 1);
    }
    if (is_bare != nullptr) {
      is_bare[k] = is_unseen || (touches && is_large(nodes.node(b, node))) ? 1 : 0;
    }
  }

 private:
  template <class Node>
  [[nodiscard]] THAWSLIDE_HD bool is_large(const Node& node) const {
    const double face = Dim == 2 ? cell : cell * cell;
    const Vector<double, Dim - 1> foot = nodes.position(node).template head<Dim - 1>();
    return nodes.template read<Contact>(node)[Contact::area] > 0.25 * face * ground.width(foot);
  }
};
// Lattice cells of those nodes. One thread per node of all blocks.
template <class Nodes, int Dim>
struct ListBareCells {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  Lattice<Dim> lattice;
  Nodes nodes;
  const std::uint32_t *is_bare, *before;
  std::uint64_t* key;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    if (is_bare[k] != 0) {
      key[before[k]] = lattice.key(nodes.position(nodes.node(k / block_nodes, k % block_nodes)));
    }
  }
};
// Removes the cells that a segment covers. A segment covers a cell if their centres differ by less than three quarters
// of a cell along each axis. cells: ascending. One thread per segment.
template <int Dim>
struct LeaveOutCovered {
  Lattice<Dim> lattice;
  const BasalSegment<Dim>* segments;
  const std::uint64_t* cells;
  std::size_t count;
  std::uint32_t* is_kept;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    const Vector<double, Dim>& position = segments[p].position;
    const std::uint64_t own = lattice.key(position);
    for (int row = 0; row < mpm::power(3, Dim - 2); ++row) {
      const std::uint64_t middle = own + (Dim == 3 ? (static_cast<std::uint64_t>(row) << Lattice<Dim>::bits) -
                                                         (std::uint64_t{1} << Lattice<Dim>::bits)
                                                   : 0);
      for (std::size_t k = exec::first_not_below(cells, 0, count, middle - 1); k < count && cells[k] <= middle + 1;
           ++k) {
        double furthest = 0;  // in cells
        for (int a = 0; a + 1 < Dim; ++a) {
          const double centre = static_cast<double>(Lattice<Dim>::along(cells[k], a)) + 0.5;
          furthest = max(furthest, std::abs(lattice.in_cells(position[a]) - centre));
        }
        if (furthest < 0.75) {
          exec::set_mark(is_kept[k], 0);
        }
      }
    }
  }
};

// Creates a segment on each cell, without its column. One thread per cell.
template <class Ground, int Dim>
struct CreateSegment {
  Lattice<Dim> lattice;
  Ground ground;
  const std::uint64_t* cells;
  std::int64_t next_id;
  BasalSegment<Dim>* created;
  BaseRecord<Dim>* states;
  double* areas;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    Vector<double, Dim - 1> middle;
    for (int a = 0; a + 1 < Dim; ++a) {
      middle[a] = (static_cast<double>(Lattice<Dim>::along(cells[k], a)) + 0.5) * lattice.cell;
    }
    const auto below = ground.below(middle);
    BasalSegment<Dim> segment;
    segment.id = next_id + static_cast<std::int64_t>(k);
    segment.normal = below.normal;
    segment.position.template head<Dim - 1>() = middle;
    segment.position[Dim - 1] = below.height;
    segment.sides = sides_on<Dim>(segment.normal, Vector<double, Dim - 1>::Constant(lattice.cell));
    segment.area = segment.area_of_column = area_on(ground, segment);
    segment.column = {};
    created[k] = segment;
    states[k] = BaseRecord<Dim>{};
    states[k][BaseState::area] = 1.0;
    areas[k] = segment.area;
  }
};
// Sets the area and load of a new segment from its contact area and force: nodes distribute theirs over the segments in
// reach. At the edge of the sliding mass, a segment is smaller than its lattice cell. One thread per new segment.
template <class Ground, int Dim>
struct StartSegment {
  static constexpr std::size_t of_task = 16;

  mpm::BlockTables<Dim> tables;
  ColumnsModel model;
  Vector<double, Dim> gravity;
  Ground ground;
  const BaseRecord<Dim>* records;
  const InContact* contact;
  const BaseStencil<Dim>* stencils;
  BasalSegment<Dim>* created;
  double* areas;  // change

  THAWSLIDE_HD void operator()(std::size_t k) const {
    BasalSegment<Dim>& segment = created[k];
    InContact around;
    stencils[k].for_each_node(tables, [&](const auto& node, double weight) {
      if (const double seen = records[node.number()][BaseState::area]; seen > 0.0) {
        const double fraction = weight * segment.area / seen;
        around.area += fraction * contact[node.number()].area;
        around.normal_force += fraction * contact[node.number()].normal_force;
      }
    });
    const double fraction = min(max(around.area / segment.area, 0.1), 1.0);
    areas[k] = (fraction - 1.0) * segment.area;
    segment.sides *= edge_of_face<Dim>(fraction);
    segment.area = segment.area_of_column = area_on(ground, segment);
    update_load(model, gravity, around.area > 0.0 ? around.normal_force / around.area : 0.0,
                around.normal_force / segment.area, 0.0, segment);
  }
};
// One thread per new segment.
template <int Dim>
struct StartColumn {
  static constexpr std::size_t of_task = 16;

  ColumnsModel model;
  double thickness;
  BasalSegment<Dim>* created;
  ColumnLedger* budgets;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    BasalSegment<Dim>& segment = created[k];
    start_column_of(model, thickness, segment);
    keep_means(model, segment);
    ColumnLedger budget;
    budget.created_heat = segment.area * physics::heat_of(segment.column);
    budget.created_water = segment.area * physics::water_of(segment.column);
    budgets[k] = budget;
  }
};
// One thread per new segment.
template <int Dim>
struct SetVelocity {
  mpm::BlockTables<Dim> tables;
  double cell;
  const ColumnMotion<Dim>* motion;
  const BaseStencil<Dim>* stencils;
  BasalSegment<Dim>* created;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    created[k].velocity = slide_near(tables, cell, stencils[k], motion, created[k].normal).velocity;
  }
};

}  // namespace thawslide::band
