// A case from TOML text, as a user would write it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "config/read_case.hpp"

namespace thawslide::testing_support {

// A temporary folder of the running test; made if it is not there.
inline std::filesystem::path folder_of_this_test() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::create_directories(folder);
  return folder;
}

inline config::Case case_from_text(const std::string& text, const std::vector<std::string>& sets = {}) {
  const std::filesystem::path folder = folder_of_this_test();
  std::ofstream(folder / "case.toml") << text;
  return config::read_case(folder, sets);
}

// Steps until `end`.
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
