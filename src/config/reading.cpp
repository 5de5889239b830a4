#include "config/reading.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "config/input_limits.hpp"

namespace thawslide::config {

namespace {

// True if both dotted names are equal, or the outer one is a table around the inner one.
bool within(const std::string& inner, const std::string& outer) {
  return inner == outer ||
         (inner.size() > outer.size() && inner.compare(0, outer.size(), outer) == 0 && inner[outer.size()] == '.');
}

// Probable unit of a number out of its range.
std::string likely_unit(const Rule& rule, double found) {
  constexpr double least_percent = 2.0, whole_in_percent = 100.0, coldest_in_kelvin = 150.0,
                   freezing_in_kelvin = 273.15;
  if (rule.unit == "C" && found > coldest_in_kelvin) {
    return fmt::format("; if it is in kelvin, it is {:g} C", found - freezing_in_kelvin);
  }
  if (rule.unit.empty() && rule.range.low >= 0.0 && rule.range.high <= 1.0 && found >= least_percent &&
      found <= whole_in_percent) {
    return fmt::format("; if it is in percent, it is {:g}", found / whole_in_percent);
  }
  return "";
}

// Suggestion for a missing file: one in its folder with the same ending, "; did you mean 'profile.csv'?"; or empty.
std::string similar_file(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  std::vector<std::string> stems = names_in(file.parent_path(), ending);
  for (std::string& name : stems) {
    name.resize(name.size() - ending.size());
  }
  const std::string found = nearest(file.stem().string(), stems);
  return found.empty() ? "" : fmt::format("; did you mean '{}{}'?", found, ending);
}

}  // namespace

const Override* Reading::override_of(const std::string& dotted, const toml::source_region& region) const {
  const auto found = std::find_if(overrides.rbegin(), overrides.rend(), [&dotted](const Override& override) {
    return within(dotted, override.key) || within(override.key, dotted);
  });
  return region.begin.line > 0 || found == overrides.rend() ? nullptr : &*found;
}

Location Reading::location_of(const std::string& dotted, const toml::source_region& region) const {
  if (region.begin.line > 0) {
    return {region.path ? *region.path : file, region.begin.line, region.begin.column, false};
  }
  const Override* override = override_of(dotted, region);
  return override == nullptr ? Location{file, 0, 0, false}
                             : Location{fmt::format("--set {}={}", override->key, override->value), 0, 0, true};
}

Location Reading::location_of(const std::string& dotted) const {
  for (std::string name = dotted; !name.empty();) {
    const auto found = locations.find(name);
    if (found != locations.end()) {
      return found->second;
    }
    const std::size_t dot = name.rfind('.');
    name.resize(dot == std::string::npos ? 0 : dot);
  }
  return {file, 0, 0, false};
}

bool Reading::are_valid(std::initializer_list<std::string> dotted) const {
  return std::none_of(dotted.begin(), dotted.end(), [this](const auto& key) { return invalid_keys.count(key) > 0; });
}

Location Reading::location_of_misfit(std::initializer_list<std::string> dotted) const {
  const auto* const set = std::find_if(dotted.begin(), dotted.end(), [this](const std::string& key) {
    const auto found = locations.find(key);
    return found != locations.end() && found->second.command_line;
  });
  return location_of(set == dotted.end() ? *dotted.begin() : *set);
}

std::string describe_node(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return fmt::format("the text \"{}\"", shown(text->get()));
  }
  if (const auto* number = node.as_floating_point()) {
    return number_text(number->get());
  }
  if (const auto* whole = node.as_integer()) {
    return fmt::format("{}", whole->get());
  }
  if (const auto* truth = node.as_boolean()) {
    return truth->get() ? "true" : "false";
  }
  if (const auto* array = node.as_array()) {
    return fmt::format("an array of {}", array->size());
  }
  return node.is_table() ? "a table" : "a date or time";
}

bool ValueReader::fail_type(const toml::node& node) const {
  std::string message = fmt::format("is {}; allowed: {}", describe_node(node), allowed);
  if (const auto* text = node.as_string(); text != nullptr && !text->get().empty()) {
    char* end = nullptr;
    const double value = std::strtod(text->get().c_str(), &end);
    if (*end == '\0' && rule.range.contains(value)) {
      message += reading.location_of(key, node.source()).command_line ? "; write " + plain_number(value)
                                                                      : std::string("; remove the quotes");
    }
    message += comma_advice(text->get());
  }
  return fail(node, "{}", message);
}

bool ValueReader::finite_number(const toml::node& node, double& value) const {
  if (!node.is_number()) {
    return fail_type(node);
  }
  const double found = *node.value<double>();
  if (!std::isfinite(found)) {
    return fail(node, "is {}; allowed: a finite number", plain_number(found));
  }
  value = found;
  return true;
}

bool ValueReader::number_in_range(const toml::node& node, double& value) const {
  if (!node.is_number()) {
    return fail_type(node);
  }
  const double found = *node.value<double>();
  if (!rule.range.contains(found)) {
    return fail(node, "is {}; allowed: {}{}{} ({}){}", plain_number(found), rule.range.text(),
                rule.unit.empty() ? "" : " ", rule.unit, rule.text, likely_unit(rule, found));
  }
  value = found;
  return true;
}

bool ValueReader::numbers(const toml::node& node, std::vector<double>& values, bool in_range) const {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    return fail_type(node);
  }
  std::vector<double> found;
  for (const toml::node& element : *array) {
    double value = 0.0;
    if (!(in_range ? number_in_range(element, value) : finite_number(element, value))) {
      return false;
    }
    found.push_back(value);
  }
  values = std::move(found);
  return true;
}

bool ValueReader::resolve_path(const toml::node& node, std::string& path, const std::string& form) const {
  namespace fs = std::filesystem;
  const Override* override = reading.override_of(key, node.source());
  const bool from_command_line = override != nullptr;
  if (path.find('\0') != std::string::npos) {
    return fail(node, "is \"{}\", a name with a zero byte; allowed: a file", shown(path));
  }
  std::error_code error;
  const fs::path base = from_command_line ? override->folder : reading.folder;
  const fs::path whole = (base / path).lexically_normal();
  if (!from_command_line) {
    if (fs::path(path).is_absolute() || !lies_within(whole, base)) {
      return fail(node,
                  "is \"{}\", which lies outside the folder of the case file; allowed: a file in that "
                  "folder. Copy it there, or give its path with --set {}={}",
                  shown(path), key, form);
    }
  }
  if (const std::string found = other_kind_of_file(whole); !found.empty()) {
    return fail(node, "is \"{}\", {}; allowed: a file", shown(path), found);
  }
  if (!fs::is_regular_file(whole, error)) {
    const std::string hint = similar_file(whole);
    return fail(node, "is \"{}\": no such file ({}){} {}: {}", shown(path), shown(whole.parent_path().string()),
                hint.empty() ? ";" : hint, hint.empty() ? "allowed" : "Allowed",
                from_command_line ? "a file, relative to the current folder"
                                  : "a file, relative to the folder of the case file");
  }
  path = whole.string();
  return true;
}

}  // namespace thawslide::config
