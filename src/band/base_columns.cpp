#include "band/base_columns.hpp"

#include <algorithm>
#include <tuple>

#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

using mpm::BaseState;
using mpm::Contact;

namespace {

constexpr double longest = 1.5;         // side of a piece along some axis, in cells
constexpr double largest_joined = 1.0;  // area of two that join, in those of a cell's face, as wide as the section
constexpr double joining_reach = 0.5;   // distance of two that join along each axis, in sizes of a lattice part

}  // namespace

// Each block's pieces in order of their numbers.
template <int Dim, class Real>
void BaseColumns<Dim, Real>::list_pieces_by_block(std::size_t blocks) {
  first_of_block_.assign(blocks + 1, 0);
  for (const Stencil& stencil : stencils_) {
    stencil.for_each_block([&](std::size_t b, int /*corner*/) { ++first_of_block_[b]; });
  }
  std::uint32_t end = 0;
  for (std::uint32_t& number : first_of_block_) {
    end += number;
    number = end;  // where the block's pieces end, for now
  }
  by_block_.resize(end);
  for (std::size_t p = stencils_.size(); p-- > 0;) {
    stencils_[p].for_each_block([&](std::size_t b, int corner) {
      by_block_[--first_of_block_[b]] = {static_cast<std::uint32_t>(p), corner};
    });
  }
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::to_nodes(const mpm::SparseGrid<Dim, Real>& grid, mpm::Nodes<Dim, Real>& nodes) {
  using Record = typename mpm::RecordsOf<BaseState, Dim, Real>::Record;
  std::vector<Record> shared(pieces_.size());  // per area of a piece
  stencils_.resize(pieces_.size());
  parallel_for(pieces_.size(), [&](std::size_t p) {
    const Piece& piece = pieces_[p];
    const physics::BandMeans<Real> means = means_now(piece);
    shared[p] = {};
    shared[p][BaseState::area] = Real(1);
    shared[p][BaseState::temperature] = means.temperature;
    shared[p][BaseState::pressure_ratio] = pressure_ratio(means, piece);
    shared[p][BaseState::saturation] = means.saturation;
    shared[p][BaseState::solid_fraction] = means.solid_fraction;
    shared[p][BaseState::slip] = piece.slip;
    stencils_[p] = Stencil(grid, piece.position);
  });
  list_pieces_by_block(grid.blocks().size());
  nodes.base_state.hold(grid.blocks().size(), [&](std::size_t b) { return nodes.near_ground.holds(b); });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!nodes.base_state.holds(b)) {
      return;
    }
    Record* records = nodes.base_state.of_block(b);
    std::fill_n(records, nodes.base_state.nodes, Record{});
    for (std::size_t n = first_of_block_[b]; n < first_of_block_[b + 1]; ++n) {
      const std::size_t p = by_block_[n].piece;
      const Record& of_piece = shared[p];
      const Real area = pieces_[p].area;
      stencils_[p].for_each_in(by_block_[n].corner, [&](std::size_t node, Real weight) {
        Record& record = records[node];
        const Real share = weight * area;
        for (std::size_t c = 0; c < record.size(); ++c) {
          record[c] += share * of_piece[c];
        }
      });
    }
  });
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::take(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground,
                                  const NodeGroundOf& node_ground, Real thickness, Real dt,
                                  mpm::Nodes<Dim, Real>& nodes) {
  THAWSLIDE_ASSERT(stencils_.size() == pieces_.size(), "{} pieces take from nodes, of which {} have given to them",
                   pieces_.size(), stencils_.size());
  if (look_for_gaps_ || some_node_is_bare(grid, nodes)) {
    lay_pieces(grid, ground, node_ground, thickness, nodes);
    look_for_gaps_ = false;
  }
  parallel_for(pieces_.size(), [&](std::size_t p) {
    take_from_nodes(stencils_[p], dt, nodes, pieces_[p]);
    pieces_[p].position += dt * pieces_[p].velocity;
  });
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::follow(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground,
                                    const NodeGroundOf& node_ground, Real duration,
                                    const mpm::Nodes<Dim, Real>& nodes) {
  std::vector<std::uint8_t> alone(pieces_.size());
  parallel_for(pieces_.size(), [&](std::size_t p) {
    const Nearby slide = slide_near(grid, Stencil(grid, pieces_[p].position), node_ground, nodes, pieces_[p]);
    alone[p] = slide.is_there ? 0 : 1;
    if (slide.is_there) {
      stretch_with(slide, ground, duration, pieces_[p]);
    }
  });
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    if (alone[p] != 0) {
      take_up(pieces_[p]);
    }
  }
  keep_only(alone);
  part_long_pieces(Real(longest) * grid.cell(), ground);
  join_small_pieces(grid, ground);
  look_for_gaps_ = true;
}

// The velocity of the slide at a piece, and how it changes along the ground: a linear fit to the nodes about it, each
// weighted by its mass. Velocities are turned from the ground below the node to that of the piece, so that a bend of
// the ground stretches nothing.
template <int Dim, class Real>
typename BaseColumns<Dim, Real>::Nearby BaseColumns<Dim, Real>::slide_near(const mpm::SparseGrid<Dim, Real>& grid,
                                                                           const Stencil& stencil,
                                                                           const NodeGroundOf& node_ground,
                                                                           const mpm::Nodes<Dim, Real>& nodes,
                                                                           const Piece& piece) const {
  constexpr Real smallest_spread = static_cast<Real>(1e-3);  // of places, in cells squared
  const auto along_ground = [&](const Vector<Real, Dim>& v) -> Vector<Real, Dim> {
    return v - v.dot(piece.normal) * piece.normal;
  };
  Real mass = 0;
  Vector<Real, Dim> places = Vector<Real, Dim>::Zero(), velocities = Vector<Real, Dim>::Zero();  // times mass
  Matrix<Real, Dim> squares = Matrix<Real, Dim>::Zero(), together = Matrix<Real, Dim>::Zero();
  stencil.for_each_with_place([&](std::size_t b, std::size_t node, Real weight, const Vector<Real, Dim>& from_piece) {
    const Real of_node = weight * nodes.momentum(b, node)[mpm::MomentumLayout<Dim>::mass];
    if (!(of_node > Real(0))) {
      return;
    }
    auto velocity = mpm::vector_at<Dim, Real>(nodes.motion(b, node), mpm::MotionLayout<Dim>::middle_velocity);
    const Vector<Real, Dim>* normal = node_ground(b, node).normal;
    velocity = along_ground(normal != nullptr ? turned<Dim, Real>(velocity, *normal, piece.normal) : velocity);
    const Vector<Real, Dim> place = along_ground(from_piece);
    const Vector<Real, Dim> weighted = of_node * place;
    mass += of_node;
    places += weighted;
    velocities += of_node * velocity;
    squares += place * weighted.transpose();
    together += velocity * weighted.transpose();
  });
  Nearby result;
  if (!(mass > Real(0))) {
    return result;
  }
  const Vector<Real, Dim> mean_place = places / mass, mean_velocity = velocities / mass;
  const Matrix<Real, Dim> spread = squares - places * mean_place.transpose() +
                                   mass * smallest_spread * grid.cell() * grid.cell() * Matrix<Real, Dim>::Identity();
  result.gradient = (together - velocities * mean_place.transpose()) * spread.inverse();
  result.velocity = mean_velocity - result.gradient * mean_place;
  result.is_there = true;
  return result;
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::take_from_nodes(const Stencil& stencil, Real dt, const mpm::Nodes<Dim, Real>& nodes,
                                             Piece& piece) const {
  Real force = 0, area = 0, heat = 0, slip = 0, borne = 0;  // borne: of the normal force, per area of the piece [Pa]
  stencil.for_each_block([&](std::size_t b, int corner) {
    if (!nodes.contact.holds(b)) {
      return;
    }
    THAWSLIDE_ASSERT(nodes.base_state.holds(b), "block {} has contact and no state of the base", b);
    const auto* contacts = &nodes.contact(b, 0);
    const auto* states = &nodes.base_state(b, 0);
    stencil.for_each_in(corner, [&](std::size_t node, Real weight) {
      const auto& contact = contacts[node];
      if (contact[Contact::touching] > Real(0)) {
        const Real of_seen = weight / states[node][BaseState::area];
        force += weight * contact[Contact::normal_force];
        area += weight * contact[Contact::area];
        slip += weight * contact[Contact::area] * contact[Contact::slip_speed];
        heat += of_seen * contact[Contact::friction_heat];
        borne += of_seen * contact[Contact::normal_force];
      }
    });
  });
  if (piece.touched || area > Real(0)) {
    take_load(area > Real(0) ? force / area : Real(0), borne, dt, piece);
  }
  piece.speed = area > Real(0) ? slip / area : Real(0);
  piece.slip += dt * piece.speed;
  piece.heat += dt * heat * piece.area;
}

// The depth of the slide is what the piece bears [Pa]: its share of the normal force of nodes, all of which falls to
// pieces. N is that where there is contact, and more than it bears where the slide has holes. Ground on which gravity
// does not press shows no depth.
template <int Dim, class Real>
void BaseColumns<Dim, Real>::take_load(Real normal_pressure, Real borne, Real dt, Piece& piece) const {
  const Real weight = model_.density * gravity_.dot(piece.normal);  // [N/m3]
  follow_load(model_, normal_pressure, weight > Real(0) ? borne / weight : model_.largest_thickness, dt, piece);
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::place_on(const Ground& ground, Piece& piece) const {
  const Vector<Real, Dim - 1> place = piece.position.template head<Dim - 1>();
  const Vector<Real, Dim> before = piece.normal;
  piece.position[Dim - 1] = ground.height(place);
  piece.normal = ground.normal(place);
  for (int side = 0; side + 1 < Dim; ++side) {
    const Vector<Real, Dim> edge = turned<Dim, Real>(piece.sides.col(side), before, piece.normal);
    piece.sides.col(side) = edge;
  }
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::stretch_with(const Nearby& slide, const Ground& ground, Real dt, Piece& piece) const {
  piece.velocity = slide.velocity;
  piece.sides += dt * slide.gradient * piece.sides;
  place_on(ground, piece);
  piece.area = ground.area_of(piece.position, piece.sides);
}

// A piece with a side that reaches further than `most` along some axis parts in two along this side.
template <int Dim, class Real>
void BaseColumns<Dim, Real>::part_long_pieces(Real most, const Ground& ground) {
  const std::size_t count = pieces_.size();
  for (std::size_t p = 0; p < count; ++p) {
    for (int side = 0; side + 1 < Dim; ++side) {
      if (pieces_[p].sides.col(side).cwiseAbs().maxCoeff() <= most) {
        continue;
      }
      const Vector<Real, Dim> quarter = Real(0.25) * pieces_[p].sides.col(side);
      Piece& piece = pieces_[p];
      piece.sides.col(side) *= Real(0.5);
      piece.area *= Real(0.5);
      piece.area_of_column *= Real(0.5);
      piece.heat *= Real(0.5);
      Piece other = piece;
      other.id = next_id_++;
      piece.position -= quarter;
      other.position += quarter;
      place_on(ground, piece);
      place_on(ground, other);
      pieces_.push_back(other);
    }
  }
}

// Shear splits pieces repeatedly, and they accumulate where the flow converges. Two pieces in one part of the lattice
// become one if they are nearer than half of its size along each axis and together no larger than a cell. The result is
// a square at their common centre. Pieces that were created next to each other and move together keep more distance.
// The pieces of one part are visited in order, and each joins the smallest one before it.
template <int Dim, class Real>
void BaseColumns<Dim, Real>::join_small_pieces(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground) {
  const Real largest = static_cast<Real>(largest_joined * std::pow(grid.cell(), Dim - 1));
  struct Place {
    LatticePart at;
    std::size_t piece;
  };
  std::vector<Place> places(pieces_.size());
  parallel_for(pieces_.size(), [&](std::size_t p) {
    const Lattice cell = lattice_cell(grid, pieces_[p].position), parts = parts_on(pieces_[p].normal);
    places[p] = {{cell, lattice_part(grid, pieces_[p].position, cell, parts), parts}, p};
  });
  const auto key = [](const Place& place) { return std::tie(place.at.cell, place.at.part); };
  std::sort(places.begin(), places.end(),
            [&](const Place& a, const Place& b) { return key(a) != key(b) ? key(a) < key(b) : a.piece < b.piece; });
  std::vector<std::uint8_t> joined(pieces_.size(), 0);
  std::size_t smallest = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place& place = places[k];
    Piece &piece = pieces_[place.piece], &small = pieces_[smallest];
    const bool is_first = k == 0 || key(place) != key(places[k - 1]);
    const auto is_near = [&] {
      Real furthest = 0;  // in sizes of the part
      for (std::size_t a = 0; a + 1 < Dim; ++a) {
        const auto axis = static_cast<int>(a);
        furthest = std::max(
            furthest, std::abs(small.position[axis] - piece.position[axis]) * static_cast<Real>(place.at.parts[a]));
      }
      return furthest < Real(joining_reach) * grid.cell();
    };
    if (!is_first && small.area + piece.area <= ground.width(small.position.template head<Dim - 1>()) * largest &&
        is_near()) {
      join(piece, ground, small);
      joined[place.piece] = 1;
    } else if (is_first || piece.area < small.area) {
      smallest = place.piece;
    }
  }
  keep_only(joined);
}

// Removes the pieces marked in `left`; the others keep their order.
template <int Dim, class Real>
void BaseColumns<Dim, Real>::keep_only(const std::vector<std::uint8_t>& left) {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    if (left[p] == 0) {
      if (kept < p) {
        pieces_[kept] = pieces_[p];
      }
      ++kept;
    }
  }
  pieces_.resize(kept);
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::join(const Piece& other, const Ground& ground, Piece& piece) {
  const Real share = piece.area / (piece.area + other.area);
  const Vector<Real, Dim> middle = share * piece.position + (Real(1) - share) * other.position;
  add_to_ledger(take_over(model_, other, piece));
  piece.position = middle;
  place_on(ground, piece);
  piece.sides = sides_on<Dim, Real>(piece.normal, Vector<Real, Dim - 1>::Ones());
  piece.sides *=
      std::pow(piece.area / ground.area_of(piece.position, piece.sides), Real(1) / static_cast<Real>(Dim - 1));
  keep_means(model_, piece);
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::take_up(const Piece& piece) {
  ledger_.left_heat += piece.area_of_column * physics::heat_of(piece.column) + piece.heat;
  ledger_.left_water += piece.area_of_column * physics::water_of(piece.column);
  ledger_.friction_heat += piece.heat;
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::step(Real thickness, Real duration) {
  std::vector<physics::ColumnAccount<Real>> accounts(pieces_.size());
  parallel_for(pieces_.size(), [&](std::size_t p) {
    accounts[p] = step_piece(model_, thickness, duration, pieces_[p]);
    keep_means(model_, pieces_[p]);
  });
  for (const auto& account : accounts) {
    add_to_ledger(account);
  }
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::add_to_ledger(const physics::ColumnAccount<Real>& account) {
  ledger_.friction_heat += account.friction_heat;
  ledger_.body_heat += account.body_heat;
  ledger_.ground_heat += account.ground_heat;
  ledger_.vented_heat += account.vented_heat;
  ledger_.steam_heat += account.steam_heat;
  ledger_.body_water += account.body_water;
  ledger_.vented_water += account.vented_water;
  ledger_.steam += account.steam;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) template class BaseColumns<Dim, Real>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
