// Heat content laws available to a run, by freezing curve.
#pragma once

#include <variant>

#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"

namespace thawslide::band {

using AnyHeatContent =
    std::variant<physics::HeatContent<physics::PowerLawCurve>, physics::HeatContent<physics::LinearCurve>>;

}  // namespace thawslide::band
