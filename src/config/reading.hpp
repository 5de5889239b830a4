// State while reading a case file: locations of keys, problems found, and command-line overrides.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/case.hpp"
#include "config/problems.hpp"
#include "config/rule.hpp"
#include "config/toml.hpp"

namespace thawslide::config {

struct Reading {
  std::string file;              // as named by the user, for messages
  std::filesystem::path folder;  // of the case file, absolute
  std::vector<Override> overrides;
  int dimension = 2;  // of the case; 0 while unknown
  Problems problems;
  std::vector<std::string> notes;             // changes that reading made
  std::map<std::string, Location> locations;  // of each given table and key, by dotted name
  std::set<std::string> invalid_keys;         // dotted keys that are missing or invalid

  // The last `--set` that specifies the key or a table around it; nullptr if a case file specifies it.
  [[nodiscard]] const Override* override_of(const std::string& dotted, const toml::source_region& region) const;
  // Location of a node of the key, or of the `--set` that specified it.
  [[nodiscard]] Location location_of(const std::string& dotted, const toml::source_region& region) const;
  // Location of a key or, if it is not given, of its table or of the file.
  [[nodiscard]] Location location_of(const std::string& dotted) const;

  [[nodiscard]] bool is_given(const std::string& dotted) const { return locations.count(dotted) > 0; }
  // True if none of the keys has a problem, so that checks involving them are meaningful.
  [[nodiscard]] bool are_valid(std::initializer_list<std::string> dotted) const;
  // Location of the first of these keys that is set by `--set`, because the case file is probably consistent without
  // it; otherwise of the first key.
  [[nodiscard]] Location location_of_misfit(std::initializer_list<std::string> dotted) const;
  // Adds a problem at a location, and marks a key as invalid.
  template <class... Args>
  void report_at(Location location, const std::string& dotted, fmt::format_string<Args...> message, Args&&... args) {
    problems.add(std::move(location), fmt::format(message, std::forward<Args>(args)...));
    invalid_keys.insert(dotted);
  }
  // Adds a problem of one or several keys, and marks the first one as invalid.
  template <class... Args>
  void report(std::initializer_list<std::string> dotted, fmt::format_string<Args...> message, Args&&... args) {
    report_at(location_of_misfit(dotted), *dotted.begin(), message, std::forward<Args>(args)...);
  }
  // The same for keys that do not fit each other, unless one of them has a problem already.
  template <class... Args>
  void refuse_if(bool is_misfit, std::initializer_list<std::string> dotted, fmt::format_string<Args...> message,
                 Args&&... args) {
    if (is_misfit && are_valid(dotted)) {
      report(dotted, message, std::forward<Args>(args)...);
    }
  }
};

// Reads one value of one key and reports problems. All functions return true if the value is valid.
struct ValueReader {
  Reading& reading;
  std::string key;  // dotted
  const Rule& rule;
  std::string default_text;  // empty: none
  std::string allowed;       // type, range and unit as text

  // Adds "key message" at the node's location.
  template <class... Args>
  bool fail(const toml::node& node, fmt::format_string<Args...> message, Args&&... args) const {
    const std::string remedy =
        default_text.empty() ? "" : fmt::format(" Correct it, or leave it out for the default {}.", default_text);
    reading.report_at(reading.location_of(key, node.source()), key, "{} {}.{}", key,
                      fmt::format(message, std::forward<Args>(args)...), remedy);
    return false;
  }
  // Reports the value found, the values allowed and the remedy.
  bool fail_type(const toml::node& node) const;
  // A finite number.
  bool finite_number(const toml::node& node, double& value) const;
  // A number in the range of the rule.
  bool number_in_range(const toml::node& node, double& value) const;
  // Array of numbers; `in_range`: each must be in the range of the rule.
  bool numbers(const toml::node& node, std::vector<double>& values, bool in_range) const;
  // File path, which becomes absolute; in a case file, it must lie in its folder. `form`: of the path in a value.
  bool resolve_path(const toml::node& node, std::string& path, const std::string& form = "PATH") const;
};

// Short description of a node: `the text "long"`, `-3`, `an array of 2`.
std::string describe_node(const toml::node& node);

}  // namespace thawslide::config
