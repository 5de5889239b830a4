// Time step on a device (src/device).
#pragma once

#include <memory>
#include <string>

#include "base/clocks.hpp"
#include "device/solver_factory.hpp"
#include "device/step_model.hpp"
#include "sim/solver/base.hpp"
#include "sim/solver/clock.hpp"
#include "sim/solver/slide.hpp"
#include "sim/solver/solver.hpp"

namespace thawslide::sim {

// Input of a solver. clock: before the first step on the device.
template <int Dim>
device::StepModel<Dim> step_model_of(const config::Case& parameters, const Model<Dim>& model, const Clock& clock);
// Queries of the model's terrain; the model must outlive the result.
template <int Dim>
device::HostCallbacks<Dim> host_callbacks_of(const Model<Dim>& model, double cell);

// name: of the device. host: reduces the particles while they are in host memory. All references must outlive the
// solver.
template <int Dim>
[[nodiscard]] std::unique_ptr<Solver<Dim>> make_device_solver(const Setup<Dim>& setup, Slide<Dim>& slide,
                                                              Base<Dim>& base, const Clock& clock, Stopwatch& stopwatch,
                                                              const Solver<Dim>& host, std::string name,
                                                              device::SolverFactory<Dim> make);

}  // namespace thawslide::sim
