// One step particle by particle, number by number, by the plain functions: what the batches of the step must give. The
// motion of the nodes after contact and the depth of flow are taken from the simulation. For uGIMP, FLIP and the heat
// content form, without conditions for heat on the domain's faces.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "physics/clapeyron.hpp"
#include "physics/kinematics.hpp"
#include "physics/pressurization.hpp"
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
  double liquid_pressure, pore_pressure, flow_depth, scaling, slip, half;
  std::size_t material;
  double old_temperature = 0, capacity = 0, conduction_in_cell = 0, seepage_in_cell = 0;
};

// All particles, by id.
template <int Dim>
std::vector<Point<Dim>> points_of(const sim::Simulation<Dim, double>& simulation) {
  const auto& particles = simulation.particles();
  std::vector<Point<Dim>> points(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    Point<Dim>& point = points[static_cast<std::size_t>(particles.id(p))];
    point.position = particles.position.template get<Vector<double, Dim>>(p);
    point.velocity = particles.velocity.template get<Vector<double, Dim>>(p);
    point.displacement = particles.displacement.template get<Vector<double, Dim>>(p);
    point.stress = mpm::full_tensor<Dim, double>(particles.stress, p);
    point.mass = particles.mass(p);
    point.volume = particles.volume(p);
    point.initial_volume = particles.initial_volume(p);
    point.plastic_strain = particles.plastic_strain(p);
    point.temperature = particles.temperature(p);
    point.heat_content = particles.heat_content(p);
    point.saturation = particles.liquid_saturation(p);
    point.porosity = particles.porosity(p);
    point.initial_porosity = particles.initial_porosity(p);
    point.liquid_pressure = particles.liquid_pressure(p);
    point.pore_pressure = particles.pore_pressure(p);
    point.flow_depth = particles.flow_depth(p);
    point.scaling = particles.thermal_scaling(p);
    point.slip = particles.slip(p);
    point.half = simulation.model().motion.sizes.half(static_cast<std::size_t>(particles.body(p)));
    point.material = static_cast<std::size_t>(particles.material(p));
  }
  return points;
}

template <int Dim>
class ScalarStep {
 public:
  using Index = std::array<int, Dim>;
  using Place = Vector<double, Dim>;
  using Sums = std::map<Index, std::vector<double>>;
  static constexpr double tref = 0.0;

  // simulation: after the step of dt that began with `points`.
  ScalarStep(const sim::Simulation<Dim, double>& simulation, double dt, std::vector<Point<Dim>> points)
      : points_(std::move(points)), simulation_(simulation), dt_(dt), inverse_cell_(1.0 / simulation.grid().cell()) {
    momentum_ = add_up(3, mpm::MomentumLayout<Dim>::size, [&](const Point<Dim>& p) { return momentum_of(p); });
    hats_ = add_up(2, mpm::HatLayout::size, [&](const Point<Dim>& p) {
      return Carried{{p.volume, p.volume * p.temperature, p.volume * p.pore_pressure}, {}};
    });
    near_base_by_mass_ = add_up(3, mpm::NearBaseLayout::by_mass, [&](const Point<Dim>& p) {
      return Carried{{p.mass * p.temperature, p.mass * p.pore_pressure, p.mass * p.saturation,
                      p.mass * solid_fraction(p), p.mass * p.slip},
                     {}};
    });
    near_base_by_hats_ = add_up(2, 2, [&](const Point<Dim>& p) {
      return Carried{{p.volume * p.saturation, p.volume * solid_fraction(p)}, {}};
    });
    for (std::size_t b = 0; b < simulation.grid().blocks().size(); ++b) {
      const Index tile = mpm::Tile<Dim>::index(simulation.grid().blocks()[b]);
      for (int k = 0; k < mpm::Tile<Dim>::nodes; ++k) {
        place_[mpm::Tile<Dim>::node(tile, k)] = {b, static_cast<std::size_t>(k)};
      }
    }
    const auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      points_[static_cast<std::size_t>(particles.id(p))].flow_depth = particles.flow_depth(p);
    }
    move();
    deform();
    conduct();
    drain();
  }

  // By node: the sums of momentum_to_grid, of average_band_on_grid, of near_base_to_grid, and the mapped-back momentum.
  [[nodiscard]] const Sums& momentum() const { return momentum_; }
  [[nodiscard]] const Sums& hats() const { return hats_; }
  [[nodiscard]] const Sums& near_base_by_mass() const { return near_base_by_mass_; }
  [[nodiscard]] const Sums& near_base_by_hats() const { return near_base_by_hats_; }
  [[nodiscard]] const Sums& mapped() const { return mapped_; }
  [[nodiscard]] std::pair<std::size_t, std::size_t> at(const Index& node) const { return place_.at(node); }
  // The particles after the step, by id; positions are still the old ones.
  [[nodiscard]] const std::vector<Point<Dim>>& points() const { return points_; }

 private:
  // What a particle adds: weight * value, and gradient . flux to the first components.
  struct Carried {
    std::vector<double> value;
    std::vector<Place> flux;
  };

  // Calls visit(node, weight, gradient) for the nodes of uGIMP (width 3) or of the hats (width 2).
  template <class Visit>
  void for_nodes(const Point<Dim>& p, int width, const Visit& visit) const {
    std::array<std::array<double, 3>, Dim> weight, slope;
    Index lowest;
    for (int a = 0; a < Dim; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const double s = p.position[a] * inverse_cell_;
      if (width == 2) {
        lowest[axis] = static_cast<int>(std::floor(s));
        weight[axis] = {1.0 - (s - std::floor(s)), s - std::floor(s), 0.0};
        slope[axis] = {-inverse_cell_, inverse_cell_, 0.0};
      } else {
        const double nearest = std::floor(s + 0.5);
        const auto w = mpm::ugimp_weights(s - nearest, p.half, inverse_cell_);
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

  template <class Of>
  [[nodiscard]] Sums add_up(int width, std::size_t size, const Of& of) const {
    Sums sums;
    for (const Point<Dim>& p : points_) {
      const Carried carried = of(p);
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

  [[nodiscard]] double solid_fraction(const Point<Dim>& p) const {
    return physics::effective_solid_fraction(phases(), p.porosity, p.saturation);
  }
  [[nodiscard]] const physics::Phases<double>& phases() const { return simulation_.model().motion.phases; }

  [[nodiscard]] Carried momentum_of(const Point<Dim>& p) const {
    constexpr int row[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    Carried carried;
    for (int a = 0; a < Dim; ++a) {
      carried.value.push_back(p.mass * simulation_.model().motion.gravity[a]);
      Place flux;
      for (int b = 0; b < Dim; ++b) {
        flux[b] = -p.volume * p.stress[row[a][b]];
      }
      carried.flux.push_back(flux);
    }
    carried.value.resize(mpm::MomentumLayout<Dim>::size);
    for (int a = 0; a < Dim; ++a) {
      carried.value[mpm::MomentumLayout<Dim>::momentum + static_cast<std::size_t>(a)] = p.mass * p.velocity[a];
    }
    carried.value[mpm::MomentumLayout<Dim>::mass] = p.mass;
    carried.value[mpm::MomentumLayout<Dim>::volume] = p.volume;
    return carried;
  }

  void move() {
    using Layout = mpm::MotionLayout<Dim>;
    for (Point<Dim>& p : points_) {
      for_nodes(p, 3, [&](const Index& node, double weight, const Place& /*gradient*/) {
        const auto [b, k] = place_.at(node);
        const auto& motion = simulation_.nodes().motion(b, k);
        for (std::size_t a = 0; a < Dim; ++a) {
          p.velocity[static_cast<int>(a)] += dt_ * weight * motion[Layout::acceleration + a];
          p.displacement[static_cast<int>(a)] += dt_ * weight * motion[Layout::middle_velocity + a];
        }
      });
    }
    mapped_ = add_up(3, Dim, [&](const Point<Dim>& p) {
      Carried carried;
      for (int a = 0; a < Dim; ++a) {
        carried.value.push_back(p.mass * p.velocity[a]);
      }
      return carried;
    });
  }

  void deform() {
    for (Point<Dim>& p : points_) {
      Matrix<double, Dim> gradient = Matrix<double, Dim>::Zero();
      for_nodes(p, 3, [&](const Index& node, double /*weight*/, const Place& slope) {
        const auto [b, k] = place_.at(node);
        gradient += dt_ * mpm::vector_at<Dim, double>(simulation_.nodes().velocity(b, k), 0) * slope.transpose();
      });
      const auto& material = simulation_.model().motion.materials[p.material];
      const auto increment = physics::strain_increment<double, Dim>(gradient);
      const SymmetricTensor<double> trial = physics::rotate<double, Dim>(p.stress, increment.rotation) +
                                            physics::stress_increment(material.elastic, increment.strain);
      const auto result =
          std::visit([&](const auto& law) { return law.template update<Dim>(trial, p.plastic_strain); }, material.law);
      p.stress = result.stress;
      p.plastic_strain += result.equivalent_plastic_strain_increment;
      p.volume *= increment.volume_ratio;
      const double volume_strain = increment.strain[0] + increment.strain[1] + increment.strain[2];
      p.porosity = physics::updated_porosity(phases(), p.porosity, volume_strain, 0.0);
    }
  }

  // The rate of temperature of every node [K/s] from sums of heat flow, capacity and heat levelled in cells.
  [[nodiscard]] std::map<Index, double> rates(const Sums& flows, const Sums& stored) const {
    std::map<Index, double> rate;
    for (const auto& [node, sum] : stored) {
      const auto [b, k] = place_.at(node);
      const double friction = simulation_.nodes().contact(b, k)[mpm::ContactLayout::friction_heat];
      rate[node] = sum[0] > 0.0 ? (flows.at(node)[0] + flows.at(node)[1] + friction - sum[1] / dt_) / sum[0] : 0.0;
    }
    return rate;
  }

  // The friction heat of nodes without hat weight [J/m3], by the weight of the particle's momentum there.
  [[nodiscard]] double orphan_heat(const Point<Dim>& p, const Sums& stored) const {
    double power = 0.0;
    for_nodes(p, 3, [&](const Index& node, double weight, const Place& /*gradient*/) {
      const auto [b, k] = place_.at(node);
      const double friction = simulation_.nodes().contact(b, k)[mpm::ContactLayout::friction_heat];
      const auto held = stored.find(node);
      if (friction > 0.0 && (held == stored.end() || !(held->second[0] > 0.0))) {
        power += weight * friction / momentum_.at(node)[mpm::MomentumLayout<Dim>::mass];
      }
    });
    return dt_ * power * p.mass * p.scaling / p.initial_volume;
  }

  [[nodiscard]] double change(const Point<Dim>& p, const std::map<Index, double>& rate) const {
    double sum = p.conduction_in_cell;
    for_nodes(p, 2, [&](const Index& node, double weight, const Place& /*gradient*/) {
      sum += dt_ * weight * rate.at(node);
    });
    return sum;
  }

  // A hat average of the step's start, at the particle's place, and its gradient.
  struct Seen {
    double value = 0.0;
    Place gradient = Place::Zero();
  };
  [[nodiscard]] Seen seen(const Point<Dim>& p, std::size_t component) const {
    Seen seen;
    for_nodes(p, 2, [&](const Index& node, double weight, const Place& slope) {
      const auto& hat = hats_.at(node);
      const double average = hat[0] > 0.0 ? hat[component] / hat[0] : 0.0;
      seen.value += weight * average;
      seen.gradient += average * slope;
    });
    return seen;
  }

  void conduct() {
    simulation_.model().band.with_heat_content([&](const auto& content) {
      const Sums flows = add_up(2, 2, [&](const Point<Dim>& p) { return heat_flow(p); });
      const auto stored = [&] {
        return add_up(2, 2, [&](const Point<Dim>& p) {
          const double capacity = p.initial_volume / p.scaling * p.capacity;
          return Carried{{capacity, capacity * p.conduction_in_cell}, {}};
        });
      };
      for (Point<Dim>& p : points_) {
        p.capacity = content.apparent_capacity(p.temperature, p.initial_porosity);
        const double conductivity = physics::conductivity(phases(), p.porosity, p.saturation);
        p.conduction_in_cell =
            (seen(p, mpm::HatLayout::temperature).value - p.temperature) *
            physics::share_levelled_within_cell(conductivity / p.capacity, inverse_cell_ * p.scaling, Dim, dt_);
      }
      const auto first = rates(flows, stored());
      for (Point<Dim>& p : points_) {
        p.capacity = content.secant_capacity(p.temperature, change(p, first), p.initial_porosity);
      }
      const Sums held = stored();
      const auto second = rates(flows, held);
      for (Point<Dim>& p : points_) {
        const double taken = p.capacity * change(p, second) + orphan_heat(p, held);
        p.old_temperature = p.temperature;
        if (p.heat_content + taken != p.heat_content) {
          p.heat_content += taken;
          p.temperature = content.temperature(p.heat_content, p.initial_porosity, p.temperature + taken / p.capacity);
          p.saturation = content.curve.saturation(p.temperature);
          p.porosity = physics::updated_porosity(phases(), p.porosity, 0.0, p.temperature - p.old_temperature);
        }
      }
    });
  }

  [[nodiscard]] Carried heat_flow(const Point<Dim>& p) const {
    const Place by_temperature = seen(p, mpm::HatLayout::temperature).gradient;
    const Place by_pressure = seen(p, mpm::HatLayout::pore_pressure).gradient;
    const double conductivity = physics::conductivity(phases(), p.porosity, p.saturation);
    const double mobility =
        p.scaling * simulation_.model().band.hydraulic_conductivity[p.material] / phases().water_unit_weight;
    const double advection = p.temperature < tref ? 0.0
                                                  : p.volume * phases().water_density * phases().water_heat_capacity *
                                                        mobility * by_pressure.dot(by_temperature);
    return {{0.0, advection}, {-p.volume * p.scaling * conductivity * by_temperature}};
  }

  void drain() {
    const auto& band = simulation_.model().band;
    const auto conductivity = [&](const Point<Dim>& p) { return band.hydraulic_conductivity[p.material]; };
    const Sums flows = add_up(2, 3, [&](Point<Dim> p) {
      const Seen around = seen(p, mpm::HatLayout::pore_pressure);
      const bool flowing = p.old_temperature >= tref;
      const double space = p.volume / p.scaling * p.porosity;
      const double flow =
          p.volume * p.scaling * conductivity(p) / phases().water_unit_weight * phases().water_bulk_modulus;
      return Carried{{0.0, space, flowing ? space * levelled(p, around.value) : 0.0},
                     {flowing ? Place(-flow * around.gradient) : Place(Place::Zero())}};
    });
    for (Point<Dim>& p : points_) {
      const double ice = physics::ice_pressure(phases(), band.gravity, p.flow_depth);
      if (p.temperature < tref) {
        p.liquid_pressure = physics::liquid_pressure_clapeyron(phases(), ice, p.temperature, tref, band.clapeyron_sign);
        p.pore_pressure = physics::pore_pressure(p.saturation, p.liquid_pressure, ice);
        continue;
      }
      const bool flowing = p.old_temperature >= tref;
      double pressure = flowing ? p.liquid_pressure + levelled(p, seen(p, mpm::HatLayout::pore_pressure).value)
                                : ice * phases().water_density / phases().ice_density;
      for_nodes(p, 2, [&](const Index& node, double weight, const Place& /*slope*/) {
        const auto& sum = flows.at(node);
        pressure += flowing && sum[1] > 0.0 ? weight * (dt_ * sum[0] - sum[2]) / sum[1] : 0.0;
      });
      p.liquid_pressure = p.pore_pressure =
          pressure + physics::undrained_pressure_coefficient(phases(), p.porosity, p.saturation) *
                         (p.temperature - (flowing ? p.old_temperature : tref));
    }
  }

  // What levelling within the cell brings to the pressure.
  [[nodiscard]] double levelled(const Point<Dim>& p, double level) const {
    const double diffusivity =
        p.scaling * p.scaling *
        physics::hydraulic_diffusivity(phases(), p.porosity, 1.0,
                                       simulation_.model().band.hydraulic_conductivity[p.material]);
    return (level - p.pore_pressure) * physics::share_levelled_within_cell(diffusivity, inverse_cell_, Dim, dt_);
  }

  std::vector<Point<Dim>> points_;
  const sim::Simulation<Dim, double>& simulation_;
  double dt_, inverse_cell_;
  Sums momentum_, hats_, near_base_by_mass_, near_base_by_hats_, mapped_;
  std::map<Index, std::pair<std::size_t, std::size_t>> place_;
};

}  // namespace thawslide::testing_support
