// Template instances of the step: both dimensions.
#pragma once

#define THAWSLIDE_FOR_ALL_INSTANCES(INSTANTIATE) \
  INSTANTIATE(2)                                 \
  INSTANTIATE(3)
