// Case from TOML text, as written by a user.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/read_case.hpp"

namespace thawslide::testing_support {

// Temporary folder of the running test; created if it does not exist.
std::filesystem::path folder_of_this_test();

config::Case case_from_text(const std::string& text, const std::vector<std::string>& sets = {});

// As case_from_text, with the published formulation for each key that neither `text` nor `sets` gives, for tests of the
// published equations and results.
config::Case paper_case(const std::string& text, std::vector<std::string> sets = {});

// Advances the simulation until `end`.
template <class Simulation>
void run_until(Simulation& simulation, double end) {
  while (simulation.time() < end * (1.0 - 1e-12)) {
    simulation.step(simulation.next_step(end));
  }
}

// One entry of a history row.
template <class Row>
double value_of(const Row& row, const std::string& name) {
  for (const auto& [key, value] : row) {
    if (key == name) {
      return value;
    }
  }
  throw std::logic_error("no column " + name);
}

}  // namespace thawslide::testing_support
