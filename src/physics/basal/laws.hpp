// Basal laws (Eqs. 17, 25), one per line, in the order of the reference. The case file, its messages and its reference,
// `thawslide run` and `thawslide block` use these lists.
#pragma once

#include <utility>
#include <variant>

#include "physics/basal/bonds_cohesion.hpp"
#include "physics/basal/coefficient_friction.hpp"
#include "physics/basal/constant_cohesion.hpp"
#include "physics/basal/constant_friction.hpp"
#include "physics/basal/ice_cohesion.hpp"
#include "physics/basal/lubricated_friction.hpp"
#include "physics/basal/slip_cohesion.hpp"
#include "physics/basal/time_cohesion.hpp"
#include "physics/basal/voellmy_friction.hpp"

namespace thawslide::physics::basal {

using FrictionLaw = std::variant<  //
    ConstantFriction,              //
    LubricatedFriction,            //
    CoefficientFriction,           //
    VoellmyFriction>;

using CohesionLaw = std::variant<  //
    ConstantCohesion,              //
    SlipCohesion,                  //
    IceCohesion,                   //
    TimeCohesion,                  //
    BondsCohesion>;

// Traction of a friction law that is independent of the load [Pa].
template <class Law>
THAWSLIDE_HD double drag_of(const Law& law, const ContactNode& node) {
  if constexpr (requires { law.drag(node); }) {
    return law.drag(node);
  } else {
    return 0.0;
  }
}

// Type of a law, as a function argument.
template <class Law>
struct OfType {
  using type = Law;
};

// Calls function(OfType<Law>) for each law of one of the lists above.
template <class Laws, class Function>
void for_each_law(const Function& function) {
  [&]<std::size_t... K>(std::index_sequence<K...> /*numbers*/) {
    (function(OfType<std::variant_alternative_t<K, Laws>>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Laws>>{});
}

}  // namespace thawslide::physics::basal
