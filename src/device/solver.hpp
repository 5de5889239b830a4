// Abstract interface of a solver on a device, independent of backend and shape functions.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "band/base_sums.hpp"
#include "device/reductions.hpp"
#include "device/solver_factory.hpp"
#include "device/step_model.hpp"
#include "mpm/front.hpp"
#include "mpm/particle_view.hpp"
#include "terrain/basal_law.hpp"

namespace thawslide::band {
struct MapSample;
}  // namespace thawslide::band
namespace thawslide::device {

// Error of a device. The message states which operation failed.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Device errors are thrown as a Failure; errors of the CPU callbacks propagate unchanged.
template <int Dim>
class Solver {
 public:
  Solver() = default;
  virtual ~Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // Advances the solution by dt [s], from time [s]. strength: replaces the basal laws of the case; or null.
  virtual StepSums<Dim> step(double time, double dt, const terrain::StrengthLaw* strength) = 0;
  // Extremes that determine the first step; those of later ones are among the sums of the step before.
  virtual band::StepExtremes extremes() = 0;
  // Reduction over the particles after a step.
  virtual AnySums<Dim> reduce(const AnyReduction<Dim>& reduction) = 0;
  // Sums for maps, valid until the next call; null in 2D.
  virtual const band::MapSample* sample_map(const mpm::MapCells& cells) = 0;
  // Particle at the front. mass: total mass of the particles [kg].
  virtual mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) = 0;
  // Positions [m, relative to the domain's lower corner] of the particles that the last step counted as escaped.
  virtual std::vector<Vector<double, Dim>> escaped_positions() = 0;
  // Copies the keys of the blocks, and the records of Momentum of their nodes after a step.
  virtual void copy_momentum_to(std::vector<std::uint64_t>& blocks, std::vector<double>& records) = 0;
  // Sorts particles in memory into canonical order. Does not affect results.
  virtual void sort_in_memory() = 0;
  // Copies to the same number of particles, in their original order.
  virtual void copy_to(const mpm::ParticleView<Dim>& particles) = 0;
  // Basal segments, and sums over them; both require band columns.
  [[nodiscard]] virtual band::SegmentsState<Dim> segments() const = 0;
  virtual band::BaseTotals base_totals() = 0;
  // Measures stages [s] from now on, with a synchronization after each.
  virtual void time_stages() = 0;
  [[nodiscard]] virtual std::map<std::string, double> seconds() const = 0;
};

}  // namespace thawslide::device
