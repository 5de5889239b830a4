// Threads of parallel loops (base/parallel.hpp) that wait for the next loop.
#pragma once

namespace thawslide {

// Ends those of the calling thread's loops; the next loop starts others. A forked process has no copies of them, and
// its first loop would wait for them for ever.
void end_waiting_threads();

}  // namespace thawslide
