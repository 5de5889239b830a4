// Warnings during a run: a base too hot to be physically credible, removed particles, and energy without a cause.
#pragma once

#include <string>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::run {

// Reports that water would boil but does not, that band columns are hot or have boiled dry, and each time that the base
// passes a higher limit of temperature.
class BoilingWatch {
 public:
  // Returns a new warning; empty if there is none.
  template <int Dim>
  std::string warning(const sim::Simulation<Dim>& simulation);

 private:
  bool is_dry_ = false;        // already reported
  double passed_limit_ = 0.0;  // highest limit already reported [C]
};

// All warnings during a run, as lines.
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
    const auto report_once = [&](bool& has_reported, const auto& warning) {
      if (const std::string text = has_reported ? "" : warning(); !text.empty()) {
        has_reported = true;
        found.push_back(text);
      }
    };
    report_once(has_reported_removal_, [&] { return warning_of_removal(simulation.time(), simulation.removed()); });
    report_once(has_reported_splitting_, [&] { return simulation.split_warning(); });
    report_once(has_reported_energy_, [&] { return simulation.energy_warning(); });
    return found;
  }
  // New warnings at the time of a snapshot.
  template <int Dim>
  [[nodiscard]] std::vector<std::string> after_snapshot(const sim::Simulation<Dim>& simulation) {
    const std::string warning = boiling_.warning<Dim>(simulation);
    return warning.empty() ? std::vector<std::string>() : std::vector<std::string>{warning};
  }

 private:
  static std::string warning_of_removal(double time, const sim::Removed& removed);

  BoilingWatch boiling_;
  bool has_reported_removal_, has_reported_splitting_, has_reported_energy_ = false;
};

}  // namespace thawslide::run
