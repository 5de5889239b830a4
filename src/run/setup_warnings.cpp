#include "run/setup_warnings.hpp"

#include "config/notices.hpp"
#include "config/reported_values.hpp"
#include "sim/checks/bodies_apart.hpp"
#include "sim/checks/body_warnings.hpp"
#include "sim/checks/unresolved_terrain.hpp"
#include "sim/maps/map_grid.hpp"
#include "sim/setup/domain_bottom.hpp"

namespace thawslide::run {

template <int Dim>
void add_setup_warnings(const sim::Simulation<Dim>& simulation, const std::vector<sim::BodyFigures>& bodies,
                        Warnings& warnings) {
  const config::Case& parameters = simulation.parameters();
  warnings.add(sim::warning_of_map_cell(parameters, simulation.site()));
  warnings.add(config::notices(parameters));
  warnings.add(config::warning_of_late_values(parameters));
  warnings.add(sim::note_of_bottom(parameters, simulation.site()));
  warnings.add(sim::body_warnings(parameters, bodies));
  warnings.add(sim::warning_of_bodies_apart(simulation));
  warnings.add(sim::warnings_of_unresolved_terrain(simulation, bodies));
}

template void add_setup_warnings<2>(const sim::Simulation<2>&, const std::vector<sim::BodyFigures>&, Warnings&);
template void add_setup_warnings<3>(const sim::Simulation<3>&, const std::vector<sim::BodyFigures>&, Warnings&);

}  // namespace thawslide::run
