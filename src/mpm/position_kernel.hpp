// Particle kernel (mpm/kernel.hpp) of update_positions.
#pragma once

#include <cmath>
#include <limits>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/kernel.hpp"
#include "mpm/kernel_totals.hpp"

namespace thawslide::mpm {

// Applies the displacement of the step, except to particles that are not finite or would leave [lower, upper]; records
// these.
template <int Dim>
struct UpdatePosition {
  using Reads = RecordList<>;
  using Adds = RecordList<>;
  using Totals = InvalidParticle;

  Vector<double, Dim> lower, upper;  // [m]

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& /*added*/, Totals& invalid) const {
    using std::abs, std::sqrt, thawslide::select;
    using Value = typename At::Value;
    using VectorOfValues = Vector<Value, Dim>;
    VectorOfValues step = particles.step_displacement.template load_vector<Dim>(at);
    const VectorOfValues old = particles.position.template load_vector<Dim>(at);
    // NaN fails all comparisons.
    const Value state = particles.temperature.load(at) + particles.pore_pressure.load(at) + particles.stress.load(at);
    auto well = abs(state) <= Value(std::numeric_limits<double>::max());
    for (int a = 0; a < Dim; ++a) {
      well = well & (old[a] + step[a] >= lower[a]) & (old[a] + step[a] <= upper[a]);
    }
    if (any(!well)) {
      for_each_lane(!well, [&](std::size_t lane) { record_fault(particles, at.particle[lane], invalid); });
      for (int a = 0; a < Dim; ++a) {
        step[a] = select(well, step[a], Value(0.0));
      }
    }
    particles.position.store_vector(at, VectorOfValues(old + step));
    particles.displacement.store_vector(at,
                                        VectorOfValues(particles.displacement.template load_vector<Dim>(at) + step));
    particles.path_length.store(at, particles.path_length.load(at) + sqrt(step.squaredNorm()));
  }

 private:
  // Records the fault of an invalid particle.
  template <class Particles>
  THAWSLIDE_HD static void record_fault(const Particles& particles, std::uint32_t p, InvalidParticle& invalid) {
    bool finite = std::isfinite(particles.temperature(p)) && std::isfinite(particles.pore_pressure(p)) &&
                  std::isfinite(particles.stress(p, 0));
    for (int a = 0; a < Dim; ++a) {
      finite = finite && std::isfinite(particles.position(p, a) + particles.step_displacement(p, a));
    }
    invalid.record(particles.id(p), finite ? Fault::left_domain : Fault::state_not_finite);
  }
};

}  // namespace thawslide::mpm
