#include "terrain/profile_surface.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/rigid_points.hpp"

namespace thawslide::terrain {

template <int Dim>
typename ProfileSurface<Dim>::Place ProfileSurface<Dim>::gradient(const Place& place, double /*width*/) const {
  Place gradient = Place::Zero();
  gradient[0] = line_.gradient(place[0]);
  return gradient;
}

template <int Dim>
void ProfileSurface<Dim>::fit_to_points(double x, double z, double cell, GroundAtNode<Dim>& node) const {
  const RigidPoints::AtNode rock = RigidPoints(line_, spacing_, layers_).at_node(x, z, cell);
  const double across = Dim == 2 ? width_.at(x) : cell;
  const double slide = std::max(0.0, cell * cell - rock.volume);
  node.candidate = rock.volume > 0.0;
  node.plane = node.candidate ? x * rock.normal[0] + z * rock.normal[1] + node.distance : HUGE_VAL;
  node.normal[0] = rock.normal[0];
  node.normal[Dim - 1] = rock.normal[1];
  node.area = across * nairn_area(slide, rock.volume, cell);
  node.space = across * slide;
}

template <int Dim>
GroundAtNode<Dim> ProfileSurface<Dim>::at_node(const Vector<double, Dim>& position, double cell) const {
  constexpr double round_off = 1e-9;
  const double x = position[0], z = position[Dim - 1];
  const Polyline::Nearest nearest = line_.nearest(x, z);
  GroundAtNode<Dim> node;
  node.normal.setZero();
  node.distance = nearest.distance;
  if (spacing_ > 0.0) {
    fit_to_points(x, z, cell, node);
    return node;
  }
  const Polyline::LinearShare share = line_.linear_share(x, z, cell);
  const double across = Dim == 2 ? width_.at(x) : cell;  // integral of the shape function along y
  node.candidate = line_.highest(x - cell, x + cell) > z - cell + round_off * cell;
  const Vector<double, 2> place(x, z);
  Vector<double, 2> normal = nearest.normal;
  node.plane = place.dot(normal) + nearest.distance;
  if (share.length > round_off * cell) {
    const double resultant = share.resultant.norm();
    normal = share.resultant / resultant;
    node.bend = share.length / resultant;
    node.plane = normal.dot(place + share.moment / share.length);
  }
  if (!node.candidate) {
    node.plane = HUGE_VAL;
  }
  node.normal[0] = normal[0];
  node.normal[Dim - 1] = normal[1];
  node.area = across * share.length;
  if (Dim == 2 && share.length > round_off * cell) {
    node.area = width_.at(x + share.moment[0] / share.length) * share.length;
  }
  node.space = across * share.above;
  return node;
}

template <int Dim>
void ProfileSurface<Dim>::at_block(const NodeIndex& first, double cell, int edge, GroundAtNode<Dim>* nodes) const {
  int count = 1;
  for (int a = 0; a < Dim; ++a) {
    count *= edge;
  }
  for (int k = 0; k < count; ++k) {
    Vector<double, Dim> position;
    for (int a = 0, rest = k; a < Dim; ++a, rest /= edge) {
      position[a] = static_cast<double>(first[static_cast<std::size_t>(a)] + rest % edge) * cell;
    }
    nodes[k] = at_node(position, cell);
  }
}

template class ProfileSurface<2>;
template class ProfileSurface<3>;

}  // namespace thawslide::terrain
