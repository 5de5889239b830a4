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

// Segments of each block, in ascending order.
template <int Dim>
void BasalSegments<Dim>::list_segments_by_block(std::size_t blocks) {
  first_of_block_.assign(blocks + 1, 0);
  for (const Stencil& stencil : stencils_) {
    stencil.for_each_block([&](std::size_t b, int /*corner*/) { ++first_of_block_[b]; });
  }
  std::uint32_t end = 0;
  for (std::uint32_t& number : first_of_block_) {
    end += number;
    number = end;  // end of the block's segments, for now
  }
  by_block_.resize(end);
  for (std::size_t p = stencils_.size(); p-- > 0;) {
    stencils_[p].for_each_block([&](std::size_t b, int corner) {
      by_block_[--first_of_block_[b]] = {static_cast<std::uint32_t>(p), corner};
    });
  }
}

template <int Dim>
void BasalSegments<Dim>::to_nodes(const mpm::SparseGrid<Dim>& grid, mpm::Nodes<Dim>& nodes) {
  using Record = typename mpm::RecordsOf<BaseState, Dim>::Record;
  std::vector<Record> shared(segments_.size());  // per area of a segment
  stencils_.resize(segments_.size());
  parallel_for(segments_.size(), [&](std::size_t p) {
    const Segment& segment = segments_[p];
    const physics::BandMeans means = current_means(segment);
    shared[p] = {};
    shared[p][BaseState::area] = 1.0;
    shared[p][BaseState::temperature] = means.temperature;
    shared[p][BaseState::pressure_ratio] = pressure_ratio(means, segment);
    shared[p][BaseState::saturation] = means.saturation;
    shared[p][BaseState::solid_fraction] = means.solid_fraction;
    shared[p][BaseState::slip] = segment.slip;
    stencils_[p] = Stencil(grid, segment.position);
  });
  list_segments_by_block(grid.blocks().size());
  nodes.base_state.allocate(grid.blocks().size(), [&](std::size_t b) { return nodes.near_ground.contains(b); });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!nodes.base_state.contains(b)) {
      return;
    }
    Record* records = nodes.base_state.of_block(b);
    std::fill_n(records, nodes.base_state.nodes, Record{});
    for (std::size_t n = first_of_block_[b]; n < first_of_block_[b + 1]; ++n) {
      const std::size_t p = by_block_[n].segment;
      const Record& of_segment = shared[p];
      const double area = segments_[p].area;
      stencils_[p].for_each_in(by_block_[n].corner, [&](std::size_t node, double weight) {
        Record& record = records[node];
        const double fraction = weight * area;
        for (std::size_t c = 0; c < record.size(); ++c) {
          record[c] += fraction * of_segment[c];
        }
      });
    }
  });
}

template <int Dim>
void BasalSegments<Dim>::update_from_nodes(const mpm::SparseGrid<Dim>& grid, const Ground& ground,
                                           const NormalAtNode& node_normal, double thickness, double dt,
                                           mpm::Nodes<Dim>& nodes) {
  THAWSLIDE_ASSERT(stencils_.size() == segments_.size(), "{} segments read from nodes, of which {} have added to them",
                   segments_.size(), stencils_.size());
  if (checks_gaps_ || some_node_is_bare(grid, nodes)) {
    create_segments(grid, ground, node_normal, thickness, nodes);
    checks_gaps_ = false;
  }
  parallel_for(segments_.size(), [&](std::size_t p) {
    gather_from_nodes(stencils_[p], dt, nodes, segments_[p]);
    segments_[p].position += dt * segments_[p].velocity;
  });
}

template <int Dim>
void BasalSegments<Dim>::follow(const mpm::SparseGrid<Dim>& grid, const Ground& ground, const NormalAtNode& node_normal,
                                double duration, const mpm::Nodes<Dim>& nodes) {
  std::vector<std::uint8_t> alone(segments_.size());
  parallel_for(segments_.size(), [&](std::size_t p) {
    const Nearby slide = slide_near(grid, Stencil(grid, segments_[p].position), node_normal, nodes, segments_[p]);
    alone[p] = slide.is_present ? 0 : 1;
    if (slide.is_present) {
      stretch_with(slide, ground, duration, segments_[p]);
    }
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

// Velocity of the sliding mass at a segment, and its gradient along the ground: a linear fit to the nodes around it,
// weighted by mass. Velocities are rotated from the ground normal at the node to that of the segment; a bend of the
// ground therefore causes no spurious stretching.
template <int Dim>
typename BasalSegments<Dim>::Nearby BasalSegments<Dim>::slide_near(const mpm::SparseGrid<Dim>& grid,
                                                                   const Stencil& stencil,
                                                                   const NormalAtNode& node_normal,
                                                                   const mpm::Nodes<Dim>& nodes,
                                                                   const Segment& segment) const {
  // added to the spread of positions, in cells squared, to keep the fit regular
  constexpr double smallest_spread = 1e-3;
  const auto along_ground = [&](const Vector<double, Dim>& v) -> Vector<double, Dim> {
    return v - v.dot(segment.normal) * segment.normal;
  };
  double mass = 0;
  Vector<double, Dim> positions = Vector<double, Dim>::Zero(), velocities = Vector<double, Dim>::Zero();  // times mass
  Matrix<double, Dim> squares = Matrix<double, Dim>::Zero(), together = Matrix<double, Dim>::Zero();
  stencil.for_each_with_offset([&](std::size_t b, std::size_t node, double weight,
                                   const Vector<double, Dim>& from_segment) {
    const double of_node = weight * nodes.momentum(b, node)[mpm::MomentumLayout<Dim>::mass];
    if (!(of_node > 0.0)) {
      return;
    }
    auto velocity = mpm::vector_at<Dim>(nodes.motion(b, node), mpm::MotionLayout<Dim>::middle_velocity);
    const Vector<double, Dim>* normal = node_normal(b, node);
    velocity = along_ground(normal != nullptr ? turned<Dim>(velocity, *normal, segment.normal) : velocity);
    Vector<double, Dim> in_space = from_segment;
    in_space[Dim - 1] -=
        segment.normal.template head<Dim - 1>().dot(from_segment.template head<Dim - 1>()) / segment.normal[Dim - 1];
    const Vector<double, Dim> position = along_ground(in_space);
    const Vector<double, Dim> weighted = of_node * position;
    mass += of_node;
    positions += weighted;
    velocities += of_node * velocity;
    squares += position * weighted.transpose();
    together += velocity * weighted.transpose();
  });
  Nearby result;
  if (!(mass > 0.0)) {
    return result;
  }
  const Vector<double, Dim> mean_position = positions / mass, mean_velocity = velocities / mass;
  const Matrix<double, Dim> spread =
      squares - positions * mean_position.transpose() +
      mass * smallest_spread * grid.cell() * grid.cell() * Matrix<double, Dim>::Identity();
  result.gradient = (together - velocities * mean_position.transpose()) * spread.inverse();
  result.velocity = mean_velocity - result.gradient * mean_position;
  result.is_present = true;
  return result;
}

template <int Dim>
void BasalSegments<Dim>::gather_from_nodes(const Stencil& stencil, double dt, const mpm::Nodes<Dim>& nodes,
                                           Segment& segment) const {
  double force = 0, area = 0, heat = 0, slip = 0, borne = 0;  // borne: normal force per area of the segment [Pa]
  stencil.for_each_block([&](std::size_t b, int corner) {
    if (!nodes.contact.contains(b)) {
      return;
    }
    THAWSLIDE_ASSERT(nodes.base_state.contains(b), "block {} has contact and no state of the base", b);
    const auto* contacts = &nodes.contact(b, 0);
    const auto* states = &nodes.base_state(b, 0);
    stencil.for_each_in(corner, [&](std::size_t node, double weight) {
      const auto& contact = contacts[node];
      if (contact[Contact::touching] > 0.0) {
        const double of_seen = weight / states[node][BaseState::area];
        force += weight * contact[Contact::normal_force];
        area += weight * contact[Contact::area];
        slip += weight * contact[Contact::area] * contact[Contact::slip_speed];
        heat += of_seen * contact[Contact::friction_heat];
        borne += of_seen * contact[Contact::normal_force];
      }
    });
  });
  if (segment.touched || area > 0.0) {
    update_load(area > 0.0 ? force / area : 0.0, borne, dt, segment);
  }
  segment.speed = area > 0.0 ? slip / area : 0.0;
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
