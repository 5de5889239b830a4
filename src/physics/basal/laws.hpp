// The laws of the base (Eqs. 17, 25): a line each, in the order in which the reference tells them. The case file, its
// messages and its reference, `thawslide run` and `thawslide block` take them from here.
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

namespace thawslide::physics::basal {

template <class Real>
using FrictionLaw = std::variant<  //
    ConstantFriction<Real>,        //
    LubricatedFriction<Real>,      //
    CoefficientFriction<Real>>;

template <class Real>
using CohesionLaw = std::variant<  //
    ConstantCohesion<Real>,        //
    SlipCohesion<Real>,            //
    IceCohesion<Real>,             //
    TimeCohesion<Real>,            //
    BondsCohesion<Real>>;

// The type of a law, to be handed to a function.
template <class Law>
struct OfType {
  using type = Law;
};

namespace detail {

template <class Laws>
struct Each;
template <class... Laws>
struct Each<std::variant<Laws...>> {
  template <class Function>
  static void call(const Function& function) {
    (function(OfType<Laws>{}), ...);
  }
};

}  // namespace detail

// function(OfType<Law>) for each law of one of the lists above.
template <class Laws, class Function>
void for_each_law(const Function& function) {
  detail::Each<Laws>::call(function);
}

}  // namespace thawslide::physics::basal
