// Time step of a slide on one of two executors, the CPU or a device, and reductions over its particles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "band/base_sums.hpp"
#include "band/step_extremes.hpp"
#include "device/reductions.hpp"
#include "device/step_sums.hpp"
#include "mpm/front.hpp"
#include "terrain/basal_law.hpp"

namespace thawslide::band {
struct MapSample;
}  // namespace thawslide::band
namespace thawslide::mpm {
struct MapCells;
}  // namespace thawslide::mpm
namespace thawslide::sim {

using band::BodySums, device::AnyReduction, device::AnySums, device::StepSums;

// By block (ascending keys) and node of a block.
struct MomentumOfNodes {
  std::vector<std::uint64_t> blocks;
  std::vector<double> records;
};

// Functions that are const may update the copy of the slide in host memory, which changes no result.
template <int Dim>
class Solver {
 public:
  Solver() = default;
  virtual ~Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // Name of the device; empty for the CPU.
  [[nodiscard]] virtual std::string name() const { return ""; }
  // True if the particles in host memory are outdated and no step can continue from them.
  [[nodiscard]] virtual bool has_failed() const { return false; }
  // Transfers the particles to where the step is performed, unless they are there.
  virtual void start() = 0;
  // Advances particles by dt [s] from the time of the clock. strength: replaces the basal laws of the case; or null. If
  // it throws, the particles are those before the step; with the published rescaling of the band, their temperatures
  // may already be those of its new thickness.
  virtual StepSums<Dim> step(double dt, const terrain::StrengthLaw* strength) = 0;
  // True if the last step has shown that no particle has left. Otherwise all have to be checked in host memory.
  [[nodiscard]] virtual bool none_has_left() const = 0;

  // Sums of a reduction over all particles.
  template <class Reduction>
  [[nodiscard]] typename Reduction::Sums sum_over_particles(const Reduction& reduction) const {
    return std::get<typename Reduction::Sums>(reduce(reduction));
  }
  [[nodiscard]] virtual AnySums<Dim> reduce(const AnyReduction<Dim>& reduction) const = 0;
  // Extremes of all particles, which limit the next step.
  [[nodiscard]] virtual band::StepExtremes extremes() const = 0;
  // mass: of the bodies of the path [kg].
  [[nodiscard]] virtual mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) const = 0;
  // Requires band columns.
  [[nodiscard]] virtual band::BaseTotals base_totals() const = 0;
  // Sums for maps, valid until the next call; null in 2D.
  [[nodiscard]] virtual const band::MapSample* sample_map(const mpm::MapCells& cells) const = 0;

  // Records of Momentum of the nodes of the last step; empty before the first step with mechanics.
  [[nodiscard]] virtual MomentumOfNodes momentum_of_nodes() const = 0;

  // Updates the particles in host memory; the second function also updates their grid.
  virtual void copy_particles_back() const = 0;
  virtual void sync_to_host() const = 0;
  // Updates the basal segments in host memory.
  virtual void copy_columns_back() const = 0;
  // Updates particles, grid and segments in host memory; the next step begins with them.
  virtual void release() = 0;
};

}  // namespace thawslide::sim
