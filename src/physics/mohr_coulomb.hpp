// Linear elasticity with Mohr-Coulomb plasticity and an optional tension cut-off. Tension positive, s1 >= s2 >= s3.
//   F = (s1 - s3)/2 + (s1 + s3)/2 sin(phi) - c cos(phi) = 0           (Eq. 11, whose c and one sign the paper's print
//   lost) in the form used here  k s1 - s3 = 2 c sqrt(k),  k = (1 + sin phi)/(1 - sin phi);  cut-off  s1 = sigma_t
//   flow: m s1 - s3 with m from the dilation angle (the paper gives none; default 0); cut-off: associated
//   softening: c = c_f + (c_0 - c_f) exp(-eps), eps the sum of sqrt(2/3 de_p:de_p); c is held within a step
// Return to faces, edges and apex in principal space: among the sets of at most three active planes, the one whose
// multipliers are not negative and whose stress is admissible (Koiter's flow rule; Clausen, Damkilde and Andersen 2006
// and de Souza Neto, Peric and Owen 2008, ch. 8, name the same regions). Where no set answers, the apex does: without
// dilation the flow cannot reach it, and, as in Clausen et al., the stress is put there.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "base/lanes.hpp"
#include "base/portability.hpp"
#include "physics/elasticity.hpp"
#include "physics/principal.hpp"

namespace thawslide::physics {

template <class Real>
struct ReturnResult {
  SymmetricTensor<Real> stress;              // [Pa]
  Real equivalent_plastic_strain_increment;  // sqrt(2/3 de_p:de_p)
  Real plastic_work_density;                 // stress : de_p [J/m3]
  Real opening;                              // volumetric plastic strain at the apex or the cut-off: a gap torn open
  bool yielded;
};

template <class Real>
struct LinearElastic {
  static constexpr bool yields = false;

  [[nodiscard]] THAWSLIDE_HD ReturnResult<Real> update(const SymmetricTensor<Real>& trial,
                                                       Real /*plastic_strain*/) const {
    return {trial, Real(0), Real(0), Real(0), false};
  }
};

template <class Real>
class MohrCoulomb {  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming): clang copying its arrays
 public:
  // Angles in degrees, cohesions c_0 and c_f [Pa], tension cut-off sigma_t [Pa] (infinity: none).
  static MohrCoulomb make(const Elastic<Real>& elastic, Real friction_angle, Real dilation_angle, Real cohesion,
                          Real residual_cohesion, Real tension_cutoff) {
    MohrCoulomb law;
    law.ratio_ = pressure_ratio(friction_angle);
    law.root_of_ratio_ = std::sqrt(law.ratio_);
    const Real flow_ratio = pressure_ratio(dilation_angle);
    law.cohesion_ = cohesion;
    law.residual_cohesion_ = residual_cohesion;
    law.tension_cutoff_ = tension_cutoff;
    law.elastic_ = elastic;
    for (int j = 0; j < planes; ++j) {
      const Vector<Real, 3> flow = normal(j, flow_ratio);
      law.relaxation_[j] =
          Real(2) * elastic.shear_modulus * flow + Vector<Real, 3>::Constant(elastic.lame_lambda * flow.sum());
    }
    for (int i = 0; i < planes; ++i) {
      law.normal_[i] = normal(i, law.ratio_);
      for (int j = 0; j < planes; ++j) {
        law.coupling_(i, j) = law.normal_[i].dot(law.relaxation_[j]);
      }
    }
    return law;
  }

  // c [Pa] after an equivalent plastic strain.
  [[nodiscard]] THAWSLIDE_HD Real cohesion(Real plastic_strain) const {
    return residual_cohesion_ == cohesion_ || plastic_strain == Real(0)
               ? cohesion_
               : residual_cohesion_ + (cohesion_ - residual_cohesion_) * std::exp(-plastic_strain);
  }

  // Whether an elastic trial stress [Pa] may be beyond the yield surface, whatever its Lode angle and the cohesion
  // left.
  static constexpr bool yields = true;
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto may_yield(const SymmetricTensor<Value>& trial) const {
    return !surely_elastic(trial, Real(2) * std::min(cohesion_, residual_cohesion_) * root_of_ratio_);
  }

  // The admissible stress that follows from an elastic trial [Pa].
  [[nodiscard]] THAWSLIDE_HD ReturnResult<Real> update(const SymmetricTensor<Real>& trial, Real plastic_strain) const {
    const Real shear_limit = Real(2) * cohesion(plastic_strain) * root_of_ratio_;
    if (surely_elastic(trial, shear_limit)) {
      return {trial, Real(0), Real(0), Real(0), false};
    }
    const bool plane = trial[4] == Real(0) && trial[5] == Real(0);
    Principal<Real> state;
    if (plane) {
      state.values = plane_principal_values(trial);  // the axes only if it yields
    } else {
      state = principal(trial);
    }
    const Vector<Real, 3> trial_values = state.values;
    const Real tolerance = round_off * (ratio_ * trial_values.cwiseAbs().maxCoeff() + shear_limit);
    // Of ordered values, (s1, s3) is the first plane to be reached, and s1 the first to pass the cut-off.
    if (ratio_ * trial_values[0] - trial_values[2] - shear_limit <= tolerance &&
        trial_values[0] - tension_cutoff_ <= tolerance) {
      return {trial, Real(0), Real(0), Real(0), false};
    }
    Vector<Real, planes> limits;
    limits << Vector<Real, 3>::Constant(shear_limit), Vector<Real, 3>::Constant(tension_cutoff_);
    if (plane) {
      state = principal(trial);
    }
    bool torn = false;
    state.values = returned(trial_values, limits, tolerance, torn);
    const Vector<Real, 3> plastic = elastic_strain(trial_values - state.values);
    return {from_principal(state), std::sqrt(Real(2) / Real(3) * plastic.squaredNorm()), state.values.dot(plastic),
            torn ? plastic.sum() : Real(0), true};
  }

 private:
  // Planes in the space of ordered principal stresses: Mohr-Coulomb of (s1, s3), (s1, s2), (s2, s3); cut-off of s1, s2,
  // s3.
  static constexpr int planes = 6;
  static constexpr Real round_off = by_precision<Real>(1e-12, 1e-6);

  struct ActiveSet {
    int count;
    int plane[3];
  };

  // Whether the stress is within the surface whatever its Lode angle: no principal stress lies further from the mean m
  // than r = 2 sqrt(J2/3). Spares most particles their principal stresses.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto surely_elastic(const SymmetricTensor<Value>& s,
                                                                         Real shear_limit) const {
    using std::sqrt;
    const Value mean = (s[0] + s[1] + s[2]) / Value(3);
    const Value a = s[0] - mean, b = s[1] - mean, c = s[2] - mean;
    const Value second_invariant = Real(0.5) * (a * a + b * b + c * c) + s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    const Value reach = Real(2) * sqrt(second_invariant / Real(3));
    return (ratio_ * (mean + reach) - (mean - reach) <= shear_limit) & (mean + reach <= tension_cutoff_);
  }

  static Real pressure_ratio(Real angle) {
    const Real sine = std::sin(angle * pi<Real> / Real(180));
    return (Real(1) + sine) / (Real(1) - sine);
  }

  static Vector<Real, 3> normal(int plane, Real ratio) {
    switch (plane) {
      case 0:
        return {ratio, Real(0), Real(-1)};
      case 1:
        return {ratio, Real(-1), Real(0)};
      case 2:
        return {Real(0), ratio, Real(-1)};
      default:
        return Vector<Real, 3>::Unit(plane - 3);
    }
  }

  [[nodiscard]] THAWSLIDE_HD bool admissible(const Vector<Real, 3>& values, const Vector<Real, planes>& limits,
                                             Real tolerance) const {
    for (int i = 0; i < planes; ++i) {
      if (normal_[i].dot(values) - limits[i] > tolerance) {
        return false;
      }
    }
    return true;
  }

  // Principal stresses on the yield surface; torn: at the apex or on the cut-off.
  [[nodiscard]] THAWSLIDE_HD Vector<Real, 3> returned(const Vector<Real, 3>& trial, const Vector<Real, planes>& limits,
                                                      Real tolerance, bool& torn) const {
    // Face, cut-off face, edges, corners: from the likely to the rare.
    constexpr ActiveSet sets[] = {{1, {0, 0, 0}}, {1, {3, 0, 0}}, {2, {0, 1, 0}}, {2, {0, 2, 0}},
                                  {2, {0, 3, 0}}, {2, {3, 4, 0}}, {3, {3, 4, 5}}, {3, {0, 1, 3}},
                                  {3, {0, 3, 4}}, {3, {0, 2, 3}}, {3, {2, 3, 4}}, {3, {0, 2, 4}}};
    const int with_cutoff = std::isfinite(tension_cutoff_) ? planes : 3;
    for (const ActiveSet& set : sets) {
      Vector<Real, 3> values = trial;
      if (set.plane[set.count - 1] < with_cutoff && relax(set, limits, values) &&
          admissible(values, limits, tolerance)) {
        torn = set.plane[set.count - 1] >= 3 || set.plane[0] >= 3;
        return values;
      }
    }
    torn = true;
    // k s - s = limit on the hydrostatic axis.
    const Real apex = ratio_ > Real(1) ? limits[0] / (ratio_ - Real(1)) : trial.mean();
    return Vector<Real, 3>::Constant(apex < tension_cutoff_ ? apex : tension_cutoff_);
  }

  // Takes the plastic strain of the active planes off the trial stress; false if a multiplier is negative.
  [[nodiscard]] THAWSLIDE_HD bool relax(const ActiveSet& set, const Vector<Real, planes>& limits,
                                        Vector<Real, 3>& values) const {
    Matrix<Real, 3> system = Matrix<Real, 3>::Identity();
    Vector<Real, 3> excess = Vector<Real, 3>::Zero();
    for (int a = 0; a < 3 && a < set.count; ++a) {
      excess[a] = normal_[set.plane[a]].dot(values) - limits[set.plane[a]];
      for (int b = 0; b < 3 && b < set.count; ++b) {
        system(a, b) = coupling_(set.plane[a], set.plane[b]);
      }
    }
    const Vector<Real, 3> multipliers = system.inverse() * excess;
    for (int a = 0; a < 3 && a < set.count; ++a) {
      if (!(multipliers[a] >= Real(0))) {
        return false;
      }
      values -= multipliers[a] * relaxation_[set.plane[a]];
    }
    return true;
  }

  // The elastic strain of a principal stress.
  [[nodiscard]] THAWSLIDE_HD Vector<Real, 3> elastic_strain(const Vector<Real, 3>& stress) const {
    const Real two_shear = Real(2) * elastic_.shear_modulus;
    const Real share = elastic_.lame_lambda / (two_shear + Real(3) * elastic_.lame_lambda);
    return (stress - Vector<Real, 3>::Constant(share * stress.sum())) / two_shear;
  }

  Real ratio_ = 1;          // k
  Real root_of_ratio_ = 1;  // of k
  Real cohesion_ = 0, residual_cohesion_ = 0, tension_cutoff_ = 0;
  Elastic<Real> elastic_;
  Vector<Real, 3> normal_[planes];
  Vector<Real, 3> relaxation_[planes];  // elastic stress of a plane's flow [Pa per unit multiplier]
  Matrix<Real, planes> coupling_;       // normal_[i] . relaxation_[j]
};

// Chosen once per run of particles of one material, never per particle.
template <class Real>
using ConstitutiveLaw = std::variant<LinearElastic<Real>, MohrCoulomb<Real>>;

}  // namespace thawslide::physics
