// Exchange of basal segments with contact nodes: state of the base at nodes, and contact of segments.
#include <algorithm>
#include <array>

#include "band/basal_segments.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

using mpm::BaseState;
using mpm::Contact;

namespace {

// Number of the block on the ground in the column of block b, or KeyIndex::absent.
template <int Dim>
std::int32_t block_on_ground(const mpm::SparseGrid<Dim>& grid, std::size_t b) {
  using T = mpm::Tile<Dim>;
  auto tile = T::index(grid.blocks()[b]);
  if (tile[Dim - 1] == 0) {
    return static_cast<std::int32_t>(b);
  }
  tile[Dim - 1] = 0;
  return grid.block_at(T::key(tile));
}

}  // namespace

// Stencils of all segments, and the segments above each block, in ascending order.
template <int Dim>
void BasalSegments<Dim>::locate(const mpm::SparseGrid<Dim>& grid) {
  stencils_.resize(segments_.size());
  parallel_for(segments_.size(), [&](std::size_t p) { stencils_[p] = Stencil(grid, segments_[p].position); });
  first_of_block_.assign(grid.blocks().size() + 1, 0);
  for (const Stencil& stencil : stencils_) {
    if (stencil.block() != KeyIndex::absent) {
      ++first_of_block_[static_cast<std::size_t>(stencil.block())];
    }
  }
  std::uint32_t end = 0;
  for (std::uint32_t& number : first_of_block_) {
    end += number;
    number = end;  // end of the block's segments, for now
  }
  by_block_.resize(end);
  for (std::size_t p = stencils_.size(); p-- > 0;) {
    if (stencils_[p].block() != KeyIndex::absent) {
      by_block_[--first_of_block_[static_cast<std::size_t>(stencils_[p].block())]] = static_cast<std::uint32_t>(p);
    }
  }
}

template <int Dim>
void BasalSegments<Dim>::to_nodes(const mpm::SparseGrid<Dim>& grid, mpm::Nodes<Dim>& nodes) {
  using Record = typename mpm::RecordsOf<BaseState, Dim>::Record;
  locate(grid);
  patches_.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!has_segments(b)) {
      return;
    }
    auto& patch = patches_[b];
    patch.fill({});
    for_each_segment(b, [&](std::size_t p) {
      const Segment& segment = segments_[p];
      const physics::BandMeans means = current_means(segment);
      Record of_segment{};  // per area of the segment
      of_segment[BaseState::area] = 1.0;
      of_segment[BaseState::temperature] = means.temperature;
      of_segment[BaseState::pressure_ratio] = pressure_ratio(means, segment);
      of_segment[BaseState::saturation] = means.saturation;
      of_segment[BaseState::solid_fraction] = means.solid_fraction;
      of_segment[BaseState::slip] = segment.slip;
      stencils_[p].for_each([&](std::size_t place, double weight) THAWSLIDE_INLINE_LAMBDA {
        const double fraction = weight * segment.area;
        for (std::size_t c = 0; c < of_segment.size(); ++c) {
          patch[place][c] += fraction * of_segment[c];
        }
      });
    });
  });
  nodes.base_state.allocate(grid.blocks().size(), [&](std::size_t b) { return nodes.near_ground.contains(b); });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!nodes.base_state.contains(b)) {
      return;
    }
    Record* records = nodes.base_state.of_block(b);
    std::fill_n(records, nodes.base_state.nodes, Record{});
    Patch::for_each_patch(grid, b, [&](std::size_t block, std::size_t node, std::size_t place) {
      for (std::size_t c = 0; has_segments(block) && c < records[node].size(); ++c) {
        records[node][c] += patches_[block][place][c];
      }
    });
  });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    const std::int32_t on_ground = nodes.base_state.contains(b) ? block_on_ground(grid, b) : KeyIndex::absent;
    if (on_ground != KeyIndex::absent && static_cast<std::size_t>(on_ground) != b) {
      for (std::size_t k = 0; k < nodes.base_state.nodes; ++k) {
        nodes.base_state.of_block(b)[k] =
            nodes.base_state(static_cast<std::size_t>(on_ground), k % Patch::nodes_of_layer);
      }
    }
  });
}

// Contact of each node on the ground and of the nodes below it, which particles reach that have sunk in.
template <int Dim>
void BasalSegments<Dim>::sum_contact(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes) {
  contact_.resize(grid.blocks().size() * Patch::nodes_of_layer);
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!nodes.contact.contains(b) || block_on_ground(grid, b) != static_cast<std::int32_t>(b)) {
      return;
    }
    InContact* sums = &contact_[b * Patch::nodes_of_layer];
    std::fill_n(sums, Patch::nodes_of_layer, InContact{});
    auto below = static_cast<std::int32_t>(b);
    for (std::size_t count = Patch::nodes_of_layer; below != KeyIndex::absent; count = nodes.contact.nodes) {
      const auto block = static_cast<std::size_t>(below);
      for (std::size_t k = 0; k < count; ++k) {
        const auto& contact = nodes.contact(block, k);
        if (contact[Contact::touching] > 0.0) {
          InContact& sum = sums[k % Patch::nodes_of_layer];
          sum.area += contact[Contact::area];
          sum.normal_force += contact[Contact::normal_force];
          sum.slip += contact[Contact::area] * contact[Contact::slip_speed];
          sum.friction_heat += contact[Contact::friction_heat];
        }
      }
      below = grid.blocks_about_block(block)[mpm::Tile<Dim>::stencil / 2 - mpm::power(3, Dim - 1)];
    }
  });
}

// Adds a multiple of a segment's area to the nodes in reach.
template <int Dim>
void BasalSegments<Dim>::add_area(const mpm::SparseGrid<Dim>& grid, const Stencil& stencil, const Segment& segment,
                                  mpm::Nodes<Dim>& nodes, double fraction) const {
  const auto at = Patch::nodes_at(grid, stencil.block());
  stencil.for_each([&](std::size_t place, double weight) {
    if (at[place].block != KeyIndex::absent) {
      nodes.base_state.of_block(static_cast<std::size_t>(at[place].block))[at[place].node][BaseState::area] +=
          fraction * weight * segment.area;
    }
  });
}

// Contact area and force attributed to a segment: nodes distribute theirs over the segments in reach.
template <int Dim>
typename BasalSegments<Dim>::InContact BasalSegments<Dim>::in_contact(const mpm::SparseGrid<Dim>& grid,
                                                                      const Stencil& stencil,
                                                                      const mpm::Nodes<Dim>& nodes,
                                                                      const Segment& segment) const {
  InContact result;
  const auto at = Patch::nodes_at(grid, stencil.block());
  stencil.for_each([&](std::size_t place, double weight) {
    if (at[place].block == KeyIndex::absent) {
      return;
    }
    const auto block = static_cast<std::size_t>(at[place].block);
    if (const double seen = nodes.base_state(block, at[place].node)[BaseState::area]; seen > 0.0) {
      const InContact& contact = contact_[block * Patch::nodes_of_layer + at[place].node];
      const double fraction = weight * segment.area / seen;
      result.area += fraction * contact.area;
      result.normal_force += fraction * contact.normal_force;
    }
  });
  return result;
}

template <int Dim>
void BasalSegments<Dim>::gather_from_nodes(const mpm::SparseGrid<Dim>& grid, std::size_t b, double dt,
                                           const mpm::Nodes<Dim>& nodes) {
  // of a node: contact, and heat [W/m2] and load [Pa] per area of the segments in reach; as many as fill a register
  enum : std::size_t { normal_force, area, slip, heat, pressure, count = 8 };
  using AtNode = std::array<double, count>;
  std::array<AtNode, Patch::nodes> patch{};
  Patch::for_each_node(grid, b, [&](std::size_t block, std::size_t node, std::size_t place) {
    if (const double seen = nodes.base_state(block, node)[BaseState::area]; seen > 0.0) {
      const InContact& contact = contact_[block * Patch::nodes_of_layer + node];
      patch[place] = {contact.normal_force, contact.area, contact.slip, contact.friction_heat / seen,
                      contact.normal_force / seen};
    }
  });
  for_each_segment(b, [&](std::size_t p) {
    AtNode around{};
    stencils_[p].for_each([&](std::size_t place, double weight) THAWSLIDE_INLINE_LAMBDA {
      for (std::size_t c = 0; c < count; ++c) {
        around[c] += weight * patch[place][c];
      }
    });
    take_contact({around[area], around[normal_force], around[slip]}, around[heat], around[pressure], dt, segments_[p]);
  });
}

// around: weighted sums over the nodes around the segment. heat, pressure: per area of the segment [W/m2], [Pa].
template <int Dim>
void BasalSegments<Dim>::take_contact(const InContact& around, double heat, double pressure, double dt,
                                      Segment& segment) const {
  if (segment.touched || around.area > 0.0) {
    update_load(around.area > 0.0 ? around.normal_force / around.area : 0.0, pressure, dt, segment);
  }
  segment.speed = around.area > 0.0 ? around.slip / around.area : 0.0;
  segment.slip += dt * segment.speed;
  segment.heat += dt * heat * segment.area;
}

// The flow depth follows from the load borne by the segment [Pa]: its part of the nodal normal forces, which are
// distributed over segments completely. N equals this load under full contact and exceeds it if the sliding mass has
// holes. If gravity does not press on the ground, the depth is undefined; the largest thickness is used.
template <int Dim>
void BasalSegments<Dim>::update_load(double normal_pressure, double borne, double dt, Segment& segment) const {
  const double weight = model_.density * gravity_.dot(segment.normal);  // [N/m3]
  follow_load(model_, normal_pressure, weight > 0.0 ? borne / weight : model_.largest_thickness, dt, segment);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                   \
  template void BasalSegments<Dim>::locate(const mpm::SparseGrid<Dim>&);                                             \
  template void BasalSegments<Dim>::to_nodes(const mpm::SparseGrid<Dim>&, mpm::Nodes<Dim>&);                         \
  template void BasalSegments<Dim>::sum_contact(const mpm::SparseGrid<Dim>&, const mpm::Nodes<Dim>&);                \
  template void BasalSegments<Dim>::add_area(const mpm::SparseGrid<Dim>&, const BaseStencil<Dim>&,                   \
                                             const BasalSegment<Dim>&, mpm::Nodes<Dim>&, double) const;              \
  template typename BasalSegments<Dim>::InContact BasalSegments<Dim>::in_contact(                                    \
      const mpm::SparseGrid<Dim>&, const BaseStencil<Dim>&, const mpm::Nodes<Dim>&, const BasalSegment<Dim>&) const; \
  template void BasalSegments<Dim>::gather_from_nodes(const mpm::SparseGrid<Dim>&, std::size_t, double,              \
                                                      const mpm::Nodes<Dim>&);                                       \
  template void BasalSegments<Dim>::update_load(double, double, double, BasalSegment<Dim>&) const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
