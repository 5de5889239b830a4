// How a run ends whose whole slide has left the domain or the known ground, where the case removes what leaves.
#pragma once

#include "base/error.hpp"

namespace thawslide::sim {

// Thrown by a step after which no particle is left to go on with. The state then is that of this step, with the
// particles that left last still in it; they count in no column left_* of the history.
class SlideLeft : public RunError {
 public:
  using RunError::RunError;
};

}  // namespace thawslide::sim
