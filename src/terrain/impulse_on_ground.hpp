// Which nodes keep the slide from entering the ground, and with what impulse (Eq. 15; the paper's ground lies along
// nodes). The ground acts at its surface, and nodes share that force by their shape functions there. Along the grid's
// axis nearest to the normal, the ground crosses a column of nodes between two of them, the lower L and the upper U,
// with the shape functions s_L and s_U = 1 - s_L at the crossing:
//   v_s = s_L p_L.n_L/m_L + s_U p_U.n_U/m_U
//   lambda = max(0, (v_s - g/dt)/(s_L^2/m_L + s_U^2/m_U)),   q_L = s_L lambda,   q_U = s_U lambda
// so that the surface moves no further than the clearance g. Held each by itself, U would keep the layer of slide
// between it and the ground from thinning. On ground along nodes s_L = 1, and q is Eq. 15's. Without the distance check
// each node is held by itself, as in the paper: then L may have next to no mass. For host and device.
#pragma once

#include "base/select.hpp"
#include "mpm/tile.hpp"
#include "terrain/main_axis.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

// Of the slide above the ground in the cell that the ground cuts, in cells: a thinner layer would need a shorter time
// step, and U is taken to lie on the ground.
inline constexpr double thinnest_layer = 0.25;
// GroundAtNode::bend of L and U at most: the normals within reach differ by 0.1 rms. Where they differ more, as in a
// thalweg, the crossing is not that of the column, and each node is held by itself.
inline constexpr double largest_bend = 1.005;

// What a candidate node has of the impulse on the ground.
template <int Dim, class Real>
struct ShareOfImpulse {
  Real own = 1, other = 0;                // shape functions at the crossing; other: 0 where the node acts alone
  typename mpm::Tile<Dim>::Beside where;  // the other node
};

// How a node of the slide meets the ground.
template <class Real>
struct ImpactOfNode {
  Real mass = 0;             // [kg]; 0: there is no slide
  Real inward_momentum = 0;  // p.n [kg m/s]
  Real clearance = 0;        // [m]
};

// The axis across the ground at a node, and the step along it away from the ground.
struct AcrossGround {
  int axis, outward;

  THAWSLIDE_HD bool operator==(const AcrossGround& other) const {
    return axis == other.axis && outward == other.outward;
  }
};
template <int Dim, class Real>
THAWSLIDE_HD AcrossGround across_ground(const Vector<Real, Dim>& into_ground) {
  const int axis = main_axis<Dim, Real>(into_ground);
  return {axis, into_ground[axis] > Real(0) ? -1 : 1};
}

// Whether the ground crosses a node's column on the node or within a cell further out.
template <int Dim, class Real>
THAWSLIDE_HD bool is_below_crossing(const GroundAtNode<Dim, Real>& known) {
  constexpr Real round_off = static_cast<Real>(1e-6);
  return known.height <= round_off && known.height > Real(-1) + round_off;
}

// local: a candidate node's place in its block. beside(direction, local): what another node knows of the ground, null
// where there is none.
template <int Dim, class Real, class NodeBeside>
THAWSLIDE_HD ShareOfImpulse<Dim, Real> share_of_impulse(std::size_t local, const GroundAtNode<Dim, Real>& known,
                                                        const NodeBeside& beside) {
  ShareOfImpulse<Dim, Real> share;
  const AcrossGround across = across_ground<Dim, Real>(known.normal);
  const bool is_lower = is_below_crossing(known);
  if (!is_lower && known.height < Real(0)) {
    return share;
  }
  share.where =
      mpm::Tile<Dim>::beside(static_cast<int>(local), across.axis, is_lower ? across.outward : -across.outward);
  const GroundAtNode<Dim, Real>* other = beside(share.where.direction, share.where.local);
  if (other == nullptr || !other->candidate || max(known.bend, other->bend) > static_cast<Real>(largest_bend) ||
      !(across_ground<Dim, Real>(other->normal) == across) || is_below_crossing(*other) == is_lower ||
      (other->height > known.height) != is_lower) {
    return share;
  }
  const Real depth = -(is_lower ? known : *other).height;  // of L, in cells: s_U
  const Real of_upper = depth > Real(1) - static_cast<Real>(thinnest_layer) ? Real(1) : max(Real(0), depth);
  share.own = is_lower ? Real(1) - of_upper : of_upper;
  share.other = Real(1) - share.own;
  return share;
}

// q of a node [kg m/s].
template <int Dim, class Real>
THAWSLIDE_HD Real normal_impulse(const ShareOfImpulse<Dim, Real>& share, bool distance_check, Real dt,
                                 const ImpactOfNode<Real>& node, const ImpactOfNode<Real>& other) {
  const auto left = [&](Real clearance) { return max(Real(0), clearance) / dt; };
  if (!distance_check) {
    return max(Real(0), node.inward_momentum);
  }
  if (!(other.mass > Real(0))) {
    return max(Real(0), node.inward_momentum - node.mass * left(node.clearance));
  }
  const Real speed =
      share.own * (node.inward_momentum / node.mass) + share.other * (other.inward_momentum / other.mass);
  const Real mobility = share.own * (share.own / node.mass) + share.other * (share.other / other.mass);
  return share.own * max(Real(0), (speed - left(min(node.clearance, other.clearance))) / mobility);
}

}  // namespace thawslide::terrain
