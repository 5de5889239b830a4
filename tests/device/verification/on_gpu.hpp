// Included before tests/cpp/verification to run its steps on a GPU. Every Simulation of a test uses it, except cases
// that no device supports; these report it and run on the CPU.
#pragma once

#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "device/gpu.hpp"
#include "sim/checks/body_figures.hpp"
#include "sim/records/base_table.hpp"
#include "sim/records/history.hpp"
#include "sim/records/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
class SimulationOnGpu : public Simulation<Dim> {
 public:
  explicit SimulationOnGpu(const config::Case& parameters, const config::Site& site = {})
      : Simulation<Dim>(parameters, site) {
    try {
      this->use_device("a GPU", device::on_gpu<Dim>());
    } catch (const UserError& refused) {
      std::printf("on the CPU: %s\n", refused.what());
    }
  }
};

}  // namespace thawslide::sim

#define Simulation SimulationOnGpu
