// A case without mistakes, and the messages it gives once a mistake is put in.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../support/case_from_text.hpp"
#include "base/error.hpp"

namespace thawslide::config {

// Line numbers in the tests count from [time].
inline const std::string sound = R"([time]
end = 2.0
step = 0.001
[grid]
cell = 5.0
min = [0.0, -10.0]
max = [100.0, 50.0]
[terrain]
type = "flat"
elevation = 0.0
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
[body.block]
material = "rock"
shape = "box"
min = [0.0, 0.0]
max = [40.0, 20.0]
[basal]
friction_angle = 20.0
)";

// The folder the case of this test lies in.
inline std::filesystem::path case_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::path(testing::TempDir()) / (std::string(test->test_suite_name()) + "." + test->name());
}

inline void write_input(const std::string& name, const std::string& text) {
  std::filesystem::create_directories((case_folder() / name).parent_path());
  std::ofstream(case_folder() / name, std::ios::binary) << text;
}

// The text with one piece replaced, which must be there once.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << "'" << from << "' is not in the case";
  EXPECT_EQ(text.find(from, place + 1), std::string::npos) << "'" << from << "' is twice in the case";
  return text.replace(place, from.size(), to);
}

// What the reader says of a case, with the folder's path left out.
inline std::string message_of_text(const std::string& text, const std::vector<std::string>& sets = {}) {
  std::string message = "no error";
  try {
    testing_support::case_from_text(text, sets);
  } catch (const UserError& error) {
    message = error.what();
  }
  const std::string folder = case_folder().string() + "/";
  for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
    message.erase(at, folder.size());
  }
  return message;
}

inline std::string message_of(const std::string& from, const std::string& to,
                              const std::vector<std::string>& sets = {}) {
  return message_of_text(replaced(sound, from, to), sets);
}

inline std::string message_of_sets(const std::vector<std::string>& sets) { return message_of_text(sound, sets); }

}  // namespace thawslide::config
