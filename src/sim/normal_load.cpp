// The normal load N on particles: what the column above presses on the ground with.
#include <algorithm>

#include "base/instances.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Of the particles that stand in memory from `first` on.
template <int Dim, class Real>
void Simulation<Dim, Real>::update_normal_load(std::size_t first) {
  if (!model_.band.pressure || !model_.band.needs_normal_load()) {
    return;
  }
  const Vector<double, Dim> gravity = model_.motion.gravity.template cast<double>();
  const auto normal_gravity = [&](const Vector<Real, Dim - 1>& place) {
    if (!model_.ground) {
      return static_cast<Real>(-gravity[Dim - 1]);
    }
    const auto normal = model_.ground->normal_below(place.template cast<double>(), parameters_.grid.cell);
    return static_cast<Real>(std::max(0.0, gravity.dot(normal)) * -normal[Dim - 1]);
  };
  flow_depth_.load_to_particles(grid_, normal_gravity, particles_, first);
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) template void Simulation<Dim, Real>::update_normal_load(std::size_t);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
