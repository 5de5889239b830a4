// Linear elasticity with Mohr-Coulomb plasticity and an optional tension cut-off. Tension positive, s1 >= s2 >= s3.
//   F = (s1 - s3)/2 + (s1 + s3)/2 sin(phi) - c cos(phi) = 0     (Eq. 11, published without c and one sign), used as
//   k s1 - s3 = 2 c sqrt(k),  k = (1 + sin phi)/(1 - sin phi);  cut-off  s1 = sigma_t
//   flow: m s1 - s3 with m from the dilation angle (not given in the paper; default 0); cut-off: associated
//   softening, with w = exp(-eps/eps_c), eps the sum of sqrt(2/3 de_p:de_p); c and phi are constant within a step
//     c = c_f + (c_0 - c_f) w                                      (as in the paper, where eps_c is 1)
//     sin phi = sin phi_f + (sin phi_0 - sin phi_f) w              (not in the paper)
//     eps_c of a slip: physics/softening.hpp
// Return to faces, edges and apex in principal space: the set of at most three active planes with non-negative
// multipliers and an admissible stress (Koiter's flow rule; regions as in Clausen, Damkilde and Andersen 2006 and de
// Souza Neto, Peric and Owen 2008, ch. 8). If none exists, the apex (as in Clausen et al.), which the flow cannot reach
// without dilation.
#pragma once

#include <cmath>
#include <variant>

#include "base/portability.hpp"
#include "base/select.hpp"
#include "physics/elasticity.hpp"
#include "physics/principal.hpp"

namespace thawslide::physics {

// Angles in degrees.
struct Strength {
  double friction_angle, dilation_angle;
  double cohesion, residual_cohesion;               // c_0, c_f [Pa]
  double tension_cutoff;                            // sigma_t [Pa]; infinity: none
  double softening_strain = 1;                      // eps_c
  double residual_friction_angle = friction_angle;  // phi_f, at least the dilation angle
};

// friction_falls: the friction angle softens too. Otherwise, quantities that depend only on it are precomputed.
template <bool friction_falls = false>
class MohrCoulomb {  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming): clang copying its arrays
 public:
  static MohrCoulomb make(const Elastic& elastic, const Strength& strength) {
    MohrCoulomb law;
    law.sine_ = sine_of(strength.friction_angle);
    law.residual_sine_ = sine_of(strength.residual_friction_angle);
    law.ratio_ = pressure_ratio(law.sine_);
    law.root_of_ratio_ = std::sqrt(law.ratio_);
    const double flow_ratio = pressure_ratio(sine_of(strength.dilation_angle));
    law.cohesion_ = strength.cohesion;
    law.residual_cohesion_ = strength.residual_cohesion;
    law.softening_rate_ = 1.0 / strength.softening_strain;
    law.tension_cutoff_ = strength.tension_cutoff;
    law.elastic_ = elastic;
    for (int j = 0; j < planes; ++j) {
      const Vector<double, 3> flow = normal(j, flow_ratio);
      law.relaxation_[j] =
          2.0 * elastic.shear_modulus * flow + Vector<double, 3>::Constant(elastic.lame_lambda * flow.sum());
    }
    if constexpr (!friction_falls) {
      for (int i = 0; i < planes; ++i) {
        law.of_angle_.normal[i] = normal(i, law.ratio_);
      }
      for (int s = 0; s < set_count; ++s) {
        law.of_angle_.inverse_coupling[s] = law.coupling(s, law.ratio_).inverse();
      }
    }
    return law;
  }

  // c [Pa] at an equivalent plastic strain.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD Value cohesion(Value plastic_strain) const {
    const auto has_yielded = plastic_strain != Value(0);
    if (residual_cohesion_ == cohesion_ || !any(has_yielded)) {
      return cohesion_;
    }
    return select(has_yielded, residual_cohesion_ + (cohesion_ - residual_cohesion_) * fraction_left(plastic_strain),
                  Value(cohesion_));
  }

  // True if an elastic trial stress [Pa] may be outside the yield surface. Exact to round-off for intact material in
  // plane strain, where principal stresses cost no more than the bound used in 3D.
  static constexpr bool yields = true;
  template <int Dim, class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto may_yield(const SymmetricTensor<Value>& trial,
                                                                    Value plastic_strain) const {
    // exp(-x) is nowhere below 1 - x.
    const Value lowest_fraction = max(1.0 - softening_rate_ * plastic_strain, Value(0));
    const Value lowest_cohesion =
        min(cohesion_, residual_cohesion_) + max(cohesion_ - residual_cohesion_, 0.0) * lowest_fraction;
    const Surface<Value> of_intact_angle{ratio_, 2.0 * root_of_ratio_ * lowest_cohesion};
    if constexpr (friction_falls) {
      // As a function of phi, F decreases and then increases: a stress inside the surface at both ends is inside in
      // between.
      return is_beyond<Dim>(trial, of_intact_angle) |
             is_beyond<Dim>(trial, surface_of(lowest_fraction, lowest_cohesion));
    } else {
      return is_beyond<Dim>(trial, of_intact_angle);
    }
  }

  // Maps an elastic trial stress [Pa] to the admissible stress. Dim 2: plane strain.
  template <int Dim = 3, class Value>
  [[nodiscard]] THAWSLIDE_HD ReturnResult<Value> update(const SymmetricTensor<Value>& trial,
                                                        Value plastic_strain) const {
    using std::abs, std::sqrt;
    const Surface<Value> surface = surface_after(plastic_strain);
    if (!any(!surely_elastic(trial, surface))) {
      return {trial};
    }
    Principal<Value> state = principal<Dim>(trial);
    const Vector<Value, 3> trial_values = state.values;
    const Value tolerance =
        round_off * (surface.ratio * max(abs(trial_values[0]), abs(trial_values[2])) + surface.shear_limit);
    const auto yielded = !is_elastic(trial_values[0], trial_values[2], surface, tolerance);
    if (!any(yielded)) {
      return {trial};
    }
    Value torn = 0;
    state.values = returned(trial_values, surface, tolerance, yielded, torn);
    const Vector<Value, 3> plastic = elastic_strain(Vector<Value, 3>(trial_values - state.values));
    const SymmetricTensor<Value> stress = from_principal(state);
    const auto if_yielded = [&](Value value) { return select(yielded, value, Value(0)); };
    ReturnResult<Value> result{trial};
    for (int c = 0; c < 6; ++c) {
      result.stress[c] = select(yielded, stress[c], trial[c]);
    }
    result.equivalent_plastic_strain_increment = if_yielded(sqrt(2.0 / 3.0 * plastic.squaredNorm()));
    result.plastic_work_density = if_yielded(state.values.dot(plastic));
    result.opening = if_yielded(torn * plastic.sum());
    result.yielded = yielded;
    return result;
  }

 private:
  // Planes for ordered principal stresses: Mohr-Coulomb of (s1, s3), (s1, s2), (s2, s3); cut-off of s1, s2, s3.
  static constexpr int planes = 6;
  static constexpr double round_off = 1e-12;

  // k s1 - s3 = shear limit: k and 2 c sqrt(k) [Pa].
  template <class Value>
  struct Surface {
    std::conditional_t<friction_falls, Value, double> ratio;
    Value shear_limit;
  };

  struct ActiveSet {
    int count;
    int plane[3];
  };
  // Face, cut-off face, edges, corners, in order of decreasing likelihood.
  static constexpr int set_count = 12;
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static const ActiveSet& active_set(int number) {
    // A static array of the class would not exist on a device.
    static constexpr ActiveSet sets[set_count] = {{1, {0, 0, 0}}, {1, {3, 0, 0}}, {2, {0, 1, 0}}, {2, {0, 2, 0}},
                                                  {2, {0, 3, 0}}, {2, {3, 4, 0}}, {3, {3, 4, 5}}, {3, {0, 1, 3}},
                                                  {3, {0, 3, 4}}, {3, {0, 2, 3}}, {3, {2, 3, 4}}, {3, {0, 2, 4}}};
    return sets[number];
  }

  // w: remaining fraction of the softening strength.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value fraction_left(Value plastic_strain) const {
    return map_lanes(softening_rate_ * plastic_strain, [](double strains) { return std::exp(-strains); });
  }

  // Surface for a fraction of the softening sine and a cohesion [Pa].
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Surface<Value> surface_of(Value fraction, Value cohesion) const {
    using std::sqrt;
    const Value ratio = pressure_ratio<Value>(residual_sine_ + (sine_ - residual_sine_) * fraction);
    return {ratio, 2.0 * sqrt(ratio) * cohesion};
  }

  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Surface<Value> surface_after(Value plastic_strain) const {
    if constexpr (friction_falls) {
      const Value fraction = fraction_left(plastic_strain);
      return surface_of<Value>(fraction, residual_cohesion_ + (cohesion_ - residual_cohesion_) * fraction);
    } else {
      return {ratio_, 2.0 * root_of_ratio_ * cohesion(plastic_strain)};
    }
  }

  // True within the surface. largest, smallest: principal stresses, or bounds on them.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto is_elastic(Value largest, Value smallest,
                                                                     const Surface<Value>& surface,
                                                                     Value tolerance = 0) const {
    return (surface.ratio * largest - smallest <= surface.shear_limit + tolerance) &
           (largest <= tension_cutoff_ + tolerance);
  }

  // False only if the stress is within the surface; in plane strain, true only if it is outside.
  template <int Dim, class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto is_beyond(const SymmetricTensor<Value>& trial,
                                                                    const Surface<Value>& surface) const {
    using std::sqrt;
    if constexpr (Dim == 2) {
      const Value centre = 0.5 * (trial[0] + trial[1]), half_difference = 0.5 * (trial[0] - trial[1]);
      const Value radius = sqrt(half_difference * half_difference + trial[3] * trial[3]);
      return !is_elastic(max(centre + radius, trial[2]), min(centre - radius, trial[2]), surface);
    } else {
      return !surely_elastic(trial, surface);
    }
  }

  // True if the stress is within the surface at any Lode angle: principal stresses differ from the mean m by at most r
  // = 2 sqrt(J2/3). Avoids computing principal stresses for most particles.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto surely_elastic(const SymmetricTensor<Value>& s,
                                                                         const Surface<Value>& surface) const {
    using std::sqrt;
    const Value mean = (s[0] + s[1] + s[2]) / Value(3);
    const Value a = s[0] - mean, b = s[1] - mean, c = s[2] - mean;
    const Value second_invariant = 0.5 * (a * a + b * b + c * c) + s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    const Value reach = 2.0 * sqrt(second_invariant / 3.0);
    return is_elastic(mean + reach, mean - reach, surface);
  }

  static double sine_of(double degrees) { return std::sin(degrees * pi / 180.0); }

  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static Value pressure_ratio(Value sine) {
    return (1.0 + sine) / (1.0 - sine);
  }

  template <class Value>
  [[nodiscard]] THAWSLIDE_HD static Vector<Value, 3> normal(int plane, Value ratio) {
    switch (plane) {
      case 0:
        return {ratio, Value(0), Value(-1)};
      case 1:
        return {ratio, Value(-1), Value(0)};
      case 2:
        return {Value(0), ratio, Value(-1)};
      default:
        return {Value(plane == 3 ? 1 : 0), Value(plane == 4 ? 1 : 0), Value(plane == 5 ? 1 : 0)};
    }
  }

  // Principal stresses on the yield surface for lanes that yielded. torn: 1 at the apex or on the cut-off, otherwise 0.
  template <class Value, class Condition>
  [[nodiscard]] THAWSLIDE_HD Vector<Value, 3> returned(const Vector<Value, 3>& trial, const Surface<Value>& surface,
                                                       Value tolerance, const Condition& yielded, Value& torn) const {
    const int planes_here = std::isfinite(tension_cutoff_) ? planes : 3;
    const Value multiplier = inverse_coupling_of_face(surface.ratio) * beyond(0, trial, surface);
    Vector<Value, 3> values;
    for (int k = 0; k < 3; ++k) {
      values[k] = trial[k] - multiplier * relaxation_[0][k];
    }
    const Condition elsewhere =
        yielded & !((multiplier >= Value(0)) & is_admissible(values, surface, 1, planes_here, tolerance));
    if (any(elsewhere)) {
      return_to_edge_or_apex(trial, surface, planes_here, tolerance, elsewhere, values, torn);
    }
    return values;
  }

  // Tries the sets beyond the face in order for all lanes; lanes without a valid set return to the apex.
  template <class Value, class Condition>
  THAWSLIDE_HD [[gnu::noinline]] void return_to_edge_or_apex(const Vector<Value, 3>& trial,
                                                             const Surface<Value>& surface, int planes_here,
                                                             Value tolerance, Condition left, Vector<Value, 3>& values,
                                                             Value& torn) const {
    for (int s = 1; s < set_count && any(left); ++s) {
      const ActiveSet& set = active_set(s);
      const int last = set.plane[set.count - 1];
      if (last >= planes_here) {
        continue;
      }
      Vector<Value, 3> found = trial;
      Condition here = left & relax(s, surface, found);
      here = here & is_admissible(found, surface, 0, planes_here, tolerance);
      for (int k = 0; k < 3; ++k) {
        values[k] = select(here, found[k], values[k]);
      }
      torn = select(here, Value(last >= 3 ? 1 : 0), torn);
      left = left & !here;
    }
    // k s - s = limit on the hydrostatic axis.
    const Value ratio = surface.ratio, mean = (trial[0] + trial[1] + trial[2]) / Value(3);
    const Value apex = select(ratio > Value(1), surface.shear_limit / (ratio - Value(1)), mean);
    for (int k = 0; k < 3; ++k) {
      values[k] = select(left, min(apex, Value(tension_cutoff_)), values[k]);
    }
    torn = select(left, Value(1), torn);
  }

  // Distance of a stress beyond a plane [Pa].
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value beyond(int plane, const Vector<Value, 3>& values,
                                                                  const Surface<Value>& surface) const {
    const auto& normal = normal_at(plane, surface.ratio);
    const Value limit = plane < 3 ? surface.shear_limit : Value(tension_cutoff_);
    return normal[0] * values[0] + normal[1] * values[1] + normal[2] * values[2] - limit;
  }

  // True if a stress is within the planes from `first` on.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD auto is_admissible(const Vector<Value, 3>& values, const Surface<Value>& surface,
                                                int first, int planes_here, Value tolerance) const {
    Value furthest = beyond(first, values, surface);
    for (int i = first + 1; i < planes_here; ++i) {
      furthest = max(furthest, beyond(i, values, surface));
    }
    return furthest <= tolerance;
  }

  // Subtracts the elastic stress of an active set's plastic flow. True for lanes without a negative multiplier.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD auto relax(int number, const Surface<Value>& surface, Vector<Value, 3>& values) const {
    const ActiveSet& set = active_set(number);
    Vector<Value, 3> excess = Vector<Value, 3>::Constant(Value(0));
    for (int a = 0; a < 3 && a < set.count; ++a) {
      excess[a] = beyond(set.plane[a], values, surface);
    }
    const auto& inverse = inverse_coupling(number, surface.ratio);
    auto flows = Value(0) < Value(1);  // true in all lanes
    for (int a = 0; a < 3 && a < set.count; ++a) {
      const Value multiplier = inverse(a, 0) * excess[0] + inverse(a, 1) * excess[1] + inverse(a, 2) * excess[2];
      flows = flows & (multiplier >= Value(0));
      for (int k = 0; k < 3; ++k) {
        values[k] -= multiplier * relaxation_[set.plane[a]][k];
      }
    }
    return flows;
  }

  // Elastic strain of a principal stress.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD Vector<Value, 3> elastic_strain(const Vector<Value, 3>& stress) const {
    const double two_shear = 2.0 * elastic_.shear_modulus;
    const Value mean = elastic_.lame_lambda / (two_shear + 3.0 * elastic_.lame_lambda) * stress.sum();
    const Value compliance = 1.0 / two_shear;
    return compliance * (stress - Vector<Value, 3>::Constant(mean));
  }

  // normal . relaxation for the planes of a set; unused rows have 1 on the diagonal.
  template <class Ratio>
  [[nodiscard]] THAWSLIDE_HD Matrix<Ratio, 3> coupling(int number, Ratio ratio) const {
    const ActiveSet& set = active_set(number);
    Matrix<Ratio, 3> coupling = Matrix<Ratio, 3>::Identity();
    for (int a = 0; a < 3 && a < set.count; ++a) {
      const auto& normal = normal_at(set.plane[a], ratio);
      for (int b = 0; b < 3 && b < set.count; ++b) {
        const Vector<double, 3>& relaxation = relaxation_[set.plane[b]];
        coupling(a, b) = normal[0] * relaxation[0] + normal[1] * relaxation[1] + normal[2] * relaxation[2];
      }
    }
    return coupling;
  }

  // For the face of s1 and s3.
  template <class Ratio>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Ratio inverse_coupling_of_face(Ratio ratio) const {
    if constexpr (friction_falls) {
      return 1.0 / (ratio * relaxation_[0][0] - relaxation_[0][2]);
    } else {
      return of_angle_.inverse_coupling[0](0, 0);
    }
  }

  template <class Ratio>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE decltype(auto) normal_at(int plane, Ratio ratio) const {
    if constexpr (friction_falls) {
      return normal(plane, ratio);
    } else {
      return (of_angle_.normal[plane]);
    }
  }

  template <class Ratio>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE decltype(auto) inverse_coupling(int number, Ratio ratio) const {
    if constexpr (friction_falls) {
      return Matrix<Ratio, 3>(coupling(number, ratio).inverse());
    } else {
      return (of_angle_.inverse_coupling[number]);
    }
  }

  // Quantities derived from a constant friction angle.
  struct OfAngle {  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming): of the copy by clang
    Vector<double, 3> normal[planes];
    Matrix<double, 3> inverse_coupling[set_count];
  };
  struct Nothing {};

  double sine_ = 0, residual_sine_ = 0;   // of phi_0 and phi_f
  double ratio_ = 1, root_of_ratio_ = 1;  // of phi_0: k, sqrt(k)
  double cohesion_ = 0, residual_cohesion_ = 0, tension_cutoff_ = 0;
  double softening_rate_ = 1;  // 1/eps_c
  Elastic elastic_;
  Vector<double, 3> relaxation_[planes];  // elastic stress of a plane's flow [Pa per unit multiplier]
  std::conditional_t<friction_falls, Nothing, OfAngle> of_angle_;
};

// Dispatched once per batch of particles of one material, never per particle.
using ConstitutiveLaw = std::variant<LinearElastic, MohrCoulomb<>, MohrCoulomb<true>>;

}  // namespace thawslide::physics
