// Template instances of the step: both dimensions, in double precision. The benchmarks also compile them in single
// precision, for measurements only.
#pragma once

#ifndef THAWSLIDE_REAL
#define THAWSLIDE_REAL double
#endif

#define THAWSLIDE_FOR_ALL_INSTANCES(INSTANTIATE) \
  INSTANTIATE(2, THAWSLIDE_REAL)                 \
  INSTANTIATE(3, THAWSLIDE_REAL)
