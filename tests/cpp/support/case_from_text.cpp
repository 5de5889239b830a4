#include "case_from_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>

namespace thawslide::testing_support {

namespace {

// Keys whose defaults are not the published formulations, with the value of the paper.
const struct {
  std::string table, key, published;
} paper_values[] = {{"band", "model", "\"scaled\""},
                    {"band", "thickness_change", "\"as_published\""},
                    {"heat", "advection_form", "\"as_published\""},
                    {"pressure", "frozen", "\"ice_pressure\""},
                    {"pressure", "frozen_rows", "\"draining\""},
                    {"pressure", "melt_contraction", "false"},
                    {"pressure", "skeleton_compressibility", "0.0"},
                    {"phases", "water_expansion_law", "\"constant\""},
                    {"material.NAME", "gaps_close_first", "false"},
                    {"block", "bends", "false"}};

}  // namespace

std::filesystem::path folder_of_this_test() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::create_directories(folder);
  return folder;
}

config::Case case_from_text(const std::string& text, const std::vector<std::string>& sets) {
  const std::filesystem::path folder = folder_of_this_test();
  std::ofstream(folder / "case.toml") << text;
  return config::read_case(folder, sets);
}

config::Case paper_case(const std::string& text, std::vector<std::string> sets) {
  const auto gives = [&](const std::string& key) {
    const std::regex line("(^|\\n|\\.)" + key + "\\s*=");
    return std::regex_search(text, line) ||
           std::any_of(sets.begin(), sets.end(), [&](const std::string& set) { return std::regex_search(set, line); });
  };
  std::set<std::string> materials;
  const std::regex name("material\\.\\w+");
  const auto add_materials = [&](const std::string& part) {
    for (std::sregex_iterator found(part.begin(), part.end(), name), end; found != end; ++found) {
      materials.insert(found->str());
    }
  };
  add_materials(text);
  std::for_each(sets.begin(), sets.end(), add_materials);
  std::vector<std::string> of_the_paper;
  for (const auto& [table, key, published] : paper_values) {
    if (gives(key)) {
      continue;
    }
    for (const std::string& each : table == "material.NAME" ? materials : std::set<std::string>{table}) {
      of_the_paper.push_back(each + "." + key + "=" + published);
    }
  }
  sets.insert(sets.end(), of_the_paper.begin(), of_the_paper.end());
  return case_from_text(text, sets);
}

}  // namespace thawslide::testing_support
