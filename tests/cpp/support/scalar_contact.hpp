// Reference for the motion of nodes on the ground, node by node: Eqs. 15-17 and 25 with the reference sums. The ground
// at nodes, which is computed once, is taken from the simulation. Without walls, frames and damping.
#pragma once

#include <algorithm>

#include "physics/contact.hpp"
#include "scalar_points.hpp"
#include "terrain/contact_node.hpp"

namespace thawslide::testing_support {

template <int Dim>
struct NodeMotion {
  Vector<double, Dim> acceleration, middle_velocity;
  bool touching = false;
  double slip_speed = 0, friction_heat = 0;
};

// Sums over particles for contact.
template <int Dim>
struct ContactSums {
  using Sums = typename ScalarTransfer<Dim>::Sums;
  const Sums &momentum, &linear, &near_ground_by_mass, &near_ground_by_linear;
};

template <int Dim>
class ScalarContact {
 public:
  using Index = NodeIndex<Dim>;
  using Place = Vector<double, Dim>;
  using Ground = ByNode<Dim, terrain::GroundAtNode<Dim>>;

  // ground: at all nodes around the particles.
  ScalarContact(const terrain::ContactModel<Dim>& model, const ScalarTransfer<Dim>& transfer,
                const std::vector<Point<Dim>>& points, const ContactSums<Dim>& sums, Ground ground, double dt)
      : model_(model), sums_(sums), ground_(std::move(ground)), dt_(dt), cell_(1.0 / transfer.inverse_cell) {
    find_clearance(transfer, points);
    for (const auto& [node, known] : ground_) {
      if (known.candidate) {
        covered_[node] = known.area * covered_fraction(node, known.normal);
        const double into_ground = mass(node) > 0.0 ? trial(node).dot(known.normal) : 0.0;
        load_[node] = mass(node) > 0.0 ? known.bend * approach(node, into_ground) : 0.0;
      }
    }
    for (const auto& [node, sum] : sums_.momentum) {
      if (mass(node) > 0.0) {
        motion_[node] = move(node);
      }
    }
  }

  [[nodiscard]] const ByNode<Dim, NodeMotion<Dim>>& motion() const { return motion_; }
  // Minimum gap between candidate nodes' planes and the particles within their support [m]; nodes without particles are
  // omitted.
  [[nodiscard]] const ByNode<Dim, double>& clearance() const { return clearance_; }

  // Velocity of a node from the mapped-back momentum of particles.
  [[nodiscard]] Place mapped_velocity(const Index& node, Place momentum) const {
    if (motion_.at(node).touching) {
      const Place& normal = ground_.at(node).normal;
      momentum -= approach(node, momentum.dot(normal)) * normal;
    }
    return momentum / mass(node);
  }

 private:
  using Momentum = mpm::MomentumLayout<Dim>;
  using NearGround = mpm::NearGround;
  static constexpr std::size_t solid_fraction_by_linear =
      NearGround::solid_fraction_by_linear - NearGround::saturation_by_linear;  // in the reference sums
  static constexpr double smallest_fraction = 1e-6;  // fraction of a cell's face: keeps N finite without covered ground

  static Place vector_of(const std::vector<double>& sum, std::size_t first) {
    return Eigen::Map<const Place>(sum.data() + first);
  }
  [[nodiscard]] double mass(const Index& node) const {
    const auto sum = sums_.momentum.find(node);
    return sum != sums_.momentum.end() ? sum->second[Momentum::mass] : 0.0;
  }
  [[nodiscard]] Place old_momentum(const Index& node) const {
    return vector_of(sums_.momentum.at(node), Momentum::momentum);
  }
  [[nodiscard]] Place trial(const Index& node) const {
    return old_momentum(node) + dt_ * vector_of(sums_.momentum.at(node), Momentum::force);
  }

  void find_clearance(const ScalarTransfer<Dim>& transfer, const std::vector<Point<Dim>>& points) {
    for (const Point<Dim>& p : points) {
      transfer.for_nodes(p, transfer.ugimp, [&](const Index& node, double weight, const Place& /*slope*/) {
        const auto& known = ground_.at(node);
        if (weight > round_off && known.candidate) {
          double& clearance = clearance_.emplace(node, HUGE_VAL).first->second;
          clearance = std::min(clearance, known.plane - known.normal.dot(p.position) - p.contact_offset);
        }
      });
    }
  }

  // Momentum into the ground in excess of that which closes the clearance.
  [[nodiscard]] double approach(const Index& node, double inward) const {
    const auto clearance = clearance_.find(node);
    const double left = clearance != clearance_.end() ? std::max(0.0, clearance->second) : HUGE_VAL;
    return std::max(0.0, model_.distance_check ? inward - mass(node) * left / dt_ : inward);
  }

  [[nodiscard]] double filled_fraction(const Index& node) const {
    const auto known = ground_.find(node);
    const auto sum = sums_.momentum.find(node);
    const bool near_ground = known != ground_.end() && known->second.candidate;
    const double space = near_ground ? known->second.space : std::pow(cell_, Dim);
    return sum != sums_.momentum.end() ? std::min(1.0, sum->second[Momentum::volume] / space) : 0.0;
  }
  // Maximum filled fraction of the node and the two nodes farther from the ground.
  [[nodiscard]] double covered_fraction(const Index& node, const Place& normal) const {
    const int axis = terrain::main_axis<Dim>(normal);
    double fraction = 0.0;
    Index at = node;
    for (int step = 0; step <= 2; ++step) {
      fraction = std::max(fraction, filled_fraction(at));
      at[static_cast<std::size_t>(axis)] += normal[axis] > 0.0 ? -1 : 1;
    }
    return fraction;
  }

  // N [Pa]: load over covered ground, both smoothed along it.
  [[nodiscard]] double pressure(const Index& node) const {
    const int across = terrain::main_axis<Dim>(ground_.at(node).normal);
    double load = 0.0, covered = 0.0;
    for (int n = 0; n < mpm::power(3, Dim); ++n) {
      Index adjacent = node;
      double weight = 1.0;
      int rest = n;
      for (int a = 0; a < Dim; ++a) {
        const int shift = rest % 3 - 1;
        rest /= 3;
        adjacent[static_cast<std::size_t>(a)] += shift;
        weight *= a == across ? 1.0 : shift == 0 ? 0.5 : 0.25;
      }
      if (covered_.count(adjacent) == 1) {
        load += weight * load_.at(adjacent);
        covered += weight * covered_.at(adjacent);
      }
    }
    return load / (dt_ * std::max(covered, smallest_fraction * std::pow(cell_, Dim - 1)));
  }

  // Average at a node with the linear shape functions, or by mass if its linear weight is zero.
  [[nodiscard]] double average(const Index& node, const typename ContactSums<Dim>::Sums& sums, std::size_t by_linear,
                               std::size_t by_mass) const {
    const auto linear = sums_.linear.find(node);
    const double volume = linear != sums_.linear.end() ? linear->second[mpm::Averages::volume] : 0.0;
    return volume > 0.0 ? sums.at(node)[by_linear] / volume : sums_.near_ground_by_mass.at(node)[by_mass] / mass(node);
  }

  [[nodiscard]] double strength(const Index& node, double normal_pressure) const {
    const auto& law = model_.law;
    const double pore = average(node, sums_.linear, mpm::Averages::pore_pressure, NearGround::pore_pressure);
    const double solid =
        average(node, sums_.near_ground_by_linear, solid_fraction_by_linear, NearGround::solid_fraction);
    const physics::basal::ContactNode state{.solid_fraction = solid};
    const double friction = std::get<physics::basal::LubricatedFriction>(law.grounds[0].friction).coefficient(state);
    const double cohesion = std::get<physics::basal::ConstantCohesion>(law.grounds[0].cohesion).initial;
    return physics::sliding_strength(friction, normal_pressure, pore, cohesion, law.clamp, law.cap_pressure);
  }

  [[nodiscard]] NodeMotion<Dim> move(const Index& node) const {
    NodeMotion<Dim> motion;
    const Place old = old_momentum(node);
    Place momentum = trial(node), along = Place::Zero();
    double friction_impulse = 0.0;
    bool slides = false;  // without friction if pore pressure carries the full load
    const auto load = load_.find(node);
    if (load != load_.end() && load->second > 0.0) {
      const Place& normal = ground_.at(node).normal;
      const double on_ground = pressure(node), area = load->second / (on_ground * dt_);
      const Place tangential = momentum - momentum.dot(normal) * normal;
      const auto impulse = physics::contact_impulse(load->second / ground_.at(node).bend, tangential.norm(), area, dt_,
                                                    strength(node, on_ground));
      along = tangential.normalized();
      momentum -= impulse.normal * normal + impulse.tangential * along;
      motion.touching = true;
      slides = impulse.slides;
      friction_impulse = impulse.tangential;
    }
    motion.acceleration = (momentum - old) / (mass(node) * dt_);
    motion.middle_velocity = 0.5 * (old + momentum) / mass(node);
    if (slides) {
      motion.slip_speed = std::max(0.0, motion.middle_velocity.dot(along));
      motion.friction_heat = model_.law.heat_fraction * friction_impulse * motion.slip_speed / dt_;
    }
    return motion;
  }

  const terrain::ContactModel<Dim>& model_;
  ContactSums<Dim> sums_;
  Ground ground_;
  double dt_, cell_;
  ByNode<Dim, double> clearance_, load_, covered_;
  ByNode<Dim, NodeMotion<Dim>> motion_;
};

}  // namespace thawslide::testing_support
