// Contact of two bodies at a node (mpm/body_contact.hpp). One thread per node of a pair of blocks, or per node of a
// place with all pairs there. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/select.hpp"
#include "exec/key_lists.hpp"
#include "mpm/between_bodies.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/particle_view.hpp"
#include "mpm/records.hpp"
#include "mpm/tile_tables.hpp"
#include "mpm/vectors_in_records.hpp"
#include "physics/contact.hpp"

namespace thawslide::mpm {

// Blocks of two layers at the same place.
struct BlockPair {
  std::uint32_t block, other;
  bool other_is_held;
  double friction;
};

// Contact of two bodies at a node. impulse: on the second one [N s]; opposite on the first.
template <int Dim>
struct Meeting {
  bool in_contact;
  double gap;                  // [m]
  Vector<double, Dim> normal;  // from the first body to the second
  Vector<double, Dim> impulse;
};

// Extent of a particle's box along a normal [m]. The upper and lower sides of the box are parallel to the ground.
struct BoxEdge {
  double along;
  std::uint32_t particle;
};

// Arguments common to all kernels. Nodes: access to nodal records (mpm/nodes.hpp, device/node_access.hpp).
template <class Nodes, int Dim>
struct BodyContactArgs {
  static constexpr auto block_nodes = static_cast<std::size_t>(Tile<Dim>::nodes);

  TileTables<Dim> tables;
  ParticleView<Dim> particles;
  SizesOfBodies sizes;  // in cells
  bool has_ground;
  double cell, mass_damping, dt;
  Vector<double, Dim> gravity;
  Nodes nodes;

  template <class Node>
  [[nodiscard]] THAWSLIDE_HD double mass(const Node& node) const {
    return nodes.template read<Momentum>(node)[MomentumLayout<Dim>::mass];
  }
};

// Nodes and particles of one body around a node of a block.
template <class Nodes, int Dim>
struct BodyAbout {
  using T = Tile<Dim>;
  using Index = typename T::Index;
  using Vec = Vector<double, Dim>;
  static constexpr auto stencil = static_cast<std::size_t>(T::stencil);

  const BodyContactArgs<Nodes, Dim>& args;
  std::size_t block;

  [[nodiscard]] THAWSLIDE_HD bool has_mass(std::size_t node) const { return args.mass(Nodes::node(block, node)) > 0.0; }
  // Volume [m3] at a node given relative to the block's first one; 0 if there is no block.
  [[nodiscard]] THAWSLIDE_HD double volume(const Index& node) const {
    Index tile{};
    int local = 0, direction = 0;
    T::split(node, tile, local);
    for (int a = Dim - 1; a >= 0; --a) {
      direction = 3 * direction + tile[static_cast<std::size_t>(a)] + 1;
    }
    const std::int32_t there = args.tables.blocks_about_block[block * stencil + static_cast<std::size_t>(direction)];
    return there == exec::absent
               ? 0.0
               : args.nodes.template read<Momentum>(Nodes::node(
                     static_cast<std::size_t>(there), static_cast<std::size_t>(local)))[MomentumLayout<Dim>::volume];
  }
  // Change of volume over two cells around a node, along each axis.
  [[nodiscard]] THAWSLIDE_HD Vec change_about(const Index& node) const {
    Vec change;
    for (std::size_t a = 0; a < Dim; ++a) {
      Index above = node, below = node;
      ++above[a];
      --below[a];
      change[static_cast<int>(a)] = volume(above) - volume(below);
    }
    return change;
  }
  // Calls visit(first, last) with ranges of ranks, by tile, of the particles that reach a local node of the block.
  template <class Visit>
  THAWSLIDE_HD void for_ranks_at(std::size_t node, const Visit& visit) const {
    for (std::size_t d = 0; d < stencil; ++d) {
      const std::int32_t tile = args.tables.tiles_about_block[block * stencil + d];
      if (tile == exec::absent) {
        continue;
      }
      // Cells within one node, in the tile. Cells are numbered like the nodes nearest to their particles.
      const Index here = T::node({}, static_cast<int>(node));
      int first[3] = {0, 0, 0}, last[3] = {0, 0, 0};
      for (std::size_t a = 0, direction = d; a < Dim; ++a, direction /= 3) {
        const int along = here[a] - (static_cast<int>(direction % 3) - 1) * T::edge;
        first[a] = along > 1 ? along - 1 : 0;
        last[a] = along + 1 < T::edge ? along + 1 : T::edge - 1;
      }
      const std::uint32_t* ranks = args.tables.first_of_cell + static_cast<std::size_t>(tile) * args.block_nodes;
      for (int z = first[2]; z <= last[2]; ++z) {
        for (int y = first[1]; y <= last[1] && first[0] <= last[0]; ++y) {
          const int row = (z * T::edge + y) * T::edge;  // cells of a row are consecutive
          visit(ranks[row + first[0]], ranks[row + last[0] + 1]);
        }
      }
    }
  }
};

// Number of particles of both bodies at each node where both have mass, by pair and node.
template <class Nodes, int Dim>
struct CountAtMeetings {
  BodyContactArgs<Nodes, Dim> args;
  const BlockPair* pairs;
  std::uint32_t* counts;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    using Body = BodyAbout<Nodes, Dim>;
    const Body first{args, pairs[k / args.block_nodes].block}, second{args, pairs[k / args.block_nodes].other};
    const std::size_t node = k % args.block_nodes;
    std::uint32_t count = 0;
    const auto add = [&count](std::uint32_t from, std::uint32_t to) { count += to - from; };
    if (first.has_mass(node) && second.has_mass(node)) {
      first.for_ranks_at(node, add);
      second.for_ranks_at(node, add);
    }
    counts[k] = count;
  }
};

// Normal and gap of two bodies, by pair and node, from number `start` on.
template <class Nodes, int Dim>
struct FindGaps {
  using T = Tile<Dim>;
  using Vec = Vector<double, Dim>;
  using Body = BodyAbout<Nodes, Dim>;
  // Candidate normals of a node: from both bodies, the first, the second.
  static constexpr int kinds = 3;
  static constexpr std::size_t of_task = 16;

  BodyContactArgs<Nodes, Dim> args;
  const BlockPair* pairs;
  const std::uint32_t *counts, *before;  // particles of each node, and of those before it
  BoxEdge* all_edges;
  Meeting<Dim>* meetings;
  std::size_t start;

  THAWSLIDE_HD void operator()(std::size_t item) const {
    const std::size_t k = start + item;
    Meeting<Dim>& meeting = meetings[k];
    meeting = {counts[k] > 0, 0.0, Vec::Zero(), Vec::Zero()};
    if (!meeting.in_contact) {
      return;
    }
    const Body first{args, pairs[k / args.block_nodes].block}, second{args, pairs[k / args.block_nodes].other};
    const std::size_t node = k % args.block_nodes;
    Vector<double, Dim - 1> slope = Vector<double, Dim - 1>::Zero(), other_slope = slope;
    BoxEdge* edges = all_edges + (before[k] - before[start]);
    BoxEdge* const other_edges = list(first, node, edges, slope);
    BoxEdge* const end = list(second, node, other_edges, other_slope);
    slope = (slope + other_slope) / static_cast<double>(counts[k]);
    Vec gradients[kinds];
    find_gradients(first, second, T::node({}, static_cast<int>(node)), gradients);
    // The normal along which the bodies are furthest apart. At a corner of one body, the normal of the other is
    // correct, and the combined one is rotated.
    double furthest = -std::numeric_limits<double>::max();
    for (Vec normal : gradients) {
      normal.template head<Dim - 1>() -= normal[Dim - 1] * slope;  // gradient in space
      normal.normalize();                                          // or zero
      const double apart = set_edges(normal, -1.0, other_edges, end) - set_edges(normal, 1.0, edges, other_edges);
      const double by_rounding = 1e-9 * args.cell;  // tolerance for ties: the first one is kept
      if (normal != Vec::Zero() && apart > furthest + by_rounding) {
        furthest = apart;
        meeting.normal = normal;
      }
    }
    set_edges(meeting.normal, 1.0, edges, other_edges);
    set_edges(meeting.normal, -1.0, other_edges, end);
    sort(edges, other_edges, 1.0);
    sort(other_edges, end, -1.0);
    meeting.gap = gap_between(edges, other_edges, end, meeting.normal);
    meeting.in_contact = meeting.normal != Vec::Zero();
  }

 private:
  [[nodiscard]] THAWSLIDE_HD double half_of(std::uint32_t particle) const {
    const std::size_t body = args.sizes.is_uniform ? 0 : static_cast<std::size_t>(args.particles.body(particle));
    return args.sizes.half[body] * args.cell;
  }
  [[nodiscard]] THAWSLIDE_HD Vec position_of(std::uint32_t particle) const {
    return args.particles.position.template load_vector<Dim>(ScalarIndex{{particle}});
  }
  [[nodiscard]] THAWSLIDE_HD Vector<double, Dim - 1> slope_of(std::uint32_t particle) const {
    return args.has_ground ? args.particles.ground_slope.template load_vector<Dim - 1>(ScalarIndex{{particle}})
                           : Vector<double, Dim - 1>(Vector<double, Dim - 1>::Zero());
  }

  // Lists the particles that reach a node, and adds their slopes. Returns the list's end.
  THAWSLIDE_HD BoxEdge* list(const Body& body, std::size_t node, BoxEdge* edges, Vector<double, Dim - 1>& slope) const {
    body.for_ranks_at(node, [this, &edges, &slope](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t k = first; k < last; ++k) {
        const std::uint32_t particle = args.tables.order[k];
        *edges++ = {0.0, particle};
        slope += slope_of(particle);
      }
    });
    return edges;
  }

  // Gradients of the nodal volumes V_1 and V_2, averaged over the surrounding nodes. The first, V_1 grad V_2 - V_2 grad
  // V_1, is along the gradient of ln(V_2 / V_1); a cut through both bodies, as by the ground, does not rotate it. The
  // others are -grad V_1 and grad V_2.
  THAWSLIDE_HD static void find_gradients(const Body& first, const Body& second, const typename T::Index& here,
                                          Vec (&gradients)[kinds]) {
    for (Vec& gradient : gradients) {
      gradient.setZero();
    }
    for (int about = 0; about < T::stencil; ++about) {
      typename T::Index node = here;
      double weight = 1;
      for (std::size_t a = 0, rest = static_cast<std::size_t>(about); a < Dim; ++a, rest /= 3) {
        node[a] += static_cast<int>(rest % 3) - 1;
        weight *= rest % 3 == 1 ? 0.5 : 0.25;
      }
      const Vec of_first = first.change_about(node), of_second = second.change_about(node);
      gradients[0] += weight * (first.volume(node) * of_second - second.volume(node) * of_first);
      gradients[1] -= weight * of_first;
      gradients[2] += weight * of_second;
    }
  }

  // Computes the edges of particles on the side given by a sign; returns the foremost one.
  THAWSLIDE_HD double set_edges(const Vec& normal, double sign, BoxEdge* edges, const BoxEdge* end) const {
    double foremost = -std::numeric_limits<double>::max();
    for (; edges != end; ++edges) {
      Vec on_grid = normal;
      on_grid.template head<Dim - 1>() += normal[Dim - 1] * slope_of(edges->particle);
      double stretch = 0;
      for (int a = 0; a < Dim; ++a) {
        stretch = max(stretch, std::abs(on_grid[a]));
      }
      edges->along = position_of(edges->particle).dot(normal) + sign * stretch * half_of(edges->particle);
      foremost = max(foremost, sign * edges->along);
    }
    return sign * foremost;
  }

  // Shell sort, with the foremost first on the side given by a sign.
  THAWSLIDE_HD static void sort(BoxEdge* edges, const BoxEdge* end, double sign) {
    for (const int step : {132, 57, 23, 10, 4, 1}) {
      for (int k = step; k < end - edges; ++k) {
        const BoxEdge one = edges[k];
        int place = k;
        for (; place >= step && sign * edges[place - step].along < sign * one.along; place -= step) {
          edges[place] = edges[place - step];
        }
        edges[place] = one;
      }
    }
  }

  // Gap along a normal between two bodies: the smallest one between particles that face each other across it, or the
  // largest number if there are none. Edges are sorted with the foremost first.
  THAWSLIDE_HD double gap_between(const BoxEdge* edges, const BoxEdge* other_edges, const BoxEdge* end,
                                  const Vec& normal) const {
    double gap = std::numeric_limits<double>::max();
    for (const BoxEdge* from = edges; from != other_edges; ++from) {
      for (const BoxEdge* to = other_edges; to != end && to->along - from->along < gap; ++to) {
        const Vec apart = position_of(to->particle) - position_of(from->particle);
        const Vec across = apart - apart.dot(normal) * normal;
        const double reach = half_of(to->particle) + half_of(from->particle);
        gap = across.squaredNorm() < reach * reach ? to->along - from->along : gap;
      }
    }
    return gap;
  }
};

// Adds the impulses between the bodies at a node to their forces. Three bodies that meet exchange momentum in turn.
template <class Nodes, int Dim>
struct ExchangeMomentum {
  using Layout = MomentumLayout<Dim>;
  using Vec = Vector<double, Dim>;
  BodyContactArgs<Nodes, Dim> args;
  const BlockPair* pairs;
  const std::uint32_t* first_of_place;
  Meeting<Dim>* meetings;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t place = k / args.block_nodes, node = k % args.block_nodes;
    for (std::size_t p = first_of_place[place]; p < first_of_place[place + 1]; ++p) {
      if (meetings[p * args.block_nodes + node].in_contact) {
        exchange(pairs[p], node, meetings[p * args.block_nodes + node]);
      }
    }
  }

 private:
  [[nodiscard]] THAWSLIDE_HD Vec trial_velocity(const double* record) const {
    return Vec(((1.0 - args.mass_damping * args.dt) * vector_at<Dim>(record, Layout::momentum) +
                args.dt * vector_at<Dim>(record, Layout::force)) /
               record[Layout::mass]);
  }
  THAWSLIDE_HD void exchange(const BlockPair& pair, std::size_t node, Meeting<Dim>& meeting) const {
    double* first = args.nodes.template write<Momentum>(Nodes::node(pair.block, node));
    double* second = args.nodes.template write<Momentum>(Nodes::node(pair.other, node));
    const Vec approach = trial_velocity(first) - (pair.other_is_held ? Vec(Vec::Zero()) : trial_velocity(second));
    const double closing = approach.dot(meeting.normal);
    const Vec slip = approach - closing * meeting.normal;
    const double slip_speed = slip.norm();
    const auto impulse = pair.other_is_held ? physics::impulse_on_fixed_body(first[Layout::mass], closing, slip_speed,
                                                                             meeting.gap, args.dt, pair.friction)
                                            : physics::body_impulse(first[Layout::mass], second[Layout::mass], closing,
                                                                    slip_speed, meeting.gap, args.dt, pair.friction);
    meeting.in_contact = impulse.normal > 0.0;
    if (!meeting.in_contact) {
      return;
    }
    meeting.impulse = impulse.normal * meeting.normal;
    if (slip_speed > 0.0) {
      meeting.impulse += (impulse.tangential / slip_speed) * slip;
    }
    const Vec force = meeting.impulse / args.dt;
    set_vector<Dim>(first, Layout::force, Vec(vector_at<Dim>(first, Layout::force) - force));
    set_vector<Dim>(second, Layout::force, Vec(vector_at<Dim>(second, Layout::force) + force));
  }
};

// Removes the approach of bodies in contact from the mapped-back velocities of a node, without friction.
template <class Nodes, int Dim>
struct SeparateMappedBack {
  using Vec = Vector<double, Dim>;
  BodyContactArgs<Nodes, Dim> args;
  const BlockPair* pairs;
  const std::uint32_t* first_of_place;
  const Meeting<Dim>* meetings;
  BodyContactWork* works;  // by place and node

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t place = k / args.block_nodes, node = k % args.block_nodes;
    BodyContactWork work;
    for (std::size_t p = first_of_place[place]; p < first_of_place[place + 1]; ++p) {
      if (meetings[p * args.block_nodes + node].in_contact) {
        separate(pairs[p], node, meetings[p * args.block_nodes + node], work);
      }
    }
    works[k] = work;
  }

 private:
  THAWSLIDE_HD void separate(const BlockPair& pair, std::size_t node, const Meeting<Dim>& meeting,
                             BodyContactWork& work) const {
    const auto first = Nodes::node(pair.block, node), second = Nodes::node(pair.other, node);
    const double mass = args.mass(first), other_mass = args.mass(second);
    const Vec approach = vector_at<Dim>(args.nodes.template read<Velocity>(first), 0) -
                         vector_at<Dim>(args.nodes.template read<Velocity>(second), 0);
    const double closing = approach.dot(meeting.normal);
    const auto impulse = pair.other_is_held
                             ? physics::impulse_on_fixed_body(mass, closing, 0.0, meeting.gap, args.dt, 0.0)
                             : physics::body_impulse(mass, other_mass, closing, 0.0, meeting.gap, args.dt, 0.0);
    change(first, -1.0, mass, impulse.normal, meeting, work);
    if (!pair.other_is_held) {
      change(second, 1.0, other_mass, impulse.normal, meeting, work);
    }
  }
  template <class Node>
  THAWSLIDE_HD void change(const Node& node, double sign, double mass, double impulse, const Meeting<Dim>& meeting,
                           BodyContactWork& work) const {
    double* velocity = args.nodes.template write<Velocity>(node);
    const Vec before = vector_at<Dim>(velocity, 0);
    const Vec change = (sign * impulse / mass) * meeting.normal;
    const Vec middle = vector_at<Dim>(args.nodes.template read<Motion>(node), MotionLayout<Dim>::middle_velocity);
    const Vec internal =
        args.dt *
        (vector_at<Dim>(args.nodes.template read<Momentum>(node), MomentumLayout<Dim>::force) - mass * args.gravity);
    set_vector<Dim>(velocity, 0, Vec(before + change));
    work.loss -= sign * meeting.impulse.dot(middle);
    work.numerical -= sign * meeting.impulse.dot(Vec(middle - before - change)) + internal.dot(change);
  }
};

}  // namespace thawslide::mpm
