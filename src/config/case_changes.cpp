#include "config/case_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <string_view>

#include "base/error.hpp"
#include "config/case_layers.hpp"
#include "config/declaration.hpp"
#include "config/rule.hpp"
#include "config/toml.hpp"

namespace thawslide::config {

namespace {

// Keys that the step reads each time, without stored state. A name ending with a dot is that of a table.
constexpr std::array<std::string_view, 20> changeable = {
    "time.",
    "checkpoint.",
    "guards.",
    "grid.leaving",
    "mechanics.mass_damping",
    "mechanics.pic_fraction",
    "mechanics.fmpm_interval",
    "mechanics.fmpm_order",
    "mechanics.split_limit",
    "band.column_step",
    "basal.friction_angle",
    "basal.friction_coefficient",
    "basal.turbulent_friction",
    "basal.cohesion",
    "basal.residual_cohesion",
    "basal.heat_fraction",
    "basal.clamp",
    "basal.cap_pressure",
    "case.title",
    "report.times",
};

// Key of [basal] with the meaning of a key of [substrate.NAME]; other keys are unchanged.
std::string as_basal_key(const std::string& key) {
  const std::string table = "substrate.";
  const std::size_t dot = key.rfind(table, 0) == 0 ? key.find('.', table.size()) : std::string::npos;
  return dot == std::string::npos ? key : "basal" + key.substr(dot);
}

bool may_change(const std::string& given) {
  const std::string key = as_basal_key(given);
  return std::any_of(changeable.begin(), changeable.end(), [&key](std::string_view each) {
    return each.back() == '.' ? key.starts_with(each) : key == each;
  });
}

std::string changeable_keys() {
  std::string words;
  for (const std::string_view each : changeable) {
    const std::string word =
        each.back() == '.' ? fmt::format("[{}]", each.substr(0, each.size() - 1)) : std::string(each);
    words += (words.empty() ? "" : ", ") + word;
  }
  return words + ", and friction and cohesion of [substrate.NAME] as of [basal]";
}

bool changes_no_run(const std::string& key) { return key == "case.title" || key.rfind("report.", 0) == 0; }

// Value in the form of the resolved case.
std::string text_of(const toml::node& node) {
  if (const toml::value<double>* number = node.as_floating_point()) {
    return number_text(number->get());
  }
  if (const toml::array* array = node.as_array()) {
    std::string text;
    for (const toml::node& each : *array) {
      text += (text.empty() ? "" : ", ") + text_of(each);
    }
    return "[" + text + "]";
  }
  std::ostringstream text;
  node.visit([&](const auto& value) { text << toml::toml_formatter(value); });
  return text.str();
}

// Collects every value by its dotted key.
void gather(const toml::table& table, const std::string& prefix, std::map<std::string, std::string>& values) {
  for (const auto& [key, node] : table) {
    const std::string dotted = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table(); inner != nullptr && !inner->is_inline()) {
      gather(*inner, dotted + ".", values);
    } else if (!changes_no_run(dotted)) {
      values[dotted] = text_of(node);
    }
  }
}

}  // namespace

std::vector<std::string> coarse_changes(const Case& parameters) {
  std::vector<std::string> changes{fmt::format("grid.cell={}", trial_factor * parameters.grid.cell)};
  if (was_given(parameters, "time.step")) {  // otherwise adaptive steps have no upper limit
    changes.push_back(fmt::format("time.step={}", trial_factor * parameters.time.step));
  }
  if (parameters.maps.cell > 0.0) {
    changes.push_back(fmt::format("maps.cell={}", trial_factor * parameters.maps.cell));
  }
  return changes;
}

std::vector<std::string> differences(const std::string& now, const std::string& before,
                                     const std::set<std::string>& apart_from) {
  std::map<std::string, std::string> present, past;
  try {
    gather(toml::parse(now), "", present);
  } catch (const toml::parse_error& error) {
    return {fmt::format("line {} is not TOML: {}", error.source().begin.line, error.description())};
  }
  gather(toml::parse(before), "", past);
  for (const std::string& key : apart_from) {
    present.erase(key);
    past.erase(key);
  }
  std::vector<std::string> found;
  for (const auto& [key, value] : past) {
    const std::string now_text = present.count(key) == 0 ? "missing" : present.at(key);
    if (now_text != value) {
      found.push_back(fmt::format("{} is {}, was {}", key, now_text, value));
    }
  }
  for (const auto& [key, value] : present) {
    if (past.count(key) == 0) {
      found.push_back(fmt::format("{} is {}, was not given", key, value));
    }
  }
  return found;
}

std::set<std::string> keys_of(const std::vector<std::string>& sets) {
  std::set<std::string> keys;
  for (const std::string& set : sets) {
    keys.insert(parse_override(set).key);
  }
  return keys;
}

void require_changeable(const std::vector<std::string>& sets) {
  std::string fixed;
  for (const std::string& set : sets) {
    const std::string key = parse_override(set).key;
    if (!may_change(key)) {
      fixed += (fixed.empty() ? "" : ", ") + key;
    }
  }
  if (!fixed.empty()) {
    throw UserError(
        "{} cannot be changed on resume, because earlier results depend on it. Allowed: {}. For other "
        "changes, run the case again.",
        fixed, changeable_keys());
  }
}

}  // namespace thawslide::config
