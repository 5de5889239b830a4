#include "mpm/body_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "mpm/scalar_index.hpp"
#include "physics/contact.hpp"

namespace thawslide::mpm {

namespace {

// Nodes of a block with a margin along each axis.
template <int Dim, int Margin>
struct About {
  static constexpr int edge = Tile<Dim>::edge + 2 * Margin;
  static constexpr auto count = static_cast<std::size_t>(power(edge, Dim));

  // relative: node indices relative to the block's first node.
  static std::size_t at(const typename Tile<Dim>::Index& relative) {
    int index = 0;
    for (int a = Dim - 1; a >= 0; --a) {
      index = index * edge + relative[static_cast<std::size_t>(a)] + Margin;
    }
    return static_cast<std::size_t>(index);
  }
  static typename Tile<Dim>::Index relative(std::size_t index) {
    typename Tile<Dim>::Index relative{};
    for (std::size_t a = 0; a < Dim; ++a) {
      relative[a] = static_cast<int>(index % edge) - Margin;
      index /= edge;
    }
    return relative;
  }
};

template <int Dim>
typename Tile<Dim>::Index shifted(typename Tile<Dim>::Index index, std::size_t axis, int by) {
  index[axis] += by;
  return index;
}

// Volumes [m3] at the nodes of a block and two more on each side; 0 if there is no block.
template <int Dim>
std::array<double, About<Dim, 2>::count> volumes_about(const SparseGrid<Dim>& grid, const Nodes<Dim>& nodes,
                                                       std::size_t block) {
  using T = Tile<Dim>;
  std::array<double, About<Dim, 2>::count> volumes;
  for (std::size_t k = 0; k < volumes.size(); ++k) {
    typename T::Index tile{};
    int local = 0, direction = 0;
    T::split(About<Dim, 2>::relative(k), tile, local);
    for (int a = Dim - 1; a >= 0; --a) {
      direction = 3 * direction + tile[static_cast<std::size_t>(a)] + 1;
    }
    const std::int32_t there = grid.blocks_about_block(block)[direction];
    volumes[k] = there == KeyIndex::absent
                     ? 0.0
                     : nodes.momentum(static_cast<std::size_t>(there),
                                      static_cast<std::size_t>(local))[MomentumLayout<Dim>::volume];
  }
  return volumes;
}

// Change of a quantity over two cells around a node, along each axis.
template <int Dim>
Vector<double, Dim> change_about(const std::array<double, About<Dim, 2>::count>& quantity,
                                 const typename Tile<Dim>::Index& node) {
  using Near = About<Dim, 2>;
  Vector<double, Dim> change;
  for (std::size_t a = 0; a < Dim; ++a) {
    change[static_cast<int>(a)] =
        quantity[Near::at(shifted<Dim>(node, a, 1))] - quantity[Near::at(shifted<Dim>(node, a, -1))];
  }
  return change;
}

// Particle that may reach nodes of a block.
template <int Dim>
struct ParticleAbout {
  Vector<double, Dim> position;       // [m]
  Vector<double, Dim - 1> slope;      // of the ground; zero without ground
  double half;                        // half size of its box [m]
  typename Tile<Dim>::Index nearest;  // node, relative to the block's first one
};

template <int Dim>
std::vector<ParticleAbout<Dim>> particles_about(const SparseGrid<Dim>& grid, const Particles<Dim>& particles,
                                                const BodySizes& sizes, std::size_t block) {
  using T = Tile<Dim>;
  const typename T::Index first_node = T::node(T::index(grid.blocks()[block]), 0);
  std::vector<ParticleAbout<Dim>> about;
  for (std::size_t d = 0; d < static_cast<std::size_t>(T::stencil); ++d) {
    const std::int32_t t = grid.tiles_about_block(block)[d];
    if (t == KeyIndex::absent) {
      continue;
    }
    const auto& tile = grid.tiles()[static_cast<std::size_t>(t)];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const ScalarIndex at{p};
      ParticleAbout<Dim> one;
      one.position = particles.position.template load_vector<Dim>(at);
      one.slope.setZero();
      if (grid.mapping().has_ground) {
        one.slope = particles.ground_slope.template load_vector<Dim - 1>(at);
      }
      one.half = sizes.half(static_cast<std::size_t>(particles.body(p))) * grid.cell();
      bool reaches = true;
      for (std::size_t a = 0; a < Dim; ++a) {
        const double along =
            grid.mapping().template coordinate<Dim>(particles, at, static_cast<int>(a)) * grid.inverse_cell() + 0.5;
        one.nearest[a] = static_cast<int>(std::floor(along)) - first_node[a];
        reaches = reaches && one.nearest[a] >= -1 && one.nearest[a] <= T::edge;
      }
      if (reaches) {
        about.push_back(one);
      }
    }
  }
  return about;
}

// Extent of a particle's box along a normal [m]. The upper and lower sides of the box are parallel to the ground.
template <int Dim>
struct Edge {
  double along;
  const ParticleAbout<Dim>* of;
};

// Selects the particles that reach a node; returns the sum of their slopes.
template <int Dim>
Vector<double, Dim - 1> find_seen(const std::vector<ParticleAbout<Dim>>& about, std::size_t node,
                                  std::vector<Edge<Dim>>& seen) {
  const typename Tile<Dim>::Index here = Tile<Dim>::node({}, static_cast<int>(node));
  Vector<double, Dim - 1> slope = Vector<double, Dim - 1>::Zero();
  seen.clear();
  for (const ParticleAbout<Dim>& one : about) {
    bool sees = true;
    for (std::size_t a = 0; a < Dim; ++a) {
      sees = sees && std::abs(one.nearest[a] - here[a]) <= 1;
    }
    if (sees) {
      seen.push_back({0.0, &one});
      slope += one.slope;
    }
  }
  return slope;
}

// Computes the edges of particles on the side given by a sign; returns the foremost one.
template <int Dim>
double set_edges(const Vector<double, Dim>& normal, double sign, std::vector<Edge<Dim>>& seen) {
  double foremost = -std::numeric_limits<double>::max();
  for (Edge<Dim>& edge : seen) {
    Vector<double, Dim> on_grid = normal;
    on_grid.template head<Dim - 1>() += normal[Dim - 1] * edge.of->slope;
    const double stretch = sign * on_grid.cwiseAbs().maxCoeff();
    edge.along = edge.of->position.dot(normal) + stretch * edge.of->half;
    foremost = std::max(foremost, sign * edge.along);
  }
  return sign * foremost;
}

// Gap along a normal between two bodies: the smallest one between particles that face each other across it, or the
// largest number if there are none. Edges are sorted with the foremost first.
template <int Dim>
double gap_between(const std::vector<Edge<Dim>>& first, const std::vector<Edge<Dim>>& second,
                   const Vector<double, Dim>& normal) {
  double gap = std::numeric_limits<double>::max();
  for (const Edge<Dim>& from : first) {
    for (const Edge<Dim>& to : second) {
      if (to.along - from.along >= gap) {
        break;
      }
      const Vector<double, Dim> apart = to.of->position - from.of->position;
      const Vector<double, Dim> across = apart - apart.dot(normal) * normal;
      const double reach = to.of->half + from.of->half;
      gap = across.squaredNorm() < reach * reach ? to.along - from.along : gap;
    }
  }
  return gap;
}

}  // namespace

// Finds the nodes at which both bodies have mass; returns false if there are none.
template <int Dim>
bool BodyContact<Dim>::find_meetings(const Nodes<Dim>& nodes, Pair& pair) {
  constexpr std::size_t mass = MomentumLayout<Dim>::mass;
  bool any = false;
  for (std::size_t k = 0; k < block_nodes; ++k) {
    pair.at[k].in_contact = nodes.momentum(pair.block, k)[mass] > 0.0 && nodes.momentum(pair.other, k)[mass] > 0.0;
    any = any || pair.at[k].in_contact;
  }
  return any;
}

// Gradients of the nodal volumes V_1 and V_2, averaged over the surrounding nodes. The first, V_1 grad V_2 - V_2 grad
// V_1, is along the gradient of ln(V_2 / V_1); a cut through both bodies, as by the ground, does not rotate it. The
// others are -grad V_1 and grad V_2.
template <int Dim>
auto BodyContact<Dim>::find_gradients(const SparseGrid<Dim>& grid, const Nodes<Dim>& nodes, const Pair& pair)
    -> std::array<Gradients, block_nodes> {
  using Near = About<Dim, 1>;
  const auto first = volumes_about<Dim>(grid, nodes, pair.block), second = volumes_about<Dim>(grid, nodes, pair.other);
  std::array<Gradients, Near::count> directions;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const typename T::Index node = Near::relative(k);
    const Vec of_first = change_about<Dim>(first, node), of_second = change_about<Dim>(second, node);
    const std::size_t here = About<Dim, 2>::at(node);
    directions[k] = {first[here] * of_second - second[here] * of_first, -of_first, of_second};
  }
  std::array<Gradients, block_nodes> gradients;
  for (std::size_t k = 0; k < block_nodes; ++k) {
    for (std::size_t kind = 0; kind < gradients[k].size(); ++kind) {
      Vec sum = Vec::Zero();
      for (int about = 0; about < T::stencil; ++about) {
        typename T::Index node = T::node({}, static_cast<int>(k));
        double weight = 1;
        for (std::size_t a = 0, rest = static_cast<std::size_t>(about); a < Dim; ++a, rest /= 3) {
          node[a] += static_cast<int>(rest % 3) - 1;
          weight *= rest % 3 == 1 ? 0.5 : 0.25;
        }
        sum += weight * directions[Near::at(node)][kind];
      }
      gradients[k][kind] = sum;
    }
  }
  return gradients;
}

// Selects the normal of a node along which the bodies are furthest apart, and computes the gap along it. At a corner of
// one body, the normal of the other is correct, and the combined one is rotated.
template <int Dim>
void BodyContact<Dim>::find_gaps(const SparseGrid<Dim>& grid, const Particles<Dim>& particles, const BodySizes& sizes,
                                 const std::array<Gradients, block_nodes>& gradients, Pair& pair) {
  const auto about = particles_about(grid, particles, sizes, pair.block),
             other_about = particles_about(grid, particles, sizes, pair.other);
  std::vector<Edge<Dim>> edges, other_edges;
  for (std::size_t k = 0; k < block_nodes; ++k) {
    Meeting& meeting = pair.at[k];
    if (!meeting.in_contact) {
      continue;
    }
    Vector<double, Dim - 1> slope = find_seen(about, k, edges);
    slope += find_seen(other_about, k, other_edges);
    slope /= static_cast<double>(edges.size() + other_edges.size());
    double furthest = -std::numeric_limits<double>::max();
    for (Vec normal : gradients[k]) {
      normal.template head<Dim - 1>() -= normal[Dim - 1] * slope;  // gradient in space
      normal.normalize();                                          // or zero
      const double apart = set_edges<Dim>(normal, -1.0, other_edges) - set_edges<Dim>(normal, 1.0, edges);
      const double by_rounding = 1e-9 * grid.cell();  // tolerance for ties: the first one is kept
      if (normal != Vec::Zero() && apart > furthest + by_rounding) {
        furthest = apart;
        meeting.normal = normal;
      }
    }
    set_edges<Dim>(meeting.normal, 1.0, edges);
    set_edges<Dim>(meeting.normal, -1.0, other_edges);
    std::sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.along > b.along; });
    std::sort(other_edges.begin(), other_edges.end(), [](const auto& a, const auto& b) { return a.along < b.along; });
    meeting.gap = gap_between(edges, other_edges, meeting.normal);
    meeting.in_contact = meeting.normal != Vec::Zero();
  }
}

template <int Dim>
void BodyContact<Dim>::exchange(double mass_damping, double dt, Nodes<Dim>& nodes, Pair& pair) {
  using Layout = MomentumLayout<Dim>;
  const auto trial_velocity = [&](const auto& record) {
    return Vec(((1.0 - mass_damping * dt) * vector_at<Dim>(record, Layout::momentum) +
                dt * vector_at<Dim>(record, Layout::force)) /
               record[Layout::mass]);
  };
  for (std::size_t k = 0; k < block_nodes; ++k) {
    Meeting& meeting = pair.at[k];
    if (!meeting.in_contact) {
      continue;
    }
    auto& first = nodes.momentum(pair.block, k);
    auto& second = nodes.momentum(pair.other, k);
    const Vec approach = trial_velocity(first) - (pair.other_is_held ? Vec(Vec::Zero()) : trial_velocity(second));
    const double closing = approach.dot(meeting.normal);
    const Vec slip = approach - closing * meeting.normal;
    const double slip_speed = slip.norm();
    const auto impulse = pair.other_is_held ? physics::impulse_on_fixed_body(first[Layout::mass], closing, slip_speed,
                                                                             meeting.gap, dt, pair.friction)
                                            : physics::body_impulse(first[Layout::mass], second[Layout::mass], closing,
                                                                    slip_speed, meeting.gap, dt, pair.friction);
    meeting.in_contact = impulse.normal > 0.0;
    if (!meeting.in_contact) {
      continue;
    }
    meeting.impulse = impulse.normal * meeting.normal;
    if (slip_speed > 0.0) {
      meeting.impulse += (impulse.tangential / slip_speed) * slip;
    }
    const Vec force = meeting.impulse / dt;
    set_vector<Dim>(first, Layout::force, Vec(vector_at<Dim>(first, Layout::force) - force));
    set_vector<Dim>(second, Layout::force, Vec(vector_at<Dim>(second, Layout::force) + force));
  }
}

template <int Dim>
void BodyContact<Dim>::add_forces(const SparseGrid<Dim>& grid, const Particles<Dim>& particles,
                                  const BetweenBodies& between, const BodySizes& sizes, double mass_damping, double dt,
                                  Nodes<Dim>& nodes) {
  find_pairs(grid, between);
  parallel_for(first_of_tile_.size() - 1, [&](std::size_t tile) {
    // Serial: three bodies that meet at a node exchange its momentum in turn.
    for (std::size_t k = first_of_tile_[tile]; k < first_of_tile_[tile + 1]; ++k) {
      if (find_meetings(nodes, pairs_[k])) {
        find_gaps(grid, particles, sizes, find_gradients(grid, nodes, pairs_[k]), pairs_[k]);
        exchange(mass_damping, dt, nodes, pairs_[k]);
      }
    }
  });
}

template <int Dim>
BodyContactWork BodyContact<Dim>::constrain_mapped_back(const Vector<double, Dim>& gravity, double dt,
                                                        Nodes<Dim>& nodes) const {
  using Layout = MomentumLayout<Dim>;
  using Work = BodyContactWork;
  return parallel_sum<Work>(first_of_tile_.size() - 1, [&](std::size_t tile, Work& work) {
    for (std::size_t p = first_of_tile_[tile]; p < first_of_tile_[tile + 1]; ++p) {
      const Pair& pair = pairs_[p];
      for (std::size_t k = 0; k < block_nodes; ++k) {
        const Meeting& meeting = pair.at[k];
        if (!meeting.in_contact) {
          continue;
        }
        auto& mapped = nodes.velocity(pair.block, k);
        auto& other_mapped = nodes.velocity(pair.other, k);
        const double mass = nodes.momentum(pair.block, k)[Layout::mass],
                     other_mass = nodes.momentum(pair.other, k)[Layout::mass];
        const Vec approach = vector_at<Dim>(mapped, 0) - vector_at<Dim>(other_mapped, 0);
        const double closing = approach.dot(meeting.normal);
        const auto impulse = pair.other_is_held
                                 ? physics::impulse_on_fixed_body(mass, closing, 0.0, meeting.gap, dt, 0.0)
                                 : physics::body_impulse(mass, other_mass, closing, 0.0, meeting.gap, dt, 0.0);
        const auto turn = [&](std::size_t block, auto& velocity, double sign, double of_mass) {
          const auto& record = nodes.momentum(block, k);
          const Vec before = vector_at<Dim>(velocity, 0);
          const Vec change = (sign * impulse.normal / of_mass) * meeting.normal;
          const Vec middle = vector_at<Dim>(nodes.motion(block, k), MotionLayout<Dim>::middle_velocity);
          const Vec transferred = sign * meeting.impulse;
          const Vec internal = dt * (vector_at<Dim>(record, Layout::force) - of_mass * gravity);
          set_vector<Dim>(velocity, 0, Vec(before + change));
          work.loss -= transferred.dot(middle);
          work.numerical -= transferred.dot(Vec(middle - before - change)) + internal.dot(change);
        };
        turn(pair.block, mapped, -1.0, mass);
        if (!pair.other_is_held) {
          turn(pair.other, other_mapped, 1.0, other_mass);
        }
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim) template class BodyContact<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
