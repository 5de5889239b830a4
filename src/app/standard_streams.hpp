// Standard input, output and error of the process.
#pragma once

namespace thawslide::app {

// Occupies standard streams that the parent process has closed, so that no later file takes their descriptors and
// receives messages. Reading and writing such a stream fails as before.
void hold_standard_streams();

}  // namespace thawslide::app
