// Solver on one backend.
#pragma once

#include <utility>
#include <vector>

#include "device/solver.hpp"
#include "device/step.hpp"

namespace thawslide::device {

template <class Backend, class Shape, int Dim>
class SolverImpl final : public Solver<Dim> {
 public:
  // backend: constructor arguments of Backend.
  template <class... Words>
  SolverImpl(const StepModel<Dim>& model, const mpm::ParticleView<Dim>& particles, std::size_t count,
             HostCallbacks<Dim> callbacks, Words&&... backend)
      : backend_(std::forward<Words>(backend)...), step_(backend_, model, particles, count, std::move(callbacks)) {}

  StepSums<Dim> step(double time, double dt, const terrain::StrengthLaw* strength) override {
    return step_.step(time, dt, strength);
  }
  band::StepExtremes extremes() override { return step_.extremes(); }
  AnySums<Dim> reduce(const AnyReduction<Dim>& reduction) override { return step_.reduce(reduction); }
  const band::MapSample* sample_map(const mpm::MapCells& cells) override { return step_.sample_map(cells); }
  mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) override { return step_.front(path, mass); }
  std::vector<Vector<double, Dim>> escaped_positions() override { return step_.escaped_positions(); }
  void copy_momentum_to(std::vector<std::uint64_t>& blocks, std::vector<double>& records) override {
    step_.copy_momentum_to(blocks, records);
  }
  void sort_in_memory() override { step_.sort_in_memory(); }
  void copy_to(const mpm::ParticleView<Dim>& particles) override { step_.copy_to(particles); }
  [[nodiscard]] band::SegmentsState<Dim> segments() const override { return step_.segments(); }
  band::BaseTotals base_totals() override { return step_.base_totals(); }
  void time_stages() override { backend_.time_stages(); }
  [[nodiscard]] std::map<std::string, double> seconds() const override { return backend_.seconds(); }

 private:
  Backend backend_;
  Step<Backend, Shape, Dim> step_;
};

// Creates the solver with the shape functions of the model.
template <class Backend, int Dim, class... Words>
std::unique_ptr<Solver<Dim>> steps_on(const StepModel<Dim>& model, const mpm::ParticleView<Dim>& particles,
                                      std::size_t count, HostCallbacks<Dim> callbacks, const Words&... backend) {
  std::unique_ptr<Solver<Dim>> made;
  mpm::with_shape(model.motion.shape, [&](auto shape) {
    made = std::make_unique<SolverImpl<Backend, decltype(shape), Dim>>(model, particles, count, std::move(callbacks),
                                                                       backend...);
  });
  return made;
}

}  // namespace thawslide::device
