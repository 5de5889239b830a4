// The heat content laws that a run may have, by their freezing curves.
#pragma once

#include <variant>

#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"

namespace thawslide::band {

template <class Real>
using AnyHeatContent = std::variant<physics::HeatContent<Real, physics::PowerLawCurve<Real>>,
                                    physics::HeatContent<Real, physics::LinearCurve<Real>>>;

}  // namespace thawslide::band
