#include "band/basal_segments.hpp"

#include <algorithm>
#include <tuple>

#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

using mpm::BaseState;
using mpm::Contact;

namespace {

constexpr double longest = 1.5;  // longest side of a segment along an axis, in cells
// largest area of two merged segments, in areas of a cell's face times the relative section width
constexpr double largest_joined = 1.0;
// largest distance of two merged segments along each axis, in cells
constexpr double joining_reach = 0.5;

}  // namespace

template <int Dim>
void BasalSegments<Dim>::update_from_nodes(const mpm::SparseGrid<Dim>& grid, const Ground& ground,
                                           const NormalAtNode& node_normal, double thickness, double dt,
                                           mpm::Nodes<Dim>& nodes) {
  THAWSLIDE_ASSERT(stencils_.size() == segments_.size(), "{} segments read from nodes, of which {} have added to them",
                   segments_.size(), stencils_.size());
  sum_contact(grid, nodes);
  if (checks_gaps_ || some_node_is_bare(grid, nodes)) {
    create_segments(grid, ground, node_normal, thickness, nodes);
    checks_gaps_ = false;
  }
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (has_segments(b)) {
      gather_from_nodes(grid, b, dt, nodes);
    }
  });
  parallel_for(segments_.size(), [&](std::size_t p) {
    if (stencils_[p].block() == KeyIndex::absent) {
      take_contact({}, 0.0, 0.0, dt, segments_[p]);
    }
    segments_[p].position += dt * segments_[p].velocity;
  });
}

template <int Dim>
void BasalSegments<Dim>::follow(const mpm::SparseGrid<Dim>& grid, const Ground& ground, const NormalAtNode& node_normal,
                                double duration, const mpm::Nodes<Dim>& nodes) {
  locate(grid);
  std::vector<std::uint8_t> alone(segments_.size(), 1);
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!has_segments(b)) {
      return;
    }
    const PatchMotion motion = motion_about(grid, static_cast<std::int32_t>(b), node_normal, nodes);
    for_each_segment(b, [&](std::size_t p) {
      const Nearby slide = slide_near(grid.cell(), stencils_[p], motion, segments_[p]);
      if (slide.is_present) {
        alone[p] = 0;
        stretch_with(slide, ground, duration, segments_[p]);
      }
    });
  });
  for (std::size_t p = 0; p < segments_.size(); ++p) {
    if (alone[p] != 0) {
      remove_segment(segments_[p]);
    }
  }
  keep_only(alone);
  split_long_segments(longest * grid.cell(), ground);
  merge_small_segments(grid, ground);
  checks_gaps_ = true;
}

template <int Dim>
typename BasalSegments<Dim>::PatchMotion BasalSegments<Dim>::motion_about(const mpm::SparseGrid<Dim>& grid,
                                                                          std::int32_t b,
                                                                          const NormalAtNode& node_normal,
                                                                          const mpm::Nodes<Dim>& nodes) const {
  constexpr std::array<double, 3> of_layer{1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};  // of a cubic B-spline
  PatchMotion motion{};
  const auto at = Patch::nodes_at(grid, b);
  for (std::size_t place = 0; place < at.size(); ++place) {
    if (at[place].block == KeyIndex::absent) {
      continue;
    }
    const auto on_ground = static_cast<std::size_t>(at[place].block);
    ColumnMotion& column = motion[place];
    column.normal = node_normal(on_ground, at[place].node);
    for (std::size_t layer = 0; layer < of_layer.size(); ++layer) {
      const int above = static_cast<int>(layer) - 1;
      const auto adjacent = mpm::Tile<Dim>::adjacent(static_cast<int>(at[place].node), Dim - 1, above);
      const std::int32_t block = grid.blocks_about_block(on_ground)[adjacent.direction];
      if (block == KeyIndex::absent) {
        continue;
      }
      const auto in_block = static_cast<std::size_t>(block), node = static_cast<std::size_t>(adjacent.local);
      const double mass = of_layer[layer] * nodes.momentum(in_block, node)[mpm::MomentumLayout<Dim>::mass];
      if (mass > 0.0) {
        const Vector<double, Dim> momentum =
            mass * mpm::vector_at<Dim>(nodes.motion(in_block, node), mpm::MotionLayout<Dim>::middle_velocity);
        column.mass += mass;
        column.momentum += momentum;
        column.mass_height += above * mass;
        column.mass_squares += above * above * mass;
        column.momentum_height += above * momentum;
      }
    }
  }
  return motion;
}

// Velocity of the sliding mass at a segment, and its gradient along the ground: a linear fit to the nodes around it,
// weighted by mass. Velocities are rotated from the ground normal at the node to that of the segment; a bend of the
// ground therefore causes no spurious stretching. Nodes lie on the plane of the segment, or one cell above or below it.
template <int Dim>
typename BasalSegments<Dim>::Nearby BasalSegments<Dim>::slide_near(double cell, const Stencil& stencil,
                                                                   const PatchMotion& motion,
                                                                   const Segment& segment) const {
  using Horizontal = Vector<double, Dim - 1>;
  // added to the spread of positions, in cells squared, to keep the fit regular
  constexpr double smallest_spread = 1e-3;
  // Sums over nodes: mass m, height h in cells, horizontal distance x, momentum p.
  double m = 0, mh = 0, mhh = 0;
  Horizontal mx = Horizontal::Zero(), mxh = Horizontal::Zero();
  Matrix<double, Dim - 1> mxx = Matrix<double, Dim - 1>::Zero();
  Vector<double, Dim> p = Vector<double, Dim>::Zero(), ph = Vector<double, Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim - 1> px = Eigen::Matrix<double, Dim, Dim - 1>::Zero();
  stencil.for_each_with_offset([&](std::size_t place, double weight, const Horizontal& x) {
    const ColumnMotion& column = motion[place];
    if (!(column.mass > 0.0)) {
      return;
    }
    const auto along_segment = [&](const Vector<double, Dim>& v) -> Vector<double, Dim> {
      return weight * (column.normal != nullptr ? turned<Dim>(v, *column.normal, segment.normal) : v);
    };
    const Vector<double, Dim> momentum = along_segment(column.momentum);
    const Horizontal weighted = weight * column.mass * x;
    m += weight * column.mass;
    mh += weight * column.mass_height;
    mhh += weight * column.mass_squares;
    mx += weighted;
    mxh += weight * column.mass_height * x;
    mxx += weighted * x.transpose();
    p += momentum;
    ph += along_segment(column.momentum_height);
    px += momentum * x.transpose();
  });
  Nearby result;
  if (!(m > 0.0)) {
    return result;
  }
  const Vector<double, Dim>& normal = segment.normal;
  const Matrix<double, Dim> along_ground = Matrix<double, Dim>::Identity() - normal * normal.transpose();
  const Eigen::Matrix<double, Dim, Dim - 1> to_plane = sides_on<Dim>(normal, Horizontal::Ones());  // of a distance x
  const Vector<double, Dim> up = cell * along_ground.col(Dim - 1);  // of a height of one cell
  const Vector<double, Dim> positions = to_plane * mx + mh * up, across = to_plane * mxh;
  const Vector<double, Dim> velocities = along_ground * p;
  const Matrix<double, Dim> squares = to_plane * mxx * to_plane.transpose() + across * up.transpose() +
                                      up * across.transpose() + mhh * up * up.transpose();
  const Matrix<double, Dim> together = along_ground * (px * to_plane.transpose() + ph * up.transpose());
  const Vector<double, Dim> mean_position = positions / m;
  const Matrix<double, Dim> spread = squares - positions * mean_position.transpose() +
                                     m * smallest_spread * cell * cell * Matrix<double, Dim>::Identity();
  result.gradient = (together - velocities * mean_position.transpose()) * spread.inverse();
  result.velocity = velocities / m - result.gradient * mean_position;
  result.is_present = true;
  return result;
}

template <int Dim>
void BasalSegments<Dim>::place_on(const Ground& ground, Segment& segment) const {
  const Vector<double, Dim - 1> position = segment.position.template head<Dim - 1>();
  const Vector<double, Dim> before = segment.normal;
  segment.position[Dim - 1] = ground.height(position);
  segment.normal = ground.normal(position);
  for (int side = 0; side + 1 < Dim; ++side) {
    const Vector<double, Dim> edge = turned<Dim>(segment.sides.col(side), before, segment.normal);
    segment.sides.col(side) = edge;
  }
}

template <int Dim>
void BasalSegments<Dim>::stretch_with(const Nearby& slide, const Ground& ground, double dt, Segment& segment) const {
  segment.velocity = slide.velocity;
  segment.sides += dt * slide.gradient * segment.sides;
  place_on(ground, segment);
  segment.area = ground.area_of(segment.position, segment.sides);
}

// Splits segments with a side longer than `most` along an axis into two, along this side.
template <int Dim>
void BasalSegments<Dim>::split_long_segments(double most, const Ground& ground) {
  const std::size_t count = segments_.size();
  for (std::size_t p = 0; p < count; ++p) {
    for (int side = 0; side + 1 < Dim; ++side) {
      if (segments_[p].sides.col(side).cwiseAbs().maxCoeff() <= most) {
        continue;
      }
      const Vector<double, Dim> quarter = 0.25 * segments_[p].sides.col(side);
      Segment& segment = segments_[p];
      segment.sides.col(side) *= 0.5;
      segment.area *= 0.5;
      segment.area_of_column *= 0.5;
      segment.heat *= 0.5;
      Segment other = segment;
      other.id = next_id_++;
      segment.position -= quarter;
      other.position += quarter;
      place_on(ground, segment);
      place_on(ground, other);
      segments_.push_back(other);
    }
  }
}

// Shear splits segments repeatedly, and they accumulate where the flow converges. Two segments in one cell of
// the lattice merge if they are nearer than half a cell along each axis and together no larger than a cell. The result
// is a square at their common centre. Segments that were created next to each other and move together keep a larger
// distance. The segments of one cell are visited in order, and each merges into the smallest one before it.
template <int Dim>
void BasalSegments<Dim>::merge_small_segments(const mpm::SparseGrid<Dim>& grid, const Ground& ground) {
  const double largest = largest_joined * std::pow(grid.cell(), Dim - 1);
  struct Entry {
    Lattice cell;
    std::size_t segment;
  };
  std::vector<Entry> entries(segments_.size());
  parallel_for(segments_.size(), [&](std::size_t p) { entries[p] = {lattice_cell(grid, segments_[p].position), p}; });
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return std::tie(a.cell, a.segment) < std::tie(b.cell, b.segment); });
  std::vector<std::uint8_t> joined(segments_.size(), 0);
  std::size_t smallest = 0;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Entry& entry = entries[k];
    Segment &segment = segments_[entry.segment], &small = segments_[smallest];
    const bool is_first = k == 0 || entry.cell != entries[k - 1].cell;
    const auto is_near = [&] {
      const Vector<double, Dim> apart = small.position - segment.position;
      return apart.template head<Dim - 1>().cwiseAbs().maxCoeff() < joining_reach * grid.cell();
    };
    if (!is_first && small.area + segment.area <= ground.width(small.position.template head<Dim - 1>()) * largest &&
        is_near()) {
      join(segment, ground, small);
      joined[entry.segment] = 1;
    } else if (is_first || segment.area < small.area) {
      smallest = entry.segment;
    }
  }
  keep_only(joined);
}

// Removes the segments marked in `left`; the others keep their order.
template <int Dim>
void BasalSegments<Dim>::keep_only(const std::vector<std::uint8_t>& left) {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < segments_.size(); ++p) {
    if (left[p] == 0) {
      if (kept < p) {
        segments_[kept] = segments_[p];
      }
      ++kept;
    }
  }
  segments_.resize(kept);
}

template <int Dim>
void BasalSegments<Dim>::join(const Segment& other, const Ground& ground, Segment& segment) {
  const double fraction = segment.area / (segment.area + other.area);
  const Vector<double, Dim> middle = fraction * segment.position + (1.0 - fraction) * other.position;
  add_to_budget(merge_from(model_, other, segment));
  segment.position = middle;
  place_on(ground, segment);
  segment.sides = sides_on<Dim>(segment.normal, Vector<double, Dim - 1>::Ones());
  segment.sides *=
      std::pow(segment.area / ground.area_of(segment.position, segment.sides), 1.0 / static_cast<double>(Dim - 1));
  keep_means(model_, segment);
}

template <int Dim>
void BasalSegments<Dim>::remove_segment(const Segment& segment) {
  budget_.left_heat += segment.area_of_column * physics::heat_of(segment.column) + segment.heat;
  budget_.left_water += segment.area_of_column * physics::water_of(segment.column);
  budget_.friction_heat += segment.heat;
}

template <int Dim>
void BasalSegments<Dim>::step(double thickness, double duration) {
  std::vector<physics::ColumnBudget> budgets(segments_.size());
  parallel_for(segments_.size(), [&](std::size_t p) {
    budgets[p] = step_segment(model_, thickness, duration, segments_[p]);
    keep_means(model_, segments_[p]);
  });
  for (const auto& budget : budgets) {
    add_to_budget(budget);
  }
}

template <int Dim>
void BasalSegments<Dim>::add_to_budget(const physics::ColumnBudget& budget) {
  budget_.friction_heat += budget.friction_heat;
  budget_.body_heat += budget.body_heat;
  budget_.ground_heat += budget.ground_heat;
  budget_.vented_heat += budget.vented_heat;
  budget_.steam_heat += budget.steam_heat;
  budget_.body_water += budget.body_water;
  budget_.vented_water += budget.vented_water;
  budget_.steam += budget.steam;
}

#define THAWSLIDE_INSTANTIATE(Dim) template class BasalSegments<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
