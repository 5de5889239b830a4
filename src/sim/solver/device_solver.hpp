// Time step on a device (src/device).
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/clocks.hpp"
#include "device/solver_factory.hpp"
#include "sim/solver/base.hpp"
#include "sim/solver/clock.hpp"
#include "sim/solver/slide.hpp"
#include "sim/solver/solver.hpp"

namespace thawslide::sim {

template <int Dim>
class DeviceSolver final : public Solver<Dim> {
 public:
  // host: reduces the particles while they are in host memory. All references must outlive the solver.
  DeviceSolver(const Setup<Dim>& setup, Slide<Dim>& slide, Base<Dim>& base, const Clock& clock, Stopwatch& stopwatch,
               const Solver<Dim>& host, std::string name, device::SolverFactory<Dim> make);
  ~DeviceSolver() override;

  [[nodiscard]] const std::string& name() const { return name_; }
  // True if the particles in host memory are outdated and no step can continue from them.
  [[nodiscard]] bool has_failed() const;

  void start() override;
  StepSums<Dim> step(double dt, const terrain::StrengthLaw* strength) override;
  [[nodiscard]] bool none_has_left() const override;
  [[nodiscard]] AnySums<Dim> reduce(const AnyReduction<Dim>& reduction) const override;
  [[nodiscard]] band::StepExtremes extremes() const override;
  [[nodiscard]] mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) const override;
  [[nodiscard]] const device::MapSample* sample_map(const mpm::MapCells& cells) const override;
  [[nodiscard]] MomentumOfNodes momentum_of_nodes() const override;
  void copy_particles_back() const override;
  void copy_columns_back() const override;
  void sync_to_host() const override;
  void release() override;

 private:
  // Solver on the device and its last results.
  struct Session;

  // Runs work on the device. If the device fails, the host keeps the particles of the last synchronization, or a
  // mixture if it fails during one. Throws DeviceError then.
  void call(const std::function<void()>& work) const;
  // Copies the momentum of the nodes of the last step, if the device has it.
  void fetch_nodes() const;

  const Setup<Dim>& setup_;
  Slide<Dim>& slide_;
  Base<Dim>& base_;
  const Clock& clock_;
  Stopwatch& stopwatch_;
  const Solver<Dim>& host_;
  std::string name_;
  device::SolverFactory<Dim> make_;
  std::unique_ptr<Session> session_;
};

}  // namespace thawslide::sim
