// Timing of single functions of the step.
#pragma once

namespace thawslide::speed {

// Registers them with Google Benchmark.
void add_kernels();

}  // namespace thawslide::speed
