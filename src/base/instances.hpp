// What the templates of the step are compiled for: both dimensions, in double precision. The benchmarks compile them
// once more in single precision, to measure only.
#pragma once

#ifndef THAWSLIDE_REAL
#define THAWSLIDE_REAL double
#endif

#define THAWSLIDE_FOR_ALL_INSTANCES(INSTANTIATE) \
  INSTANTIATE(2, THAWSLIDE_REAL)                 \
  INSTANTIATE(3, THAWSLIDE_REAL)
