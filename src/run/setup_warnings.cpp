#include "run/setup_warnings.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "config/notices.hpp"
#include "config/reported_values.hpp"
#include "sim/bodies_apart.hpp"
#include "sim/body_warnings.hpp"
#include "sim/map_grid.hpp"
#include "sim/unresolved_terrain.hpp"

namespace thawslide::run {

template <int Dim>
void add_setup_warnings(const sim::Simulation<Dim>& simulation, const std::vector<sim::BodyFigures>& bodies,
                        Warnings& warnings) {
  const config::Case& parameters = simulation.parameters();
  warnings.add(sim::warning_of_map_cell(parameters, simulation.site()));
  warnings.add(config::notices(parameters));
  warnings.add(config::warning_of_late_values(parameters));
  warnings.add(sim::body_warnings(parameters, bodies));
  warnings.add(sim::warning_of_bodies_apart(simulation));
  warnings.add(sim::warnings_of_unresolved_terrain(simulation, bodies));
}

template <int Dim>
double steps_to_end(sim::Simulation<Dim>& simulation) {
  const config::Time& time = simulation.parameters().time;
  const double steps = time.end / simulation.next_step(time.end) * (1.0 - 1e-12);
  // Fixed steps may end the run up to half a step early; adaptive steps are cut to end exactly.
  return time.stepping == config::Stepping::fixed ? std::max(1.0, std::ceil(steps - 0.5)) : std::ceil(steps);
}

template <int Dim>
double measured_step_seconds(sim::Simulation<Dim>& simulation) {
  constexpr double most_seconds = 0.5;
  constexpr int most_steps = 200;
  const auto start = std::chrono::steady_clock::now();
  double elapsed = 0.0;
  int steps = 0;
  while (steps < most_steps && elapsed < most_seconds && simulation.time() < simulation.parameters().time.end) {
    simulation.step(simulation.next_step(simulation.parameters().time.end));
    ++steps;
    elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return elapsed / steps;
}

template void add_setup_warnings<2>(const sim::Simulation<2>&, const std::vector<sim::BodyFigures>&, Warnings&);
template void add_setup_warnings<3>(const sim::Simulation<3>&, const std::vector<sim::BodyFigures>&, Warnings&);
template double steps_to_end<2>(sim::Simulation<2>&);
template double steps_to_end<3>(sim::Simulation<3>&);
template double measured_step_seconds<2>(sim::Simulation<2>&);
template double measured_step_seconds<3>(sim::Simulation<3>&);

}  // namespace thawslide::run
