// Single functions of the step, timed alone.
#pragma once

namespace thawslide::speed {

// Registers them with Google Benchmark.
void add_kernels();

}  // namespace thawslide::speed
