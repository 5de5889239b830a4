// Linear isotropic elasticity (the elastic part of Eq. 11). Tension positive; tensors xx yy zz xy yz xz with tensor
// shear strains.
//   d sigma = lambda tr(d eps) I + 2 G d eps,  lambda = E nu/((1+nu)(1-2nu)),  G = E/(2(1+nu))
//   w = (sigma:sigma - lambda/(3 lambda + 2 G) tr(sigma)^2)/(4 G), its energy per volume
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::physics {

struct Elastic {
  double lame_lambda = 0;    // lambda [Pa]
  double shear_modulus = 0;  // G [Pa]

  // Young's modulus E [Pa], Poisson's ratio nu.
  THAWSLIDE_HD static Elastic from_young_poisson(double youngs_modulus, double poisson_ratio) {
    return {youngs_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)),
            youngs_modulus / (2.0 * (1.0 + poisson_ratio))};
  }

  // lambda + 2 G [Pa]: stiffness in uniaxial compression without lateral strain; determines the wave speed.
  [[nodiscard]] THAWSLIDE_HD double p_wave_modulus() const { return lame_lambda + 2.0 * shear_modulus; }
};

// Stress increment [Pa] of a strain increment.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE SymmetricTensor<Value> stress_increment(const Elastic& elastic,
                                                                             const SymmetricTensor<Value>& strain) {
  SymmetricTensor<Value> stress = Value(2.0 * elastic.shear_modulus) * strain;
  const Value pressure = elastic.lame_lambda * (strain[0] + strain[1] + strain[2]);
  stress[0] += pressure;
  stress[1] += pressure;
  stress[2] += pressure;
  return stress;
}

// Elastic energy density [J/m3] of a stress [Pa].
inline double elastic_energy_density(const Elastic& elastic, const SymmetricTensor<double>& stress) {
  const double trace = stress[0] + stress[1] + stress[2];
  const double square = stress[0] * stress[0] + stress[1] * stress[1] + stress[2] * stress[2] +
                        2.0 * (stress[3] * stress[3] + stress[4] * stress[4] + stress[5] * stress[5]);
  const double lateral = elastic.lame_lambda / (3.0 * elastic.lame_lambda + 2.0 * elastic.shear_modulus);
  return (square - lateral * trace * trace) / (4.0 * elastic.shear_modulus);
}

// Result of mapping an elastic trial stress by a constitutive law (Eq. 11), and the linear elastic law (Eq. 10).

template <class Value>
struct ReturnResult {
  using Condition = decltype(Value() < Value());

  SymmetricTensor<Value> stress;                  // [Pa]
  Value equivalent_plastic_strain_increment = 0;  // sqrt(2/3 de_p:de_p)
  Value plastic_work_density = 0;                 // stress : de_p [J/m3]
  Value opening = 0;  // volumetric plastic strain at the apex or the cut-off: opening of a gap
  Condition yielded = Value(0) < Value(0);
};

struct LinearElastic {
  static constexpr bool yields = false;

  template <int Dim = 3, class Value>
  [[nodiscard]] THAWSLIDE_HD ReturnResult<Value> update(const SymmetricTensor<Value>& trial,
                                                        Value /*plastic_strain*/) const {
    return {trial};
  }
};

}  // namespace thawslide::physics
