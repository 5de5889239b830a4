// Included before tests/cpp/verification to run its steps on a GPU. Every Simulation of a test uses it.
#pragma once

#include "device/gpu.hpp"
#include "sim/checks/body_figures.hpp"
#include "sim/records/end_state.hpp"
#include "sim/records/history.hpp"
#include "sim/records/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
class SimulationOnGpu : public Simulation<Dim> {
 public:
  explicit SimulationOnGpu(const config::Case& parameters, const config::Site& site = {})
      : Simulation<Dim>(parameters, site) {
    this->use_device("a GPU", device::on_gpu<Dim>());
  }
};

}  // namespace thawslide::sim

#define Simulation SimulationOnGpu
