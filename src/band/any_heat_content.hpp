// Heat content laws available to a run, by freezing curve.
#pragma once

#include <variant>

#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"

namespace thawslide::band {

template <class Real>
using AnyHeatContent = std::variant<physics::HeatContent<Real, physics::PowerLawCurve<Real>>,
                                    physics::HeatContent<Real, physics::LinearCurve<Real>>>;

}  // namespace thawslide::band
