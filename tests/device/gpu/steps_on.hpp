// Steps of the block (slide.hpp) on a card, or by the processor in a card's place.
#pragma once

#include <memory>

#include "../emulated.hpp"
#include "variants.hpp"

namespace thawslide::gpu_test {

template <int Dim>
using Steps = device::Solver<Dim, Real>;

// told: what the processor's part in the steps is told.
template <int Dim>
std::unique_ptr<Steps<Dim>> steps_of(const device::SolverFactory<Dim, Real>& make, const ParticleMemory<Dim>& particles,
                                     Variant variant = Variant::plain,
                                     const std::shared_ptr<Told>& specified = std::make_shared<Told>()) {
  return make(model_of<Dim>(variant), particles.view(), particles.size(), processor_of<Dim>(variant, specified));
}

}  // namespace thawslide::gpu_test
