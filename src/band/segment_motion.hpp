// Motion of basal segments with the sliding mass: they stretch, split, and merge. Kernels for host and device. Ground
// has below(point), with the height [m] of the ground below a horizontal position and its unit normal, and
// width(point), of a 2D section, relative (terrain/column_heights.hpp).
#pragma once

#include "band/base_budget.hpp"
#include "band/base_stencil.hpp"
#include "mpm/records.hpp"
#include "mpm/vectors_in_records.hpp"

namespace thawslide::band {

// Area of ground spanned by the edges of a segment [m2].
template <class Ground, int Dim>
THAWSLIDE_HD double area_on(const Ground& ground, const SegmentShape<Dim>& segment) {
  const Vector<double, Dim - 1> point = segment.position.template head<Dim - 1>();
  return ground.width(point) * area_of<Dim>(segment.sides);
}
template <class Ground, int Dim>
THAWSLIDE_HD void place_on(const Ground& ground, SegmentShape<Dim>& segment) {
  const Vector<double, Dim> before = segment.normal;
  const Vector<double, Dim - 1> point = segment.position.template head<Dim - 1>();
  const auto below = ground.below(point);
  segment.position[Dim - 1] = below.height;
  segment.normal = below.normal;
  for (int side = 0; side + 1 < Dim; ++side) {
    const Vector<double, Dim> edge = turned<Dim>(segment.sides.col(side), before, segment.normal);
    segment.sides.col(side) = edge;
  }
}

// Sums over the nodes below, on and above the ground at one place, with the weights of the layers: mass [kg] and
// momentum [N s], and both times the height in cells.
template <int Dim>
struct ColumnMotion {
  double mass = 0, mass_height = 0, mass_squares = 0;  // mass_squares: with the height squared
  Vector<double, Dim> momentum = Vector<double, Dim>::Zero(), momentum_height = Vector<double, Dim>::Zero();
  Vector<double, Dim> normal = Vector<double, Dim>::Zero();  // into the ground
};
// normal_at(block, node): unit normal into the ground at a node. One thread per block and node of layer 0.
template <class Nodes, class Normals, int Dim>
struct SumColumnMotion {
  using Patch = BasePatch<Dim>;

  mpm::BlockTables<Dim> tables;
  const std::int32_t* ground_block;
  Nodes nodes;
  Normals normal_at;
  ColumnMotion<Dim>* motion;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t b = k / Patch::nodes_of_layer, node = k % Patch::nodes_of_layer;
    if (static_cast<std::size_t>(ground_block[b]) != b) {
      return;
    }
    const double of_layer[3] = {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};  // of a cubic B-spline
    ColumnMotion<Dim> column;
    column.normal = normal_at(b, node);
    for (int layer = 0; layer < 3; ++layer) {
      const int above = layer - 1;
      const auto adjacent = mpm::Tile<Dim>::adjacent(static_cast<int>(node), Dim - 1, above);
      const std::int32_t block = tables.blocks_about_block[b * static_cast<std::size_t>(mpm::Tile<Dim>::stencil) +
                                                           static_cast<std::size_t>(adjacent.direction)];
      if (block == exec::absent) {
        continue;
      }
      const auto at = nodes.node(static_cast<std::size_t>(block), static_cast<std::size_t>(adjacent.local));
      const double mass = of_layer[layer] * nodes.template read<mpm::Momentum>(at)[mpm::MomentumLayout<Dim>::mass];
      if (mass > 0.0) {
        const Vector<double, Dim> momentum =
            mass * mpm::vector_at<Dim>(nodes.template read<mpm::Motion>(at), mpm::MotionLayout<Dim>::middle_velocity);
        column.mass += mass;
        column.momentum += momentum;
        column.mass_height += above * mass;
        column.mass_squares += above * above * mass;
        column.momentum_height += above * momentum;
      }
    }
    motion[k] = column;
  }
};

// Motion of the sliding mass around a segment.
template <int Dim>
struct Nearby {
  Matrix<double, Dim> gradient = Matrix<double, Dim>::Zero();  // of the velocity, along the ground [1/s]
  Vector<double, Dim> velocity = Vector<double, Dim>::Zero();  // along the ground [m/s]
  bool is_present = false;
};
// Velocity of the sliding mass at a segment, and its gradient along the ground: a linear fit to the nodes around it,
// weighted by mass. Velocities are rotated from the ground normal at the node to that of the segment; a bend of the
// ground therefore causes no spurious stretching. Nodes lie on the plane of the segment, or one cell above or below it.
template <int Dim>
THAWSLIDE_HD Nearby<Dim> slide_near(const mpm::BlockTables<Dim>& tables, double cell, const BaseStencil<Dim>& stencil,
                                    const ColumnMotion<Dim>* motion, const Vector<double, Dim>& normal) {
  using Horizontal = Vector<double, Dim - 1>;
  // added to the spread of positions, in cells squared, to keep the fit regular
  constexpr double smallest_spread = 1e-3;
  Nearby<Dim> result;
  if (stencil.block() == exec::absent) {
    return result;
  }
  // Sums over nodes: mass m, height h in cells, horizontal distance x, momentum p.
  double m = 0, mh = 0, mhh = 0;
  Horizontal mx = Horizontal::Zero(), mxh = Horizontal::Zero();
  Matrix<double, Dim - 1> mxx = Matrix<double, Dim - 1>::Zero();
  Vector<double, Dim> p = Vector<double, Dim>::Zero(), ph = Vector<double, Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim - 1> px = Eigen::Matrix<double, Dim, Dim - 1>::Zero();
  stencil.for_each_with_offset([&](int place, double weight, const Horizontal& x) {
    const auto node = BasePatch<Dim>::node_at(tables, static_cast<std::size_t>(stencil.block()), place);
    if (node.block == exec::absent || !(motion[node.number()].mass > 0.0)) {
      return;
    }
    const ColumnMotion<Dim>& column = motion[node.number()];
    const auto along_segment = [&](const Vector<double, Dim>& v) -> Vector<double, Dim> {
      return weight * turned<Dim>(v, column.normal, normal);
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
  if (!(m > 0.0)) {
    return result;
  }
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

// Updates the velocity of a segment, and stretches it with the flow over `duration` [s]; one without sliding mass
// around it is not kept. One thread per segment.
template <class Ground, int Dim>
struct FollowSlide {
  static constexpr std::size_t of_task = 32;

  mpm::BlockTables<Dim> tables;
  double cell, duration;
  Ground ground;
  const BaseStencil<Dim>* stencils;
  const ColumnMotion<Dim>* motion;
  BasalSegment<Dim>* segments;
  std::uint32_t* is_kept;
  ColumnLedger* budgets;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    BasalSegment<Dim>& segment = segments[p];
    const Nearby<Dim> slide = slide_near(tables, cell, stencils[p], motion, segment.normal);
    is_kept[p] = slide.is_present ? 1 : 0;
    budgets[p] = {};
    if (slide.is_present) {
      segment.velocity = slide.velocity;
      segment.sides += duration * slide.gradient * segment.sides;
      place_on(ground, segment);
      segment.area = area_on(ground, segment);
    } else {
      budgets[p] = ledger_of_removed(segment);
    }
  }
};

// Splits segments with a side longer than `longest` [m] along an axis into two, along this side.
template <class Ground, int Dim>
struct Splitting {
  using Shape = SegmentShape<Dim>;

  double longest;
  Ground ground;

  [[nodiscard]] THAWSLIDE_HD bool is_long(const Shape& segment, int side) const {
    return segment.sides.col(side).cwiseAbs().maxCoeff() > longest;
  }
  // other: an equal segment, which becomes the second part.
  THAWSLIDE_HD void split(int side, Shape& segment, Shape& other) const {
    const Vector<double, Dim> quarter = 0.25 * segment.sides.col(side);
    for (Shape* part : {&segment, &other}) {
      part->sides.col(side) *= 0.5;
    }
    segment.position -= quarter;
    other.position += quarter;
    place_on(ground, segment);
    place_on(ground, other);
  }
};
// Sides to be split, as bits, and their number. One thread per segment.
template <class Ground, int Dim>
struct CountSplits {
  Splitting<Ground, Dim> splitting;
  const BasalSegment<Dim>* segments;
  std::uint32_t *sides, *count;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    SegmentShape<Dim> segment = segments[p];
    sides[p] = count[p] = 0;
    for (int side = 0; side + 1 < Dim; ++side) {
      if (splitting.is_long(segment, side)) {
        SegmentShape<Dim> other = segment;
        splitting.split(side, segment, other);
        sides[p] |= std::uint32_t{1} << side;
        ++count[p];
      }
    }
  }
};
// The new segments follow the others. One thread per segment.
template <class Ground, int Dim>
struct SplitLong {
  Splitting<Ground, Dim> splitting;
  std::size_t segment_count;
  std::int64_t next_id;
  const std::uint32_t* sides;   // by segment
  const std::uint32_t* before;  // by segment: new ones of those before it
  BasalSegment<Dim>* segments;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    BasalSegment<Dim>& segment = segments[p];
    std::uint32_t number = before[p];
    for (int side = 0; side + 1 < Dim; ++side) {
      if ((sides[p] >> side & 1) == 0) {
        continue;
      }
      segment.area *= 0.5;
      segment.area_of_column *= 0.5;
      segment.heat *= 0.5;
      BasalSegment<Dim>& other = segments[segment_count + number];
      other = segment;
      other.id = next_id + number++;
      splitting.split(side, segment, other);
    }
  }
};

// Key of a cell of the horizontal lattice on which segments are created. Keys ascend with x, then y.
template <int Dim>
struct Lattice {
  static constexpr int bits = 32;
  static constexpr std::int64_t origin = std::int64_t{1} << (bits - 1);

  double cell;  // [m]

  [[nodiscard]] THAWSLIDE_HD double in_cells(double position) const { return position * (1.0 / cell); }
  [[nodiscard]] THAWSLIDE_HD std::uint64_t key(const Vector<double, Dim>& position) const {
    std::uint64_t key = 0;
    for (int a = 0; a + 1 < Dim; ++a) {
      key = key << bits |
            static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(in_cells(position[a]))) + origin);
    }
    return key;
  }
  // Number of a cell along an axis.
  [[nodiscard]] THAWSLIDE_HD static std::int64_t along(std::uint64_t key, int axis) {
    constexpr std::uint64_t number = (std::uint64_t{1} << bits) - 1;
    return static_cast<std::int64_t>(key >> (bits * (Dim - 2 - axis)) & number) - origin;
  }
};
// One thread per segment.
template <int Dim>
struct LatticeCellOfSegment {
  Lattice<Dim> lattice;
  const BasalSegment<Dim>* segments;
  std::uint64_t* key;
  std::uint32_t *number, *is_kept;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    key[p] = lattice.key(segments[p].position);
    number[p] = static_cast<std::uint32_t>(p);
    is_kept[p] = 1;
  }
};

// Shear splits segments repeatedly, and they accumulate where the flow converges. Two segments in one cell of the
// lattice merge if they are nearer than half a cell along each axis and together no larger than a cell. The result is a
// square at their common centre. Segments that were created next to each other and move together keep a larger
// distance. The segments of one cell are visited in order, and each merges into the smallest one before it. One thread
// per occupied cell.
template <class Ground, int Dim>
struct MergeSmall {
  static constexpr std::size_t of_task = 64;
  // largest area of two merged segments, in areas of a cell's face times the relative section width; and largest
  // distance along each axis, in cells
  static constexpr double largest_area = 1.0, reach = 0.5;

  ColumnsModel model;
  double cell;
  Ground ground;
  std::size_t segment_count, cell_count;
  const std::uint32_t *first, *in_order;  // first segment of each cell, in the list of segments by cell
  BasalSegment<Dim>* segments;
  std::uint32_t* is_kept;
  ColumnLedger* budgets;  // by cell

  THAWSLIDE_HD void operator()(std::size_t c) const {
    const std::size_t last = c + 1 < cell_count ? first[c + 1] : segment_count;
    const double face = Dim == 2 ? cell : cell * cell;
    ColumnLedger budget;
    std::uint32_t smallest = in_order[first[c]];
    for (std::size_t k = first[c] + 1; k < last; ++k) {
      BasalSegment<Dim>&segment = segments[in_order[k]], &small = segments[smallest];
      const Vector<double, Dim - 1> apart = (small.position - segment.position).template head<Dim - 1>();
      const Vector<double, Dim - 1> point = small.position.template head<Dim - 1>();
      if (small.area + segment.area <= ground.width(point) * largest_area * face &&
          apart.cwiseAbs().maxCoeff() < reach * cell) {
        join(segment, small, budget);
        is_kept[in_order[k]] = 0;
      } else if (segment.area < small.area) {
        smallest = in_order[k];
      }
    }
    budgets[c] = budget;
  }

 private:
  THAWSLIDE_HD void join(const BasalSegment<Dim>& other, BasalSegment<Dim>& segment, ColumnLedger& budget) const {
    const double fraction = segment.area / (segment.area + other.area);
    const Vector<double, Dim> middle = fraction * segment.position + (1.0 - fraction) * other.position;
    budget += ledger_of(merge_from(model, other, segment));
    segment.position = middle;
    place_on(ground, segment);
    segment.sides = sides_on<Dim>(segment.normal, Vector<double, Dim - 1>::Ones());
    segment.sides *= edge_of_face<Dim>(segment.area / area_on(ground, segment));
    keep_means(model, segment);
  }
};

// One thread per segment.
template <int Dim>
struct StepColumns {
  static constexpr std::size_t of_task = 16;

  ColumnsModel model;
  double thickness, duration;
  BasalSegment<Dim>* segments;
  ColumnLedger* budgets;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    budgets[p] = ledger_of(step_segment(model, thickness, duration, segments[p]));
    keep_means(model, segments[p]);
  }
};

}  // namespace thawslide::band
