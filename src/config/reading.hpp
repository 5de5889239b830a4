// The state of one reading of a case file: places of keys, problems found, and what stands on the command line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/problems.hpp"
#include "config/rule.hpp"
#include "config/toml.hpp"

namespace thawslide::config {

// One `--set key=value`: value is the text of a TOML value, or a bare word, which stands for a text.
struct Override {
  std::string key;
  std::string value;
};

struct Reading {
  std::string file;              // as the user named it, for messages
  std::filesystem::path folder;  // of the case file, absolute
  std::vector<Override> overrides;
  int dimension = 2;  // of the case; 0 while not known
  Problems problems;
  std::map<std::string, Place> places;  // of each given table and key, by dotted name
  std::set<std::string> unsound;        // dotted keys that are missing, or hold what they must not

  // The place of a node of the key, or of the `--set` that gave it.
  [[nodiscard]] Place place_of(const std::string& dotted, const toml::source_region& region) const;
  // The place of a key or, if it was not given, of the table around it or the file.
  [[nodiscard]] Place place_of(const std::string& dotted) const;

  [[nodiscard]] bool given(const std::string& dotted) const { return places.count(dotted) > 0; }
  // None of the keys has a problem: a check over them makes sense.
  [[nodiscard]] bool sound(std::initializer_list<std::string> dotted) const;
  // A problem at the place of a key; marks the key as unsound.
  void report(const std::string& dotted, std::string message);
  // A problem that keys make together, told at the first of them that `--set` gave: most likely the case file fits
  // together without it. Else at the first key, which is marked as unsound in either case.
  void report_misfit(std::initializer_list<std::string> dotted, std::string message);
};

// Reads one value of one key, and says what is wrong with it. All functions return whether the value is right.
struct ValueReader {
  Reading& reading;
  std::string key;  // dotted
  const Rule& rule;
  std::string default_text;  // empty: none
  std::string allowed;       // type, range and unit in words

  // Adds "key: message" at the node's place.
  bool fail(const toml::node& node, const std::string& message) const;
  // Says what was found, what is allowed and what to do.
  bool fail_type(const toml::node& node) const;
  // A finite number.
  bool finite_number(const toml::node& node, double& value) const;
  // A number in the range of the rule.
  bool number_in_range(const toml::node& node, double& value) const;
  // Numbers in an array; `in_range`: each must be in the range of the rule.
  bool numbers(const toml::node& node, std::vector<double>& values, bool in_range) const;
  // A file: inside the case's folder when the case file names it. The path becomes absolute. `form` is how a value of
  // the key gives a path.
  bool resolve_path(const toml::node& node, std::string& path, const std::string& form = "PATH") const;
};

// What a node holds, in a few words: `the text "long"`, `-3`, `an array of 2`.
std::string describe_node(const toml::node& node);

}  // namespace thawslide::config
