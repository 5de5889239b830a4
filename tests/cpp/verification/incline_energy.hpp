// Residual of the mechanical energy budget of the paper's four cases on the incline of 40 degrees (Sec. 3.3).
#pragma once

#include "verification.hpp"

namespace thawslide::verification {

// mechanical_residual_J at `end` relative to the work of gravity and |friction work|.
inline double incline_residual(const std::string& name, double step, double end) {
  using testing_support::value_of;
  const std::string file = std::string(THAWSLIDE_SOURCE_DIR "/cases/incline/") + name + ".toml";
  Simulation<2> simulation(
      config::read_case(file, {fmt::format("time.step={}", step), fmt::format("time.end={}", end)}));
  const double potential = value_of(sim::history_row(simulation), "potential_J");
  testing_support::run_until(simulation, end);
  const auto row = sim::history_row(simulation);
  const double work = potential - value_of(row, "potential_J") + std::abs(value_of(row, "friction_work_J"));
  return value_of(row, "mechanical_residual_J") / work;
}

// Runs D, DL, DLP and PL with three steps each; asserts a residual below 1 % that falls in first order of the step.
inline void expect_closed_budget(Record& record, double end, double allowed) {
  const std::vector<double> steps{0.0035, 0.00175, 0.000875};
  for (const std::string name : {"D", "DL", "DLP", "PL"}) {
    std::vector<double> residuals;
    for (const double step : steps) {
      residuals.push_back(std::abs(incline_residual(name, step, end)));
      EXPECT_LT(residuals.back(), 0.01) << name << ", step " << step << " s";
    }
    record.expect_order("step [s]", steps, name + ": residual over work", residuals, 1.0, allowed);
  }
}

}  // namespace thawslide::verification
