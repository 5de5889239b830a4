// Reference for the SIMD implementation of a step, computed particle by particle and node by node with plain functions.
// The ground at nodes is taken from the simulation. It covers uGIMP, FLIP, the heat content form, lubricated friction
// and constant cohesion, and the band everywhere or in the first layer. It excludes thermal conditions on the domain's
// faces, walls, frames and a changing band. Energies are tested with the budgets.
#pragma once

#include <optional>

#include "physics/clapeyron.hpp"
#include "physics/kinematics.hpp"
#include "physics/pressurization.hpp"
#include "scalar_columns.hpp"
#include "scalar_contact.hpp"
#include "scalar_water.hpp"

namespace thawslide::testing_support {

template <int Dim>
class ScalarStep {
 public:
  using Index = NodeIndex<Dim>;
  using Place = Vector<double, Dim>;
  using Transfer = ScalarTransfer<Dim>;
  using Sums = typename Transfer::Sums;
  static constexpr double tref = 0.0;

  // simulation: after the step of dt that began with `points`.
  ScalarStep(const sim::Simulation<Dim>& simulation, double dt, std::vector<Point<Dim>> points)
      : points_(std::move(points)), simulation_(simulation), dt_(dt), transfer_{1.0 / simulation.grid().cell()} {
    momentum_ = add_up(Transfer::ugimp, mpm::MomentumLayout<Dim>::size, [&](const auto& p) { return momentum_of(p); });
    linear_ = add_up(Transfer::linear, mpm::components_of<mpm::Averages, Dim>, [&](const Point<Dim>& p) {
      return Carried<Dim>{{p.volume, p.volume * p.temperature, p.volume * p.pore_pressure}, {}};
    });
    seeping_ = add_up(Transfer::linear, 2, [&](const Point<Dim>& p) { return seeping_water(p); });
    near_ground_by_mass_ = add_up(Transfer::ugimp, mpm::NearGround::by_mass, [&](const Point<Dim>& p) {
      return Carried<Dim>{{p.mass * p.temperature, p.mass * p.pore_pressure, p.mass * p.saturation,
                           p.mass * solid_fraction(p), p.mass * p.slip},
                          {}};
    });
    near_ground_by_linear_ = add_up(Transfer::linear, 2, [&](const Point<Dim>& p) {
      return Carried<Dim>{{p.volume * p.saturation, p.volume * solid_fraction(p)}, {}};
    });
    ByNode<Dim, terrain::GroundAtNode<Dim>> ground;
    for (std::size_t b = 0; b < simulation.grid().blocks().size(); ++b) {
      const Index tile = mpm::Tile<Dim>::index(simulation.grid().blocks()[b]);
      for (int k = 0; k < mpm::Tile<Dim>::nodes; ++k) {
        const Index node = mpm::Tile<Dim>::node(tile, k);
        place_[node] = {b, static_cast<std::size_t>(k)};
        ground[node] = simulation.ground()->block(b)[static_cast<std::size_t>(k)];
      }
    }
    contact_.emplace(simulation.model().contact, transfer_, points_,
                     ContactSums<Dim>{momentum_, linear_, near_ground_by_mass_, near_ground_by_linear_},
                     std::move(ground), dt);
    mark_band_and_slip();
    move();
    deform();
    if (simulation.model().band.frozen_rows != band::FrozenRows::draining) {
      seeping_ = add_up(Transfer::linear, 2, [&](const Point<Dim>& p) { return seeping_water(p); });
    }
    conduct();
    drain();
    for (Point<Dim>& p : points_) {
      p.position += p.step;
      p.path_length += p.step.norm();
    }
  }

  // By node: the sums of momentum_to_grid, of average_band_on_grid, of near_ground_to_grid, and the mapped-back
  // momentum.
  [[nodiscard]] const Sums& momentum() const { return momentum_; }
  [[nodiscard]] const Sums& linear() const { return linear_; }
  [[nodiscard]] const Sums& near_ground_by_mass() const { return near_ground_by_mass_; }
  [[nodiscard]] const Sums& near_ground_by_linear() const { return near_ground_by_linear_; }
  [[nodiscard]] const Sums& mapped() const { return mapped_; }
  [[nodiscard]] const ScalarContact<Dim>& contact() const { return *contact_; }
  [[nodiscard]] std::pair<std::size_t, std::size_t> at(const Index& node) const { return place_.at(node); }
  // Particles after the step, by id.
  [[nodiscard]] const std::vector<Point<Dim>>& points() const { return points_; }

 private:
  template <class Visit>
  void for_nodes(const Point<Dim>& p, typename Transfer::Width width, const Visit& visit) const {
    transfer_.for_nodes(p, width, visit);
  }
  template <class Of>
  [[nodiscard]] Sums add_up(typename Transfer::Width width, std::size_t size, const Of& of) const {
    return transfer_.add_up(points_, width, size, of);
  }

  [[nodiscard]] double solid_fraction(const Point<Dim>& p) const {
    return physics::effective_solid_fraction(phases(), p.porosity, p.saturation);
  }
  [[nodiscard]] const physics::Phases& phases() const { return simulation_.model().motion.phases; }

  [[nodiscard]] Carried<Dim> momentum_of(const Point<Dim>& p) const {
    constexpr int row[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    Carried<Dim> carried;
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

  // Band particles have a candidate node among the corners of their cell; slip is the average over touching nodes.
  void mark_band_and_slip() {
    for (Point<Dim>& p : points_) {
      p.in_band = false;
      double touching = 0.0, slip_speed = 0.0;
      for_nodes(p, Transfer::linear, [&](const Index& node, double weight, const Place& /*slope*/) {
        const auto [b, k] = place_.at(node);
        p.in_band = p.in_band || (weight > 0.0 && simulation_.ground()->block(b)[k].candidate);
        const auto motion = contact_->motion().find(node);
        if (motion != contact_->motion().end() && motion->second.touching) {
          touching += weight;
          slip_speed += weight * motion->second.slip_speed;
        }
      });
      p.slip += touching > 0.0 ? dt_ * slip_speed / touching : 0.0;
      if (simulation_.model().band.region == band::BandRegion::first_layer) {
        p.scaling = p.in_band ? 1.0 / (transfer_.inverse_cell * simulation_.parameters().band.thickness.at(0.0)) : 1.0;
      }
    }
  }

  void move() {
    for (Point<Dim>& p : points_) {
      for_nodes(p, Transfer::ugimp, [&](const Index& node, double weight, const Place& /*gradient*/) {
        const auto motion = contact_->motion().find(node);
        if (motion != contact_->motion().end()) {  // otherwise the node has no mass, and the particle no weight there
          p.velocity += dt_ * weight * motion->second.acceleration;
          p.step += dt_ * weight * motion->second.middle_velocity;
        }
      });
      p.displacement += p.step;
    }
    mapped_ = add_up(Transfer::ugimp, Dim, [&](const Point<Dim>& p) {
      Carried<Dim> carried;
      for (int a = 0; a < Dim; ++a) {
        carried.value.push_back(p.mass * p.velocity[a]);
      }
      return carried;
    });
  }

  void deform() {
    for (Point<Dim>& p : points_) {
      Matrix<double, Dim> gradient = Matrix<double, Dim>::Zero();
      for_nodes(p, Transfer::ugimp, [&](const Index& node, double /*weight*/, const Place& slope) {
        if (contact_->motion().count(node) == 1) {
          const Place momentum = Eigen::Map<const Place>(mapped_.at(node).data());
          gradient += dt_ * contact_->mapped_velocity(node, momentum) * slope.transpose();
        }
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

  [[nodiscard]] double friction_heat(const Index& node) const {
    const auto motion = contact_->motion().find(node);
    return motion != contact_->motion().end() ? motion->second.friction_heat : 0.0;
  }

  // Temperature rate of every node [K/s] from sums of heat flow, capacity and subgrid heat.
  [[nodiscard]] ByNode<Dim, double> rates(const Sums& flows, const Sums& stored) const {
    ByNode<Dim, double> rate;
    for (const auto& [node, sum] : stored) {
      const double heat = flows.at(node)[0] + flows.at(node)[1] + friction_heat(node) - sum[1] / dt_;
      rate[node] = sum[0] > 0.0 ? heat / sum[0] : 0.0;
    }
    return rate;
  }

  // Friction heat of nodes without linear weight [J/m3], by the weight of the particle's momentum there.
  [[nodiscard]] double unreached_heat(const Point<Dim>& p, const Sums& stored) const {
    double power = 0.0;
    for_nodes(p, Transfer::ugimp, [&](const Index& node, double weight, const Place& /*gradient*/) {
      const auto held = stored.find(node);
      if (friction_heat(node) > 0.0 && (held == stored.end() || !(held->second[0] > 0.0))) {
        power += weight * friction_heat(node) / momentum_.at(node)[mpm::MomentumLayout<Dim>::mass];
      }
    });
    return dt_ * power * p.mass * p.scaling / p.initial_volume;
  }

  [[nodiscard]] double change(const Point<Dim>& p, const ByNode<Dim, double>& rate) const {
    double sum = p.conduction_in_cell;
    for_nodes(p, Transfer::linear, [&](const Index& node, double weight, const Place& /*gradient*/) {
      sum += dt_ * weight * rate.at(node);
    });
    return sum;
  }

  // Linear average at the beginning of the step, at the particle's position, and its gradient. Pressure is that of the
  // seeping water.
  struct Seen {
    double value = 0.0;
    Place gradient = Place::Zero();
  };
  [[nodiscard]] Seen seen(const Point<Dim>& p, std::size_t component) const {
    Seen seen;
    for_nodes(p, Transfer::linear, [&](const Index& node, double weight, const Place& slope) {
      const bool pressure = component == mpm::Averages::pore_pressure;
      const auto& sums = pressure ? seeping_.at(node) : linear_.at(node);
      const double average = sums[0] > 0.0 ? sums[pressure ? 1 : component] / sums[0] : 0.0;
      seen.value += weight * average;
      seen.gradient += average * slope;
    });
    return seen;
  }

  void conduct() {
    simulation_.model().band.with_heat_content([&](const auto& content) {
      const Sums flows = add_up(Transfer::linear, 2, [&](const Point<Dim>& p) { return heat_flow(p); });
      const auto stored = [&] {
        return add_up(Transfer::linear, 2, [&](const Point<Dim>& p) {
          const double capacity = p.initial_volume / p.scaling * p.capacity;
          return Carried<Dim>{{capacity, capacity * p.conduction_in_cell}, {}};
        });
      };
      for (Point<Dim>& p : points_) {
        p.capacity = content.apparent_capacity(p.temperature, p.initial_porosity);
        const double conductivity = physics::conductivity(phases(), p.porosity, p.saturation);
        p.conduction_in_cell = (seen(p, mpm::Averages::temperature).value - p.temperature) *
                               physics::subgrid_diffusion_fraction(conductivity / p.capacity,
                                                                   transfer_.inverse_cell * p.scaling, Dim, dt_);
      }
      const auto first = rates(flows, stored());
      for (Point<Dim>& p : points_) {
        p.capacity = content.secant_capacity(p.temperature, change(p, first), p.initial_porosity);
      }
      const Sums held = stored();
      const auto second = rates(flows, held);
      for (Point<Dim>& p : points_) {
        const double taken = p.capacity * change(p, second) + unreached_heat(p, held);
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

  [[nodiscard]] Carried<Dim> heat_flow(const Point<Dim>& p) const {
    const Place by_temperature = seen(p, mpm::Averages::temperature).gradient;
    const Place by_pressure = seen(p, mpm::Averages::pore_pressure).gradient;
    const double conductivity = physics::conductivity(phases(), p.porosity, p.saturation);
    const double mobility =
        p.scaling * simulation_.model().band.hydraulic_conductivity[p.material] / phases().water_unit_weight;
    const double carried =
        p.temperature < tref ? 0.0 : p.volume * phases().water_density * phases().water_heat_capacity * mobility;
    const Place conduction = -p.volume * p.scaling * conductivity * by_temperature;
    if (simulation_.model().band.conservative_advection) {
      return {{0.0, 0.0}, {conduction - carried * (p.temperature - tref) * by_pressure}};
    }
    return {{0.0, carried * by_pressure.dot(by_temperature)}, {conduction}};
  }

  void drain() {
    const Sums flows = add_up(Transfer::linear, 3, [&](const Point<Dim>& p) { return seepage_of(p); });
    const ScalarColumns<Dim> columns(points_, 1.0 / transfer_.inverse_cell, [&](double x) {
      Vector<double, Dim - 1> place = Vector<double, Dim - 1>::Zero();
      place[0] = x;
      return simulation_.model().ground->slope_cosine(place, 0.0);
    });
    const ScalarWater<Dim> water(simulation_.model(), columns);
    for (Point<Dim>& p : points_) {
      p.flow_depth = columns.flow_depth(p);
      double seeped = 0.0;
      if (p.old_temperature >= tref) {
        seeped = by_subgrid_diffusion(p, seen(p, mpm::Averages::pore_pressure).value);
        for_nodes(p, Transfer::linear, [&](const Index& node, double weight, const Place& /*slope*/) {
          const auto& sum = flows.at(node);
          seeped += sum[1] > 0.0 ? weight * (dt_ * sum[0] - sum[2]) / sum[1] : 0.0;
        });
      }
      water.update(p, seeped, 0.5 / transfer_.inverse_cell);
    }
  }

  // Seepage to nodes, pore space, and the contribution of subgrid diffusion to it.
  [[nodiscard]] Carried<Dim> seepage_of(const Point<Dim>& p) const {
    const auto& band = simulation_.model().band;
    const Seen around = seen(p, mpm::Averages::pore_pressure);
    const bool flowing = p.old_temperature >= tref;
    const double space =
        flowing || band.frozen_rows != band::FrozenRows::sealed
            ? p.volume / p.scaling * physics::storing_porosity(phases(), p.porosity, band.skeleton_compressibility)
            : 0.0;
    const double flow = p.volume * p.scaling * band.hydraulic_conductivity[p.material] / phases().water_unit_weight *
                        phases().water_bulk_modulus;
    return {{0.0, space, flowing ? space * by_subgrid_diffusion(p, around.value) : 0.0},
            {flowing ? Place(-flow * around.gradient) : Place(Place::Zero())}};
  }

  // Volume and pressure of seeping water for the nodes; of all material if frozen rows drain.
  [[nodiscard]] Carried<Dim> seeping_water(const Point<Dim>& p) const {
    const band::FrozenRows rows = simulation_.model().band.frozen_rows;
    const bool counts = rows == band::FrozenRows::draining || p.temperature >= tref;
    const double volume = counts || rows == band::FrozenRows::vented ? p.volume : 0.0;
    return {{volume, counts ? p.volume * p.pore_pressure : 0.0}, {}};
  }

  // Pressure change due to subgrid diffusion.
  [[nodiscard]] double by_subgrid_diffusion(const Point<Dim>& p, double level) const {
    const double diffusivity =
        p.scaling * p.scaling *
        physics::hydraulic_diffusivity(
            phases(),
            physics::storing_porosity(phases(), p.porosity, simulation_.model().band.skeleton_compressibility), 1.0,
            simulation_.model().band.hydraulic_conductivity[p.material]);
    return (level - p.pore_pressure) *
           physics::subgrid_diffusion_fraction(diffusivity, transfer_.inverse_cell, Dim, dt_);
  }

  std::vector<Point<Dim>> points_;
  const sim::Simulation<Dim>& simulation_;
  double dt_;
  Transfer transfer_;
  Sums momentum_, linear_, seeping_, near_ground_by_mass_, near_ground_by_linear_, mapped_;
  ByNode<Dim, std::pair<std::size_t, std::size_t>> place_;
  std::optional<ScalarContact<Dim>> contact_;
};

}  // namespace thawslide::testing_support
