// Number type of the step.
#pragma once

namespace thawslide {

using Real = double;

}  // namespace thawslide
