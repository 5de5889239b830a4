// Number type of the step. The build chooses single precision by THAWSLIDE_REAL=float.
#pragma once

#ifndef THAWSLIDE_REAL
#define THAWSLIDE_REAL double
#endif

namespace thawslide {

using Real = THAWSLIDE_REAL;

}  // namespace thawslide
