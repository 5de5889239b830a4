// State of a run stored in checkpoints in addition to its particles, and its restoration.
#include "base/instances.hpp"
#include "base/state_numbers.hpp"
#include "sim/setup/restored_state.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
std::vector<double> Simulation<Dim>::scalars() const {
  const auto* columns = band_columns();
  std::vector<double> numbers{clock_.time,
                              clock_.last_step,
                              static_cast<double>(clock_.step_number),
                              static_cast<double>(slide_->next_id),
                              static_cast<double>(slide_->split_count),
                              columns != nullptr ? columns->time_since_step() : 0.0,
                              clock_.fixed.step,
                              clock_.fixed.from_time,
                              static_cast<double>(clock_.fixed.from_number)};
  Budget<Dim> budget = budget_;
  budget.for_each([&](const double& term) { numbers.push_back(term); });
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
  clock_.time = state.next_finite();
  clock_.last_step = state.next_finite();
  clock_.step_number = state.whole(largest_whole);
  slide_->next_id = state.whole(largest_whole);
  slide_->split_count = state.whole(slide_->next_id);
  if (const double since_step = state.next_finite(); base_.columns) {
    base_.columns->set_time_since_step(since_step);
  }
  clock_.fixed.step = state.next_finite();
  clock_.fixed.from_time = state.next_finite();
  clock_.fixed.from_number = state.whole(clock_.step_number);
  budget_.for_each([&](double& term) { term = state.next(); });
  monitor_.for_each([&](double& number) { number = state.next(); });
  bodies_at_start_.resize(setup_.model.body_names.size());
  for (BodyAtStart& body : bodies_at_start_) {
    body.for_each([&](double& number) { number = state.next(); });
  }
  for (std::int64_t* count : {&removed_.left, &removed_.not_finite, &removed_.volume}) {
    *count = state.whole(largest_whole);
  }
  require_sound(slide_->particles, setup_.model, slide_->next_id, state);
  // Rows are sorted by id after a restart, so the former order is invalid.
  slide_->grid = make_grid(setup_.parameters, setup_.model);
  mpm::Particles<Dim>& particles = slide_->particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.previous_temperature(p) = particles.temperature(p);
  }
  slide_->are_located = false;
  left_text_.clear();
  cpu_.find_cells();
  if (setup_.is_adaptive() && monitor_.first_step == 0.0) {
    monitor_.first_step = adaptive_step();  // steps were fixed so far
  }
}

#define THAWSLIDE_INSTANTIATE(Dim)                               \
  template std::vector<double> Simulation<Dim>::scalars() const; \
  template void Simulation<Dim>::restore(const std::vector<double>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
