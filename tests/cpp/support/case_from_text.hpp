// A case from TOML text, as a user would write it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "config/moved_defaults.hpp"
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

// As case_from_text, with the forms of the paper for each key that neither `text` nor `sets` gives: what tests of its
// equations, and of the numbers it gives, are of.
inline config::Case paper_case(const std::string& text, std::vector<std::string> sets = {}) {
  const auto gives = [&](const std::string& key) {
    const std::regex line("(^|\\n|\\.)" + key + "\\s*=");
    return std::regex_search(text, line) ||
           std::any_of(sets.begin(), sets.end(), [&](const std::string& set) { return std::regex_search(set, line); });
  };
  std::vector<std::string> of_the_paper;
  for (const config::MovedDefault& moved : config::moved_defaults()) {
    if (gives(moved.key)) {
      continue;
    }
    if (moved.table != "material.NAME") {
      of_the_paper.push_back(moved.table + "." + moved.key + "=" + moved.before);
      continue;
    }
    const std::regex title("\\[(material\\.\\w+)\\]");
    for (std::sregex_iterator found(text.begin(), text.end(), title), end; found != end; ++found) {
      of_the_paper.push_back((*found)[1].str() + "." + moved.key + "=" + moved.before);
    }
  }
  sets.insert(sets.end(), of_the_paper.begin(), of_the_paper.end());
  return case_from_text(text, sets);
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
