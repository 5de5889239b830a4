// A step whose backend and shape functions were chosen when the program was built, for whoever takes steps on a device
// without knowing which.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "band/body_sums.hpp"
#include "device/failure.hpp"
#include "device/step_model.hpp"
#include "mpm/front.hpp"
#include "mpm/monitor_sums.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// What goes wrong with the device is thrown as a Failure; what goes wrong with the processor's part as it is.
template <int Dim, class Real>
class Solver {
 public:
  Solver() = default;
  virtual ~Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // One step of dt [s] from a time [s] on.
  virtual StepSums<Dim, Real> step(Real time, Real dt) = 0;
  // What a look at the particles after a step finds.
  virtual mpm::MonitorSums<Real> watch(const mpm::MonitorKernel<Dim, Real>& look) = 0;
  // The same for maps, in space.
  virtual void sample_map(const mpm::MapCells& cells, MapSample& look) = 0;
  // What a row of the history sums.
  virtual band::BodySums<Dim, Real> sum_over_body(const band::SumsOfParticle<Dim, Real>& of_particle) = 0;
  // The particle at the front, of those whose mass together is so much [kg].
  virtual mpm::PathSample front(const mpm::Transformation<Dim>& way, double mass) = 0;
  // Where those stand that the last step told as strays, from the domain's lower corner [m].
  virtual std::vector<Vector<Real, Dim>> escaped_positions() = 0;
  // Particles move in memory to stand in canonical order. Results do not depend on it.
  virtual void sort_in_memory() = 0;
  // To as many particles, in the order in which they came to the device.
  virtual void copy_to(const mpm::ParticleView<Dim, Real>& particles) = 0;
  // From now on each stage is waited for and timed; seconds by stage, so far.
  virtual void time_stages() = 0;
  [[nodiscard]] virtual std::map<std::string, double> seconds() const = 0;
};

// Copies so many particles to a device, where steps go on from them.
template <int Dim, class Real>
using SolverFactory = std::function<std::unique_ptr<Solver<Dim, Real>>(
    const StepModel<Dim, Real>&, const mpm::ParticleView<Dim, Real>&, std::size_t count, HostCallbacks<Dim, Real>)>;

}  // namespace thawslide::device
