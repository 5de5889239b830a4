#include "terrain/profile_surface.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/rigid_points.hpp"

namespace thawslide::terrain {

template <int Dim>
typename ProfileSurface<Dim>::Point ProfileSurface<Dim>::gradient(const Point& point, double /*width*/) const {
  Point gradient = Point::Zero();
  gradient[0] = line_.gradient(point[0]);
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
  const Polyline::LinearFraction fraction = line_.linear_fraction(x, z, cell);
  const double across = Dim == 2 ? width_.at(x) : cell;  // integral of the shape function along y
  node.candidate = line_.highest(x - cell, x + cell) > z - cell + round_off * cell;
  const Vector<double, 2> point(x, z);
  Vector<double, 2> normal = nearest.normal;
  node.plane = point.dot(normal) + nearest.distance;
  if (fraction.length > round_off * cell) {
    const double resultant = fraction.resultant.norm();
    normal = fraction.resultant / resultant;
    node.bend = fraction.length / resultant;
    node.plane = normal.dot(point + fraction.moment / fraction.length);
  }
  if (!node.candidate) {
    node.plane = HUGE_VAL;
  }
  node.normal[0] = normal[0];
  node.normal[Dim - 1] = normal[1];
  node.area = across * fraction.length;
  if (Dim == 2 && fraction.length > round_off * cell) {
    node.area = width_.at(x + fraction.moment[0] / fraction.length) * fraction.length;
  }
  node.space = across * fraction.above;
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
