// Solutions for conduction and freezing, in closed form and by shooting.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace thawslide::physics::exact {

// Heat conduction in bodies at rest: closed-form solutions (Carslaw and Jaeger 1959, ch. 2 and 3).
//   half space        T = T0 + (Ts - T0) erfc(x/sqrt(4 a t))                      a = k/C, x >= 0
//   two half spaces   T = Ti + (Tj - Ti) erf(|x|/sqrt(4 a_j t))                   side j of the interface at x = 0
//                     Ti = (b1 T1 + b2 T2)/(b1 + b2),  b = sqrt(k C)

// Temperature [C] at depth x [m] and time t > 0 [s] of a half space initially at `initial`, with its face at `face` [C]
// since t = 0; diffusivity [m2/s].
inline double half_space_temperature(double x, double t, double initial, double face, double diffusivity) {
  return initial + (face - initial) * std::erfc(x / std::sqrt(4.0 * diffusivity * t));
}

struct HalfSpace {
  double conductivity;  // k [W/m/K]
  double capacity;      // C [J/m3/K]
  double temperature;   // before contact [C]
};

// Temperature [C] of the interface of two half spaces in contact, constant in time.
inline double interface_temperature(const HalfSpace& left, const HalfSpace& right) {
  const double b_left = std::sqrt(left.conductivity * left.capacity);
  const double b_right = std::sqrt(right.conductivity * right.capacity);
  return (b_left * left.temperature + b_right * right.temperature) / (b_left + b_right);
}

// Temperature [C] at x [m] and time t > 0 [s] after contact; the interface is at x = 0, and `left` at x < 0.
inline double two_half_spaces_temperature(double x, double t, const HalfSpace& left, const HalfSpace& right) {
  const HalfSpace& side = x < 0.0 ? left : right;
  const double between = interface_temperature(left, right);
  const double diffusivity = side.conductivity / side.capacity;
  return between + (side.temperature - between) * std::erf(std::abs(x) / std::sqrt(4.0 * diffusivity * t));
}

// Freezing of a half space from its face: the sharp front of Neumann (Carslaw and Jaeger 1959, ch. 11) and the three
// zones of Lunardini (1985), whose middle zone freezes gradually between Tm and Tf.
//   zones: 1 frozen, 2 freezing, 3 thawed;  a1 = k1/C1, a3 = k3/C3, a4 = k2/(C2 + Lv/(Tf - Tm)), r = sqrt(a1/a4)
//   X1 = 2 psi sqrt(a1 t), X = 2 gam sqrt(a4 t)   interfaces of zones 1 and 2, and of 2 and 3
//   (Tm-Ts)/(Tf-Tm) exp(-psi^2 (1-a1/a4)) = (k2/k1) r erf(psi)/[erf(gam) - erf(psi r)]
//   (Tf-Tm)/(T0-Tf) (k2/k3) sqrt(a3/a4) exp(-gam^2 (1-a4/a3)) = [erf(gam) - erf(psi r)]/erfc(gam sqrt(a4/a3))
// McKenzie et al. (2007) give the first condition with a wrong sign.

// Half space at `initial` T0 whose face is at `face` Ts since t = 0. It freezes between `freezing` Tf and `frozen` Tm
// [C] and releases latent_heat Lv [J/m3]. Arrays: frozen, freezing and thawed zone.
struct FreezingProblem {
  double initial, face, freezing, frozen;
  double conductivity[3];  // k [W/m/K]
  double capacity[3];      // C without latent heat [J/m3/K]
  double latent_heat;
};

// Root in (low, high) of a function that is positive at low and negative at high.
template <class Function>
double falling_root(double low, double high, const Function& function) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (function(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

class ThreeZones {
 public:
  explicit ThreeZones(const FreezingProblem& problem) : p_(problem) {
    const double mushy = p_.capacity[1] + p_.latent_heat / (p_.freezing - p_.frozen);
    a1_ = p_.conductivity[0] / p_.capacity[0];
    a3_ = p_.conductivity[2] / p_.capacity[2];
    a4_ = p_.conductivity[1] / mushy;
    r_ = std::sqrt(a1_ / a4_);
    psi_ = falling_root(0.0, 5.0, [this](double psi) { return thawed_condition(psi); });
    gam_ = inverse_erf(erf_gam(psi_));
  }

  [[nodiscard]] double psi() const { return psi_; }
  [[nodiscard]] double gam() const { return gam_; }

  // Temperature [C] at depth x >= 0 [m] and time t > 0 [s].
  [[nodiscard]] double temperature(double x, double t) const {
    if (x < 2.0 * psi_ * std::sqrt(a1_ * t)) {
      return p_.face + (p_.frozen - p_.face) * std::erf(x / std::sqrt(4.0 * a1_ * t)) / std::erf(psi_);
    }
    if (x < 2.0 * gam_ * std::sqrt(a4_ * t)) {
      const double erf_gam = std::erf(gam_);
      return p_.freezing + (p_.freezing - p_.frozen) * (std::erf(x / std::sqrt(4.0 * a4_ * t)) - erf_gam) /
                               (erf_gam - std::erf(psi_ * r_));
    }
    return p_.initial - (p_.initial - p_.freezing) * std::erfc(x / std::sqrt(4.0 * a3_ * t)) /
                            std::erfc(gam_ * std::sqrt(a4_ / a3_));
  }

 private:
  // erf(gam) from the first condition.
  [[nodiscard]] double erf_gam(double psi) const {
    return std::erf(psi * r_) + p_.conductivity[1] / p_.conductivity[0] * r_ * std::erf(psi) *
                                    (p_.freezing - p_.frozen) / (p_.frozen - p_.face) *
                                    std::exp(psi * psi * (1.0 - a1_ / a4_));
  }
  // Left side minus right side of the second condition.
  [[nodiscard]] double thawed_condition(double psi) const {
    const double erf_of_gam = erf_gam(psi);
    if (erf_of_gam >= 1.0) {
      return -1.0;
    }
    const double gam = inverse_erf(erf_of_gam);
    return (p_.freezing - p_.frozen) / (p_.initial - p_.freezing) * p_.conductivity[1] / p_.conductivity[2] *
               std::sqrt(a3_ / a4_) * std::exp(-gam * gam * (1.0 - a4_ / a3_)) -
           (erf_of_gam - std::erf(psi * r_)) / std::erfc(gam * std::sqrt(a4_ / a3_));
  }
  [[nodiscard]] static double inverse_erf(double value) {
    return falling_root(0.0, 6.0, [value](double x) { return value - std::erf(x); });
  }

  FreezingProblem p_;
  double a1_, a3_, a4_, r_, psi_, gam_;
};

// Neumann's two zones: all latent heat is released at `freezing`; `frozen` and the values of the middle zone are not
// used.
class SharpFront {
 public:
  explicit SharpFront(const FreezingProblem& problem)
      : p_(problem),
        a1_(problem.conductivity[0] / problem.capacity[0]),
        a3_(problem.conductivity[2] / problem.capacity[2]) {
    psi_ = falling_root(1e-12, 5.0, [this](double psi) { return front_condition(psi); });
  }

  // The front is at 2 psi sqrt(a1 t).
  [[nodiscard]] double psi() const { return psi_; }

  // Temperature [C] at depth x >= 0 [m] and time t > 0 [s].
  [[nodiscard]] double temperature(double x, double t) const {
    if (x < 2.0 * psi_ * std::sqrt(a1_ * t)) {
      return p_.face + (p_.freezing - p_.face) * std::erf(x / std::sqrt(4.0 * a1_ * t)) / std::erf(psi_);
    }
    return p_.initial - (p_.initial - p_.freezing) * std::erfc(x / std::sqrt(4.0 * a3_ * t)) /
                            std::erfc(psi_ * std::sqrt(a1_ / a3_));
  }

 private:
  // Heat flow from the front into the frozen side, minus that from the thawed side, minus the latent heat released.
  [[nodiscard]] double front_condition(double psi) const {
    const double root_pi = std::sqrt(std::acos(-1.0));
    const double out =
        p_.conductivity[0] * (p_.freezing - p_.face) * std::exp(-psi * psi) / (std::sqrt(a1_) * std::erf(psi));
    const double in = p_.conductivity[2] * (p_.initial - p_.freezing) * std::exp(-psi * psi * a1_ / a3_) /
                      (std::sqrt(a3_) * std::erfc(psi * std::sqrt(a1_ / a3_)));
    return out - in - p_.latent_heat * psi * std::sqrt(a1_) * root_pi;
  }

  FreezingProblem p_;
  double a1_, a3_, psi_ = 0.0;
};

// Freezing of a half space with saturation-dependent conductivity and capacity. There is no closed form, but a
// similarity solution in eta = x/sqrt(t), -(eta/2) C_eff(T) T' = (k(T) T')', found by shooting from the cooled face.

class FreezingSimilarity {
 public:
  // conductivity(T) [W/m/K], capacity(T) with latent heat [J/m3/K]; the face is at `face`, the far end at `initial` [C]
  // and reached well before eta = `far` [m/s^(1/2)].
  template <class Conductivity, class Capacity>
  FreezingSimilarity(double face, double initial, double far, const Conductivity& conductivity,
                     const Capacity& capacity)
      : step_(far / steps) {
    double low = 0.0, high = 1e5;  // conductivity times T' at the face
    for (int k = 0; k < 80; ++k) {
      const double middle = 0.5 * (low + high);
      const double end = shoot(face, initial, middle, conductivity, capacity);
      (end < initial ? low : high) = middle;
    }
    shoot(face, initial, low, conductivity, capacity);
  }

  // Temperature [C] at depth x [m] and time t [s].
  [[nodiscard]] double temperature(double x, double t) const {
    const double place = x / std::sqrt(t) / step_;
    const auto k = std::min(static_cast<std::size_t>(place), temperature_.size() - 2);
    const double fraction = std::min(1.0, place - static_cast<double>(k));
    return temperature_[k] + fraction * (temperature_[k + 1] - temperature_[k]);
  }

 private:
  // Integrates from the face (Runge and Kutta's fourth-order rule); returns the far temperature, capped above initial.
  template <class Conductivity, class Capacity>
  double shoot(double face, double initial, double flow_at_face, const Conductivity& conductivity,
               const Capacity& capacity) {
    temperature_.assign(1, face);
    double temperature = face, flow = flow_at_face;
    for (int k = 0; k < steps; ++k) {
      const double eta = k * step_;
      const auto slope = [&](double at, double t, double q) {
        const double gradient = q / conductivity(t);
        return std::pair(gradient, -0.5 * at * capacity(t) * gradient);
      };
      const auto [a1, b1] = slope(eta, temperature, flow);
      const auto [a2, b2] = slope(eta + 0.5 * step_, temperature + 0.5 * step_ * a1, flow + 0.5 * step_ * b1);
      const auto [a3, b3] = slope(eta + 0.5 * step_, temperature + 0.5 * step_ * a2, flow + 0.5 * step_ * b2);
      const auto [a4, b4] = slope(eta + step_, temperature + step_ * a3, flow + step_ * b3);
      temperature += step_ / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      flow += step_ / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
      temperature_.push_back(temperature);
      if (temperature > initial + 1.0) {
        return temperature;
      }
    }
    return temperature;
  }

  static constexpr int steps = 20000;
  double step_;
  std::vector<double> temperature_;  // at eta = 0, step, 2 step, ...
};

}  // namespace thawslide::physics::exact
