// Normal load N on particles: weight of the column above, normal to the ground.
#include "base/instances.hpp"
#include "sim/simulation.hpp"
#include "sim/terrain_at_columns.hpp"

namespace thawslide::sim {

// Updates particles from memory index `first` on.
template <int Dim>
void Simulation<Dim>::update_normal_load(std::size_t first) {
  if (!model_.band.pressure || !model_.band.needs_normal_load()) {
    return;
  }
  flow_depth_.load_to_particles(grid_, normal_gravity_of(model_, parameters_.grid.cell), particles_, first);
}

#define THAWSLIDE_INSTANTIATE(Dim) template void Simulation<Dim>::update_normal_load(std::size_t);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
