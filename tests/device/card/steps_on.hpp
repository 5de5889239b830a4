// Steps of the block on a backend (slide.hpp).
#pragma once

#include <memory>

#include "device/step.hpp"
#include "slide.hpp"

namespace thawslide::card_test {

template <class Backend, int Dim>
class StepsOn final : public Steps<Dim> {
 public:
  explicit StepsOn(const ParticleMemory<Dim>& particles)
      : mechanics_(backend_, model_of_slide<Dim>(), particles.view(), particles.size(), terrain_of_slide<Dim>()) {}

  device::StepSums<Dim, Real> step(Real time, Real dt) override { return mechanics_.step(time, dt); }
  void sort_in_memory() override { mechanics_.sort_in_memory(); }
  void copy_to(const mpm::ParticleView<Dim, Real>& particles) const override {
    mechanics_.particles().copy_to(particles);
  }
  void time_stages() override { backend_.time_stages(); }
  [[nodiscard]] std::map<std::string, double> seconds() const override { return backend_.seconds(); }

 private:
  Backend backend_;
  device::Step<Backend, mpm::Ugimp<Real>, Dim, Real> mechanics_;
};

template <int Dim>
std::unique_ptr<Steps<Dim>> on_processor(const ParticleMemory<Dim>& particles);
template <int Dim>
std::unique_ptr<Steps<Dim>> on_card(const ParticleMemory<Dim>& particles);

}  // namespace thawslide::card_test
