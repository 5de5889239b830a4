// Result of mapping an elastic trial stress by a constitutive law (Eq. 11), and the linear elastic law (Eq. 10).
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::physics {

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
