// Creation of basal segments where the sliding mass reaches ground without segments.
#include <algorithm>
#include <atomic>

#include "band/basal_segments.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

using mpm::BaseState;
using mpm::Contact;

template <int Dim>
typename BasalSegments<Dim>::Lattice BasalSegments<Dim>::lattice_cell(const mpm::SparseGrid<Dim>& grid,
                                                                      const Vector<double, Dim>& position) const {
  Lattice cell;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    cell[a] = static_cast<int>(std::floor(position[static_cast<int>(a)] * grid.inverse_cell()));
  }
  return cell;
}

template <int Dim>
bool BasalSegments<Dim>::some_node_is_bare(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes) const {
  return parallel_any(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; nodes.contact.contains(b) && k < nodes.contact.nodes; ++k) {
      if (nodes.contact(b, k)[Contact::touching] > 0.0 && !(nodes.base_state(b, k)[BaseState::area] > 0.0)) {
        return true;
      }
    }
    return false;
  });
}

// Lattice cells of nodes in contact, sorted and unique: of nodes out of reach of all segments, and of nodes with a
// contact area large enough to need a segment there.
template <int Dim>
std::vector<typename BasalSegments<Dim>::Lattice> BasalSegments<Dim>::cells_in_contact(
    const mpm::SparseGrid<Dim>& grid, const Ground& ground, const mpm::Nodes<Dim>& nodes) const {
  constexpr std::size_t of_a_task = 32;  // blocks
  const double least_area = 0.25 * std::pow(grid.cell(), Dim - 1);
  const std::size_t blocks = grid.blocks().size();
  std::vector<std::vector<Lattice>> of_task((blocks + of_a_task - 1) / of_a_task);
  parallel_for(of_task.size(), 1, [&](std::size_t task) {
    for (std::size_t b = task * of_a_task; b < std::min(blocks, (task + 1) * of_a_task); ++b) {
      for (std::size_t k = 0; nodes.contact.contains(b) && k < nodes.contact.nodes; ++k) {
        const auto& contact = nodes.contact(b, k);
        if (!(contact[Contact::touching] > 0.0)) {
          continue;
        }
        const Vector<double, Dim> foot = mpm::node_position(grid, b, k);
        const bool unseen = !(nodes.base_state(b, k)[BaseState::area] > 0.0);
        if (unseen || contact[Contact::area] > least_area * ground.width(foot.template head<Dim - 1>())) {
          of_task[task].push_back(lattice_cell(grid, foot));
        }
      }
    }
  });
  std::vector<Lattice> cells;
  for (const std::vector<Lattice>& some : of_task) {
    cells.insert(cells.end(), some.begin(), some.end());
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

// Removes the cells that a segment covers. A segment covers a cell if their centres differ by less than three quarters
// of a cell along each axis.
template <int Dim>
void BasalSegments<Dim>::leave_out_covered(const mpm::SparseGrid<Dim>& grid, std::vector<Lattice>& cells) const {
  constexpr auto last = static_cast<std::size_t>(Dim - 2);  // the axis that varies fastest in the order of cells
  std::vector<std::uint8_t> covered(cells.size(), 0);
  parallel_for(segments_.size(), [&](std::size_t p) {
    const Vector<double, Dim>& position = segments_[p].position;
    const Lattice own = lattice_cell(grid, position);
    for (int row = 0; row < mpm::power(3, Dim - 2); ++row) {
      Lattice from = own;
      if constexpr (Dim == 3) {
        from[0] += row - 1;
      }
      Lattice to = from;
      --from[last];
      ++to[last];
      for (auto cell = std::lower_bound(cells.begin(), cells.end(), from); cell != cells.end() && *cell <= to; ++cell) {
        double furthest = 0;  // in cells
        for (std::size_t a = 0; a + 1 < Dim; ++a) {
          const double in_cells = position[static_cast<int>(a)] * grid.inverse_cell();
          furthest = std::max(furthest, std::abs(in_cells - (static_cast<double>((*cell)[a]) + 0.5)));
        }
        if (furthest < 0.75) {
          std::atomic_ref(covered[static_cast<std::size_t>(cell - cells.begin())]).store(1, std::memory_order_relaxed);
        }
      }
    }
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (covered[k] == 0) {
      cells[kept++] = cells[k];
    }
  }
  cells.resize(kept);
}

// Creates segments in the lattice cells of nodes in contact that no segment covers.
template <int Dim>
void BasalSegments<Dim>::create_segments(const mpm::SparseGrid<Dim>& grid, const Ground& ground,
                                         const NormalAtNode& node_normal, double thickness, mpm::Nodes<Dim>& nodes) {
  std::vector<Lattice> bare = cells_in_contact(grid, ground, nodes);
  leave_out_covered(grid, bare);
  const std::size_t known = segments_.size();
  for (const Lattice& cell : bare) {
    Vector<double, Dim - 1> middle;
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      middle[static_cast<int>(a)] = (static_cast<double>(cell[a]) + 0.5) * grid.cell();
    }
    segments_.push_back(new_segment(middle, Vector<double, Dim - 1>::Constant(grid.cell()), ground));
    stencils_.emplace_back(grid, segments_.back().position);
    add_area(grid, stencils_.back(), segments_.back(), nodes);
  }
  std::vector<InContact> contacts;
  for (std::size_t p = known; p < segments_.size(); ++p) {
    contacts.push_back(in_contact(grid, stencils_[p], nodes, segments_[p]));
  }
  for (std::size_t p = known; p < segments_.size(); ++p) {
    start_segment(grid, stencils_[p], ground, contacts[p - known], thickness, nodes, segments_[p]);
    const PatchMotion motion = motion_about(grid, stencils_[p].block(), node_normal, nodes);
    segments_[p].velocity = slide_near(grid.cell(), stencils_[p], motion, segments_[p]).velocity;
  }
  if (segments_.size() > known) {
    locate(grid);
  }
}

// At the edge of the sliding mass, a segment is smaller than its lattice cell.
template <int Dim>
void BasalSegments<Dim>::start_segment(const mpm::SparseGrid<Dim>& grid, const Stencil& stencil, const Ground& ground,
                                       const InContact& contact, double thickness, mpm::Nodes<Dim>& nodes,
                                       Segment& segment) {
  const double fraction = std::clamp(contact.area / segment.area, 0.1, 1.0);
  add_area(grid, stencil, segment, nodes, fraction - 1.0);
  segment.sides *= std::pow(fraction, 1.0 / static_cast<double>(Dim - 1));
  segment.area = segment.area_of_column = ground.area_of(segment.position, segment.sides);
  update_load(contact.area > 0.0 ? contact.normal_force / contact.area : 0.0, contact.normal_force / segment.area, 0.0,
              segment);
  start_column_of(model_, thickness, segment);
  keep_means(model_, segment);
  budget_.created_heat += segment.area * physics::heat_of(segment.column);
  budget_.created_water += segment.area * physics::water_of(segment.column);
}

template <int Dim>
BasalSegment<Dim> BasalSegments<Dim>::new_segment(const Vector<double, Dim - 1>& middle,
                                                  const Vector<double, Dim - 1>& size, const Ground& ground) {
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
                                                                     const Vector<double, Dim>&) const;              \
  template bool BasalSegments<Dim>::some_node_is_bare(const mpm::SparseGrid<Dim>&, const mpm::Nodes<Dim>&) const;    \
  template void BasalSegments<Dim>::create_segments(const mpm::SparseGrid<Dim>&, const Ground&, const NormalAtNode&, \
                                                    double, mpm::Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
