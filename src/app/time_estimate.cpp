#include "app/time_estimate.hpp"

#include <chrono>

namespace thawslide::app {

namespace {

constexpr double trial_seconds = 0.5;  // of wall time, to measure the step
constexpr int trial_steps = 200;

}  // namespace

template <int Dim>
double measured_step_seconds(sim::Simulation<Dim, double>& simulation) {
  const auto start = std::chrono::steady_clock::now();
  double elapsed = 0.0;
  int steps = 0;
  while (steps < trial_steps && elapsed < trial_seconds && simulation.time() < simulation.parameters().time.end) {
    simulation.step(simulation.next_step(simulation.parameters().time.end));
    ++steps;
    elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return elapsed / steps;
}

template double measured_step_seconds<2>(sim::Simulation<2, double>&);
template double measured_step_seconds<3>(sim::Simulation<3, double>&);

}  // namespace thawslide::app
