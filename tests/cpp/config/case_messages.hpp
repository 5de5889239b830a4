// A valid case and the messages for modified ones. Shared by the tests of the case file.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../support/case_from_text.hpp"
#include "base/error.hpp"

namespace thawslide::config::case_messages {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// TOML from lines "[table] key = value | key = value"; " |" at the end of a line continues it.
inline std::string one_key_per_line(std::string text) {
  text = "\n" + replaced(replaced(std::move(text), " |\n  ", "\n"), " | ", "\n");
  for (std::size_t at = text.find("\n["); at != std::string::npos; at = text.find("\n[", at + 1)) {
    const std::size_t end = text.find_first_of("\n", at + 1), title = text.find("] ", at);
    if (title < end) {
      text.replace(title, 2, "]\n");
    }
  }
  return text.substr(text.rfind("\n\n", 0) == 0 ? 2 : 1);
}

// In messages, line numbers count the keys and tables of these cases, from [time] and from [case].
inline const std::string valid_case = one_key_per_line(R"(
[time] end = 2.0 | step = 0.001
[grid] cell = 5.0 | min = [0.0, -10.0] | max = [100.0, 50.0]
[terrain] type = "flat" | elevation = 0.0
[material.rock] law = "elastic" | youngs_modulus = 5e8 | poisson_ratio = 0.2
[body.block] material = "rock" | shape = "box" | min = [0.0, 0.0] | max = [40.0, 20.0]
[basal] friction_angle = 20.0
)");

// A valid case of a release on a DEM; write_map_files writes its files to the same folder.
inline const std::string valid_case_on_dem = one_key_per_line(R"(
[case] dimension = 3
[time] end = 2.0 | step = 0.001
[grid] cell = 5.0 | min = [0.0, 0.0, 0.0] | max = [100.0, 50.0, 50.0]
[terrain] type = "dem" | file = "dem.tif"
[material.rock] law = "elastic" | youngs_modulus = 5e8 | poisson_ratio = 0.2
[body.slide] material = "rock" | shape = "release" | release = "release.geojson" | thickness = 10.0
[basal] friction_angle = 20.0
)");

using Change = std::pair<std::string, std::string>;  // text of the case and its replacement

inline std::string changed(const std::vector<Change>& changes, std::string text = valid_case) {
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) {
      throw std::logic_error("the case has no text " + from);
    }
    text.replace(at, from.size(), to);
  }
  return text;
}

using testing_support::folder_of_this_test;

inline void write_next_to_the_case(const std::string& name, const std::string& text) {
  const std::filesystem::path file = folder_of_this_test() / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

// Values of a resolved case, without the marks of keys that were not given.
inline std::string without_marks(const std::string& resolved) {
  return replaced(replaced(resolved, "  # not given", ""), ", not given", "");
}

inline std::string without_folder(const std::string& message) {
  return replaced(message, folder_of_this_test().string(), "FOLDER");
}

// Maps are opened when a run begins. For the case file it is sufficient that they exist.
inline void write_map_files() {
  for (const char* name : {"dem.tif", "release.geojson", "map.tif", "line.geojson"}) {
    write_next_to_the_case(name, "");
  }
}

// Complete error that `read` throws, with the folder of this test replaced by FOLDER.
template <class Read>
std::string error_of(const Read& read) {
  std::string message = "no error";
  try {
    static_cast<void>(read());
  } catch (const UserError& error) {
    message = error.what();
  }
  return without_folder(message);
}

// Complete error of a case text.
inline std::string error_of_text(const std::string& text, const std::vector<std::string>& sets = {}) {
  return error_of([&] { testing_support::case_from_text(text, sets); });
}

inline std::string error_of_changed(const std::vector<Change>& changes, const std::vector<std::string>& sets = {}) {
  return error_of_text(changed(changes), sets);
}

}  // namespace thawslide::config::case_messages
