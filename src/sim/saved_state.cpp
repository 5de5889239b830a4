// State of a run stored in checkpoints in addition to its particles, and its restoration.
#include "base/instances.hpp"
#include "base/state_numbers.hpp"
#include "sim/restored_state.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
std::vector<double> Simulation<Dim>::scalars() const {
  std::vector<double> numbers{time_,
                              last_step_,
                              static_cast<double>(step_number_),
                              static_cast<double>(next_id_),
                              static_cast<double>(split_count_),
                              column_time_,
                              fixed_step_clock_.step,
                              fixed_step_clock_.from_time,
                              static_cast<double>(fixed_step_clock_.from_number)};
  Budget<Dim> budget = budget_;
  budget.for_each([&](const Real& term) { numbers.push_back(static_cast<double>(term)); });
  RunMonitor monitor = monitor_;
  monitor.for_each([&](double number) { numbers.push_back(number); });
  for (BodyAtStart body : bodies_at_start_) {
    body.for_each([&](double number) { numbers.push_back(number); });
  }
  for (const std::int64_t count : {removed_.left, removed_.not_finite, removed_.volume}) {
    numbers.push_back(static_cast<double>(count));
  }
  return numbers;
}

template <int Dim>
void Simulation<Dim>::restore(const std::vector<double>& scalars) {
  StateNumbers state(scalars, "run");
  time_ = state.next_finite();
  last_step_ = state.next_finite();
  step_number_ = state.whole(largest_whole);
  next_id_ = state.whole(largest_whole);
  split_count_ = state.whole(next_id_);
  column_time_ = state.next_finite();
  fixed_step_clock_.step = state.next_finite();
  fixed_step_clock_.from_time = state.next_finite();
  fixed_step_clock_.from_number = state.whole(step_number_);
  budget_.for_each([&](Real& term) { term = static_cast<Real>(state.next()); });
  monitor_.for_each([&](double& number) { number = state.next(); });
  bodies_at_start_.resize(model_.body_names.size());
  for (BodyAtStart& body : bodies_at_start_) {
    body.for_each([&](double& number) { number = state.next(); });
  }
  for (std::int64_t* count : {&removed_.left, &removed_.not_finite, &removed_.volume}) {
    *count = state.whole(largest_whole);
  }
  require_sound(particles_, model_, next_id_, state);
  // Rows are sorted by id after a restart, so the former order is invalid.
  grid_ = make_grid(parameters_, model_);
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    particles_.previous_temperature(p) = particles_.temperature(p);
  }
  are_particles_located_ = false;
  find_particles_cells();
  if (parameters_.time.stepping == config::Stepping::adaptive && monitor_.first_step == 0.0) {
    monitor_.first_step = adaptive_step();  // steps were fixed so far
  }
}

#define THAWSLIDE_INSTANTIATE(Dim)                               \
  template std::vector<double> Simulation<Dim>::scalars() const; \
  template void Simulation<Dim>::restore(const std::vector<double>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
