// Warnings during a run: a base too hot to be physically credible, removed particles, and energy without a cause.
#pragma once

#include <string>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::run {

// All warnings during a run, as lines, each at its first occasion.
class StepWarnings {
 public:
  // before: state before this part of the run.
  template <int Dim>
  explicit StepWarnings(const sim::Simulation<Dim>& before)
      : has_reported_removal_(before.removed().by_guards() > 0),
        has_reported_splitting_(!before.split_warning().empty()) {}

  // New warnings after a step.
  template <int Dim>
  [[nodiscard]] std::vector<std::string> after_step(const sim::Simulation<Dim>& simulation) {
    std::vector<std::string> found;
    report_once(found, has_reported_removal_,
                [&] { return warning_of_removal(simulation.time(), simulation.removed()); });
    report_once(found, has_reported_splitting_, [&] { return simulation.split_warning(); });
    report_once(found, has_reported_energy_, [&] { return simulation.energy_warning(); });
    return found;
  }
  // New warnings at the time of a snapshot: water would boil but does not, or columns are hot or have boiled dry.
  template <int Dim>
  [[nodiscard]] std::vector<std::string> after_snapshot(const sim::Simulation<Dim>& simulation) {
    std::vector<std::string> found;
    report_once(found, has_reported_dry_, [&] { return warning_of_dry(simulation); });
    has_reported_heat_ = has_reported_heat_ || has_reported_dry_;
    report_once(found, has_reported_heat_, [&] { return warning_of_heat(simulation); });
    return found;
  }

 private:
  template <class Warning>
  static void report_once(std::vector<std::string>& found, bool& has_reported, const Warning& warning) {
    if (const std::string text = has_reported ? "" : warning(); !text.empty()) {
      has_reported = true;
      found.push_back(text);
    }
  }
  template <int Dim>
  static std::string warning_of_dry(const sim::Simulation<Dim>& simulation);
  template <int Dim>
  static std::string warning_of_heat(const sim::Simulation<Dim>& simulation);
  static std::string warning_of_removal(double time, const sim::Removed& removed);

  bool has_reported_removal_, has_reported_splitting_;
  bool has_reported_energy_ = false, has_reported_dry_ = false, has_reported_heat_ = false;
};

}  // namespace thawslide::run
