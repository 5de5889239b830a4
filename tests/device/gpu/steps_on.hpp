// Steps of the block (slide.hpp) on a GPU, or emulated on the CPU.
#pragma once

#include <memory>

#include "../emulated.hpp"
#include "variants.hpp"

namespace thawslide::gpu_test {

template <int Dim>
using Steps = device::Solver<Dim>;

// specified: record of the data that the CPU receives during steps.
template <int Dim>
std::unique_ptr<Steps<Dim>> steps_of(const device::SolverFactory<Dim>& make, const ParticleMemory<Dim>& particles,
                                     Variant variant = Variant::plain,
                                     const std::shared_ptr<Reported>& specified = std::make_shared<Reported>()) {
  return make(model_of<Dim>(variant), particles.view(), particles.size(), processor_of<Dim>(variant, specified));
}

}  // namespace thawslide::gpu_test
