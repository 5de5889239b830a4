// Creation of basal segments where the sliding mass reaches ground without segments.
#include <algorithm>
#include <atomic>

#include "band/basal_segments.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

using mpm::BaseState;
using mpm::Contact;

namespace {

constexpr double highest_part = 1.5;  // height of a part of a lattice cell on steep ground, in cells
constexpr double most_parts = 64.0;   // parts of such a cell, on nearly vertical ground

}  // namespace

template <int Dim>
typename BasalSegments<Dim>::Lattice BasalSegments<Dim>::lattice_cell(const mpm::SparseGrid<Dim>& grid,
                                                                      const Vector<Real, Dim>& position) const {
  Lattice cell;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    cell[a] = static_cast<int>(std::floor(position[static_cast<int>(a)] * grid.inverse_cell()));
  }
  return cell;
}

template <int Dim>
typename BasalSegments<Dim>::Lattice BasalSegments<Dim>::parts_on(const Vector<Real, Dim>& normal) {
  Lattice parts;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const Real gradient = std::abs(normal[static_cast<int>(a)] / normal[Dim - 1]);
    parts[a] = static_cast<int>(std::clamp(std::ceil(gradient / Real(highest_part)), Real(1), Real(most_parts)));
  }
  return parts;
}

template <int Dim>
typename BasalSegments<Dim>::Lattice BasalSegments<Dim>::lattice_part(const mpm::SparseGrid<Dim>& grid,
                                                                      const Vector<Real, Dim>& position,
                                                                      const Lattice& cell, const Lattice& parts) const {
  Lattice part;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const Real within = position[static_cast<int>(a)] * grid.inverse_cell() - static_cast<Real>(cell[a]);
    part[a] = std::clamp(static_cast<int>(within * static_cast<Real>(parts[a])), 0, parts[a] - 1);
  }
  return part;
}

template <int Dim>
bool BasalSegments<Dim>::some_node_is_bare(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes) const {
  return parallel_any(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; nodes.contact.contains(b) && k < nodes.contact.nodes; ++k) {
      if (nodes.contact(b, k)[Contact::touching] > Real(0) && !(nodes.base_state(b, k)[BaseState::area] > Real(0))) {
        return true;
      }
    }
    return false;
  });
}

// Footpoints of nodes in contact, in the order of blocks and nodes: nodes out of reach of all segments, and nodes with
// a contact area large enough to need a segment there.
template <int Dim>
std::vector<typename BasalSegments<Dim>::Footpoint> BasalSegments<Dim>::contact_footpoints(
    const mpm::SparseGrid<Dim>& grid, const Ground& ground, const NormalAtNode& node_normal,
    const mpm::Nodes<Dim>& nodes) const {
  constexpr std::size_t of_a_task = 32;  // blocks
  const Real least_area = static_cast<Real>(0.25) * static_cast<Real>(std::pow(grid.cell(), Dim - 1));
  const std::size_t blocks = grid.blocks().size();
  std::vector<std::vector<Footpoint>> of_task((blocks + of_a_task - 1) / of_a_task);
  parallel_for(of_task.size(), 1, [&](std::size_t task) {
    for (std::size_t b = task * of_a_task; b < std::min(blocks, (task + 1) * of_a_task); ++b) {
      for (std::size_t k = 0; nodes.contact.contains(b) && k < nodes.contact.nodes; ++k) {
        const auto& contact = nodes.contact(b, k);
        if (!(contact[Contact::touching] > Real(0))) {
          continue;
        }
        const Vector<Real, Dim> foot = mpm::node_position(grid, b, k);
        const bool unseen = !(nodes.base_state(b, k)[BaseState::area] > Real(0));
        if (unseen || contact[Contact::area] > least_area * ground.width(foot.template head<Dim - 1>())) {
          of_task[task].push_back({lattice_cell(grid, foot), parts_on(*node_normal(b, k)), foot});
        }
      }
    }
  });
  std::vector<Footpoint> footpoints;
  for (const std::vector<Footpoint>& some : of_task) {
    footpoints.insert(footpoints.end(), some.begin(), some.end());
  }
  return footpoints;
}

// Parts of lattice cells that contain footpoints, sorted and unique. The first footpoint in a cell determines the
// number of its parts.
template <int Dim>
std::vector<typename BasalSegments<Dim>::LatticePart> BasalSegments<Dim>::parts_below(
    const mpm::SparseGrid<Dim>& grid, std::vector<Footpoint> footpoints) const {
  std::stable_sort(footpoints.begin(), footpoints.end(),
                   [](const Footpoint& a, const Footpoint& b) { return a.cell < b.cell; });
  std::vector<LatticePart> result;
  Lattice parts{};
  for (std::size_t k = 0; k < footpoints.size(); ++k) {
    const Lattice& cell = footpoints[k].cell;
    parts = k > 0 && cell == footpoints[k - 1].cell ? parts : footpoints[k].parts;
    result.push_back({cell, lattice_part(grid, footpoints[k].position, cell, parts), parts});
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Removes the parts that a segment covers. A segment covers a part if their centres differ by less than three quarters
// of the part's size along each axis.
template <int Dim>
void BasalSegments<Dim>::leave_out_covered(const mpm::SparseGrid<Dim>& grid, std::vector<LatticePart>& parts) const {
  constexpr auto last = static_cast<std::size_t>(Dim - 2);  // the axis that varies fastest in the order of cells
  std::vector<std::uint8_t> covered(parts.size(), 0);
  parallel_for(segments_.size(), [&](std::size_t p) {
    const Vector<Real, Dim>& position = segments_[p].position;
    const Lattice own = lattice_cell(grid, position);
    for (int row = 0; row < mpm::power(3, Dim - 2); ++row) {
      Lattice from = own;
      if constexpr (Dim == 3) {
        from[0] += row - 1;
      }
      Lattice to = from;
      --from[last];
      ++to[last];
      auto part = std::lower_bound(parts.begin(), parts.end(), from,
                                   [](const LatticePart& a, const Lattice& cell) { return a.cell < cell; });
      for (; part != parts.end() && part->cell <= to; ++part) {
        Real furthest = 0;  // in sizes of the part
        for (std::size_t a = 0; a + 1 < Dim; ++a) {
          const auto count = static_cast<Real>(part->parts[a]);
          const Real middle = static_cast<Real>(part->cell[a]) + (static_cast<Real>(part->part[a]) + Real(0.5)) / count;
          const Real in_cells = position[static_cast<int>(a)] * grid.inverse_cell();
          furthest = std::max(furthest, std::abs(in_cells - middle) * count);
        }
        if (furthest < Real(0.75)) {
          std::atomic_ref(covered[static_cast<std::size_t>(part - parts.begin())]).store(1, std::memory_order_relaxed);
        }
      }
    }
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (covered[k] == 0) {
      parts[kept++] = parts[k];
    }
  }
  parts.resize(kept);
}

// Creates segments at footpoints of nodes in contact that no segment covers. They are placed in the cells of a
// horizontal lattice, to be independent of the order of nodes.
template <int Dim>
void BasalSegments<Dim>::create_segments(const mpm::SparseGrid<Dim>& grid, const Ground& ground,
                                         const NormalAtNode& node_normal, Real thickness, mpm::Nodes<Dim>& nodes) {
  std::vector<LatticePart> bare = parts_below(grid, contact_footpoints(grid, ground, node_normal, nodes));
  leave_out_covered(grid, bare);
  const std::size_t known = segments_.size();
  for (const LatticePart& one : bare) {
    Vector<Real, Dim - 1> middle, size;
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      const auto axis = static_cast<int>(a);
      size[axis] = grid.cell() / static_cast<Real>(one.parts[a]);
      middle[axis] =
          static_cast<Real>(one.cell[a]) * grid.cell() + (static_cast<Real>(one.part[a]) + Real(0.5)) * size[axis];
    }
    segments_.push_back(new_segment(middle, size, ground));
    stencils_.emplace_back(grid, segments_.back().position);
    add_area(stencils_.back(), segments_.back(), nodes);
  }
  std::vector<InContact> contacts;
  for (std::size_t p = known; p < segments_.size(); ++p) {
    contacts.push_back(in_contact(stencils_[p], nodes, segments_[p]));
  }
  for (std::size_t p = known; p < segments_.size(); ++p) {
    start_segment(stencils_[p], ground, contacts[p - known], thickness, nodes, segments_[p]);
    segments_[p].velocity = slide_near(grid, stencils_[p], node_normal, nodes, segments_[p]).velocity;
  }
}

// At the edge of the sliding mass, a segment is smaller than its part of the lattice.
template <int Dim>
void BasalSegments<Dim>::start_segment(const Stencil& stencil, const Ground& ground, const InContact& contact,
                                       Real thickness, mpm::Nodes<Dim>& nodes, Segment& segment) {
  const Real fraction = std::clamp(contact.area / segment.area, Real(0.1), Real(1));
  add_area(stencil, segment, nodes, fraction - Real(1));
  segment.sides *= std::pow(fraction, Real(1) / static_cast<Real>(Dim - 1));
  segment.area = segment.area_of_column = ground.area_of(segment.position, segment.sides);
  update_load(contact.area > Real(0) ? contact.normal_force / contact.area : Real(0),
              contact.normal_force / segment.area, Real(0), segment);
  start_column_of(model_, thickness, segment);
  keep_means(model_, segment);
  budget_.created_heat += segment.area * physics::heat_of(segment.column);
  budget_.created_water += segment.area * physics::water_of(segment.column);
}

// Adds a multiple of a segment's area to the nodes in reach.
template <int Dim>
void BasalSegments<Dim>::add_area(const Stencil& stencil, const Segment& segment, mpm::Nodes<Dim>& nodes,
                                  Real fraction) const {
  stencil.for_each([&](std::size_t b, std::size_t node, Real weight) {
    if (nodes.base_state.contains(b)) {
      nodes.base_state.of_block(b)[node][BaseState::area] += fraction * weight * segment.area;
    }
  });
}

// Contact area and force attributed to a segment: nodes distribute theirs over the segments in reach.
template <int Dim>
typename BasalSegments<Dim>::InContact BasalSegments<Dim>::in_contact(const Stencil& stencil,
                                                                      const mpm::Nodes<Dim>& nodes,
                                                                      const Segment& segment) const {
  InContact result;
  stencil.for_each([&](std::size_t b, std::size_t node, Real weight) {
    const Real seen = nodes.base_state(b, node)[BaseState::area];
    if (seen > Real(0)) {
      const auto& contact = nodes.contact(b, node);
      const Real fraction = weight * segment.area / seen;
      result.area += fraction * contact[Contact::area];
      result.normal_force += fraction * contact[Contact::normal_force];
    }
  });
  return result;
}

template <int Dim>
BasalSegment<Dim> BasalSegments<Dim>::new_segment(const Vector<Real, Dim - 1>& middle,
                                                  const Vector<Real, Dim - 1>& size, const Ground& ground) {
  Segment segment;
  segment.id = next_id_++;
  segment.normal = ground.normal(middle);
  segment.position.template head<Dim - 1>() = middle;
  segment.position[Dim - 1] = ground.height(middle);
  segment.sides = sides_on<Dim>(segment.normal, size);
  segment.area = segment.area_of_column = ground.area_of(segment.position, segment.sides);
  return segment;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                   \
  template std::array<int, Dim - 1> BasalSegments<Dim>::lattice_cell(const mpm::SparseGrid<Dim>&,                    \
                                                                     const Vector<Real, Dim>&) const;                \
  template std::array<int, Dim - 1> BasalSegments<Dim>::parts_on(const Vector<Real, Dim>&);                          \
  template std::array<int, Dim - 1> BasalSegments<Dim>::lattice_part(                                                \
      const mpm::SparseGrid<Dim>&, const Vector<Real, Dim>&, const std::array<int, Dim - 1>&,                        \
      const std::array<int, Dim - 1>&) const;                                                                        \
  template bool BasalSegments<Dim>::some_node_is_bare(const mpm::SparseGrid<Dim>&, const mpm::Nodes<Dim>&) const;    \
  template void BasalSegments<Dim>::create_segments(const mpm::SparseGrid<Dim>&, const Ground&, const NormalAtNode&, \
                                                    Real, mpm::Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
