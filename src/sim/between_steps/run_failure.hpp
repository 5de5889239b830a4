// Messages of a failed run: particle, position and probable cause.
#pragma once

#include <string>

#include "band/body_sums.hpp"
#include "mpm/kernel_totals.hpp"
#include "sim/setup/model.hpp"
#include "sim/solver/clock.hpp"
#include "sim/solver/slide.hpp"

namespace thawslide::sim {

// Position of a particle in the coordinates of the case [m].
template <int Dim>
[[nodiscard]] Vector<double, Dim> position_of(const Model<Dim>& model, const mpm::Particles<Dim>& particles,
                                              std::size_t p);

// Throws RunError with the time and the step.
[[noreturn]] void fail_run(const Clock& clock, const std::string& why);

// Message of a run whose last particles have left. mass: of these [kg].
template <int Dim>
[[nodiscard]] std::string text_of_left_slide(const Clock& clock, double mass);

template <int Dim>
class FailureText {
 public:
  // sums: over all particles. setup and slide must outlive the object.
  FailureText(const Setup<Dim>& setup, const Slide<Dim>& slide, const band::BodySums<Dim>& sums)
      : setup_(setup), slide_(slide), particles_(slide.particles), sums_(sums) {}

  // "particle 12 of body 'slide' at (1, 2, 3) m". p: index in memory.
  [[nodiscard]] std::string name_of(std::size_t p) const;
  [[nodiscard]] std::string of_particle(const mpm::InvalidParticle& invalid) const;
  // removed: text on all removed particles. fraction: of the mass. last: one of the particles removed last.
  [[nodiscard]] std::string of_removed(const std::string& removed, double fraction,
                                       const mpm::InvalidParticle& last) const;
  // Growth of energy [J], and as a fraction of all energy.
  [[nodiscard]] std::string of_energy(double energy, double fraction) const;

 private:
  [[nodiscard]] std::string fault_text(std::size_t p, mpm::Fault fault) const;
  [[nodiscard]] std::string likely_cause(std::size_t p, mpm::Fault fault) const;
  [[nodiscard]] std::string terrain_ahead(std::size_t p, mpm::Fault fault) const;
  [[nodiscard]] std::string cause_in_material(std::size_t p) const;
  [[nodiscard]] std::string step_to_halve() const;
  [[nodiscard]] bool is_too_soft(std::size_t p) const;

  const Setup<Dim>& setup_;
  const Slide<Dim>& slide_;
  const mpm::Particles<Dim>& particles_;
  band::BodySums<Dim> sums_;
};

}  // namespace thawslide::sim
