// Freezing of a half space from its face: the sharp front of Neumann (Carslaw and Jaeger 1959, ch. 11) and the three
// zones of Lunardini (1985), whose middle zone freezes gradually between Tm and Tf.
//   zones: 1 frozen, 2 freezing, 3 thawed;  a1 = k1/C1, a3 = k3/C3, a4 = k2/(C2 + Lv/(Tf - Tm)), r = sqrt(a1/a4)
//   X1 = 2 psi sqrt(a1 t), X = 2 gam sqrt(a4 t)   interfaces of zones 1 and 2, and of 2 and 3
//   (Tm-Ts)/(Tf-Tm) exp(-psi^2 (1-a1/a4)) = (k2/k1) r erf(psi)/[erf(gam) - erf(psi r)]
//   (Tf-Tm)/(T0-Tf) (k2/k3) sqrt(a3/a4) exp(-gam^2 (1-a4/a3)) = [erf(gam) - erf(psi r)]/erfc(gam sqrt(a4/a3))
// McKenzie et al. (2007) give the first condition with a wrong sign.
#pragma once

#include <cmath>

namespace thawslide::physics::exact {

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

}  // namespace thawslide::physics::exact
