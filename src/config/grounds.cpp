#include "config/grounds.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "base/error.hpp"

namespace thawslide::config {

using physics::basal::FrictionLaw, physics::basal::CohesionLaw;

template <class Laws>
Laws law_of(const GroundStrength& ground) {
  std::string keyword = ground.friction;
  if constexpr (std::is_same_v<Laws, CohesionLaw>) {
    const bool has_cohesion = ground.numbers(physics::basal::initial_cohesion) > 0.0;
    keyword = has_cohesion ? ground.cohesion_law : physics::basal::ConstantCohesion::keyword;
  }
  Laws found{};
  bool is_known = false;
  physics::basal::for_each_law<Laws>([&]<class Law>(physics::basal::OfType<Law>) {
    if (keyword == Law::keyword) {
      found = Law::from(ground.numbers);
      is_known = true;
    }
  });
  THAWSLIDE_ASSERT(is_known, "no law of the base is called {}", keyword);
  return found;
}
template FrictionLaw law_of<FrictionLaw>(const GroundStrength&);
template CohesionLaw law_of<CohesionLaw>(const GroundStrength&);

namespace {

// Time at which ground loses its cohesion [s]; 0 if it does so by slip, or does not.
double cohesion_loss_time(const GroundStrength& ground) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.loss_time; }) {
          return law.initial == law.residual ? 0.0 : law.loss_time;
        } else {
          return 0.0;
        }
      },
      law_of<CohesionLaw>(ground));
}

}  // namespace

double last_scheduled_event(const Case& parameters) {
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

std::vector<Strip> strips_of(const Case& parameters) {
  std::vector<Strip> strips;
  for (const auto& [name, substrate] : parameters.substrates) {
    if (substrate.is_strip()) {
      strips.push_back({name, substrate.x_min, substrate.x_max});
    }
  }
  std::sort(strips.begin(), strips.end(), [](const Strip& one, const Strip& other) { return one.from < other.from; });
  return strips;
}

}  // namespace thawslide::config
