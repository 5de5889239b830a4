// End of a run whose slide has entirely left the domain or the known ground, if the case removes leaving particles.
#pragma once

#include "base/error.hpp"

namespace thawslide::sim {

// Thrown by a step that leaves no particle. The state is that of this step and still contains the particles that left
// last; they count in no left_* column of the history.
class SlideLeft : public RunError {
 public:
  using RunError::RunError;
};

}  // namespace thawslide::sim
