// Steps of the block (slide.hpp) by the processor, in a card's place.
#pragma once

#include <memory>

#include "device/any_step.hpp"
#include "slide.hpp"

namespace thawslide::card_test {

template <int Dim>
using Steps = device::AnyStep<Dim, Real>;

template <int Dim>
device::MakeStep<Dim, Real> on_processor();

template <int Dim>
std::unique_ptr<Steps<Dim>> steps_of(const device::MakeStep<Dim, Real>& make, const ParticleMemory<Dim>& particles) {
  return make(model_of_slide<Dim>(), particles.view(), particles.size(), terrain_of_slide<Dim>());
}

}  // namespace thawslide::card_test
