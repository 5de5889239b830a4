// Reference particles, individually by id, and their transfers to and from nodes with plain weights, for
// scalar_step.hpp, scalar_contact.hpp and scalar_columns.hpp.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::testing_support {

// The state of one particle.
template <int Dim>
struct Point {
  using Place = Vector<double, Dim>;
  Place position, velocity, displacement;
  SymmetricTensor<double> stress;
  double mass, volume, initial_volume, plastic_strain, temperature, heat_content, saturation, porosity,
      initial_porosity;
  double initial_saturation, pore_void, normal_load, seeped_water;
  double liquid_pressure, pore_pressure, flow_depth, scaling, slip, path_length, contact_offset, half;
  bool in_band;
  std::size_t material;
  double old_temperature = 0, capacity = 0, conduction_in_cell = 0;
  Place step = Place::Zero();  // displacement in the step
};

// All particles, by id.
template <int Dim>
std::vector<Point<Dim>> points_of(const sim::Simulation<Dim>& simulation) {
  const auto& particles = simulation.particles();
  std::vector<Point<Dim>> points(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    Point<Dim>& point = points[static_cast<std::size_t>(particles.id(p))];
    point.position = particles.position.template get<Vector<double, Dim>>(p);
    point.velocity = particles.velocity.template get<Vector<double, Dim>>(p);
    point.displacement = particles.displacement.template get<Vector<double, Dim>>(p);
    point.stress = mpm::full_tensor<Dim>(particles.stress, p);
    point.mass = particles.mass(p);
    point.volume = particles.volume(p);
    point.initial_volume = particles.initial_volume(p);
    point.plastic_strain = particles.plastic_strain(p);
    point.temperature = particles.temperature(p);
    point.heat_content = particles.heat_content(p);
    point.saturation = particles.liquid_saturation(p);
    point.porosity = particles.porosity(p);
    point.initial_porosity = particles.initial_porosity(p);
    const auto if_kept = [p](const auto& field) { return field.is_kept() ? field(p) : 0.0; };
    point.initial_saturation = particles.initial_saturation(p);
    point.pore_void = if_kept(particles.pore_void);
    point.normal_load = if_kept(particles.normal_load);
    point.seeped_water = if_kept(particles.seeped_water);
    point.liquid_pressure = particles.liquid_pressure(p);
    point.pore_pressure = particles.pore_pressure(p);
    point.flow_depth = particles.flow_depth(p);
    point.scaling = particles.thermal_scaling(p);
    point.slip = particles.slip(p);
    point.path_length = particles.path_length(p);
    point.contact_offset = particles.contact_offset(p);
    point.in_band = particles.in_band(p) != 0;
    point.half = simulation.model().motion.sizes.half(static_cast<std::size_t>(particles.body(p)));
    point.material = static_cast<std::size_t>(particles.material(p));
  }
  return points;
}

// Node index along each axis, and nodal quantities.
template <int Dim>
using NodeIndex = std::array<int, Dim>;
template <int Dim, class Value>
using ByNode = std::map<NodeIndex<Dim>, Value>;

// Contribution of a particle to nodes: weight * value, and gradient . flux to the first components.
template <int Dim>
struct Carried {
  std::vector<double> value;
  std::vector<Vector<double, Dim>> flux;
};

// Transfers with uGIMP and with the linear shape functions.
template <int Dim>
struct ScalarTransfer {
  using Index = NodeIndex<Dim>;
  using Place = Vector<double, Dim>;
  using Sums = ByNode<Dim, std::vector<double>>;
  enum Width { linear = 2, ugimp = 3 };

  double inverse_cell;

  // Calls visit(node, weight, gradient) for the nodes of a particle.
  template <class Visit>
  void for_nodes(const Point<Dim>& p, Width width, const Visit& visit) const {
    std::array<std::array<double, 3>, Dim> weight, slope;
    Index lowest;
    for (int a = 0; a < Dim; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const double s = p.position[a] * inverse_cell;
      if (width == linear) {
        lowest[axis] = static_cast<int>(std::floor(s));
        weight[axis] = {1.0 - (s - std::floor(s)), s - std::floor(s), 0.0};
        slope[axis] = {-inverse_cell, inverse_cell, 0.0};
      } else {
        const double nearest = std::floor(s + 0.5);
        const auto w = mpm::ugimp_weights(s - nearest, p.half, inverse_cell);
        lowest[axis] = static_cast<int>(nearest) - 1;
        weight[axis] = {w.weight[0], w.weight[1], w.weight[2]};
        slope[axis] = {w.slope[0], w.slope[1], w.slope[2]};
      }
    }
    for (int n = 0; n < mpm::power(width, Dim); ++n) {
      Index node;
      double product = 1.0;
      Place gradient = Place::Ones();
      int rest = n;
      for (std::size_t a = 0; a < Dim; ++a) {
        const auto i = static_cast<std::size_t>(rest % width);
        rest /= width;
        node[a] = lowest[a] + static_cast<int>(i);
        product *= weight[a][i];
        for (int b = 0; b < Dim; ++b) {
          gradient[b] *= static_cast<std::size_t>(b) == a ? slope[a][i] : weight[a][i];
        }
      }
      visit(node, product, gradient);
    }
  }

  // Sums of `size` components over particles that carry of(particle).
  template <class Of>
  [[nodiscard]] Sums add_up(const std::vector<Point<Dim>>& points, Width width, std::size_t size, const Of& of) const {
    Sums sums;
    for (const Point<Dim>& p : points) {
      const Carried<Dim> carried = of(p);
      for_nodes(p, width, [&](const Index& node, double weight, const Place& gradient) {
        auto& sum = sums[node];
        sum.resize(size, 0.0);
        for (std::size_t c = 0; c < carried.value.size(); ++c) {
          sum[c] += weight * carried.value[c];
        }
        for (std::size_t c = 0; c < carried.flux.size(); ++c) {
          sum[c] += gradient.dot(carried.flux[c]);
        }
      });
    }
    return sums;
  }
};

}  // namespace thawslide::testing_support
