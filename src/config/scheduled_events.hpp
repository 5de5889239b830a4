// Times at which a case changes by itself: a slide at rest before them may start again.
#pragma once

#include <algorithm>
#include <variant>

#include "config/basal_laws.hpp"
#include "config/case.hpp"

namespace thawslide::config {

// Time at which ground loses its cohesion [s]; 0 if it does so by slip, or does not.
inline double cohesion_loss_time(const GroundStrength& ground) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.loss_time; }) {
          return law.initial == law.residual ? 0.0 : law.loss_time;
        } else {
          return 0.0;
        }
      },
      cohesion_of(ground));
}

// Time of the last change [s]; 0 if there is none.
inline double last_scheduled_event(const Case& parameters) {
  double last = cohesion_loss_time(parameters.basal);
  for (const auto& [name, substrate] : parameters.substrates) {
    last = std::max(last, cohesion_loss_time(substrate));
  }
  const auto& thickness = parameters.band.thickness.table;
  for (std::size_t k = 1; k < thickness.abscissa.size(); ++k) {
    if (thickness.value[k] != thickness.value[k - 1]) {
      last = std::max(last, thickness.abscissa[k]);
    }
  }
  return last;
}

}  // namespace thawslide::config
