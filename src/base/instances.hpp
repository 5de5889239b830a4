// What the templates of the step are compiled for: dimensions, and the precision of numbers.
#pragma once

// The sanitizers and clang-tidy take long, and find in one precision what there is to find in both.
#if defined(THAWSLIDE_DOUBLE_ONLY) || defined(__clang_analyzer__)
#define THAWSLIDE_FOR_ALL_INSTANCES(INSTANTIATE) \
  INSTANTIATE(2, double)                         \
  INSTANTIATE(3, double)
#else
#define THAWSLIDE_FOR_ALL_INSTANCES(INSTANTIATE) \
  INSTANTIATE(2, double)                         \
  INSTANTIATE(3, double)                         \
  INSTANTIATE(2, float)                          \
  INSTANTIATE(3, float)
#endif
