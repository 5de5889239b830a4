#include "config/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/error.hpp"
#include "base/text.hpp"
#include "config/declaration.hpp"

namespace thawslide::config {

namespace {

std::vector<std::string> split_at_dots(const std::string& key) {
  std::vector<std::string> parts;
  std::istringstream stream(key + ".");
  for (std::string part; std::getline(stream, part, '.');) {
    parts.push_back(part);
  }
  return parts;
}

Location location_of(const Override& override) {
  return {fmt::format("--set {}={}", override.key, override.value), 0, 0, true};
}

// Value as TOML; a bare word is a string. Returns nothing (and reports a problem) for invalid TOML.
std::optional<toml::table> parse_value(const Override& override, Reading& reading) {
  try {
    toml::table parsed = toml::parse("value = " + override.value, std::string_view("--set"));
    if (parsed.size() == 1) {
      return parsed;
    }
  } catch (const toml::parse_error& error) {
    const bool is_bare =
        std::string_view("[{\"'").find(override.value.empty() ? '"' : override.value.front()) == std::string_view::npos;
    if (is_bare) {
      toml::table text;
      text.insert_or_assign("value", override.value);
      return text;
    }
  }
  reading.problems.add(location_of(override),
                       fmt::format("'{}' is not one TOML value. Write for example --set band.thickness=0.1, "
                                   "--set grid.min='[0, 0]' or --set terrain.type=flat.",
                                   override.value));
  reading.invalid_keys.insert(override.key);
  return std::nullopt;
}

// True if `--set` specifies all keys of this table that are always required, such as body.NAME.material; for a table
// without such keys, one key that has no default and does not depend on others, such as probe.NAME.point.
bool defines_table(const TableDeclaration& table, const std::string& own_name, const Reading& reading) {
  const auto is_given = [&](const Entry& entry) {
    const std::string key = fmt::format("{}.{}.{}", table.name, own_name, entry.rule->key);
    return std::any_of(reading.overrides.begin(), reading.overrides.end(),
                       [&](const Override& override) { return override.key == key; });
  };
  const std::vector<Entry> entries = table.entries();
  const auto is_needed = [](const Entry& entry) { return entry.required == "always"; };
  if (std::any_of(entries.begin(), entries.end(), is_needed)) {
    return std::all_of(entries.begin(), entries.end(),
                       [&](const Entry& entry) { return !is_needed(entry) || is_given(entry); });
  }
  return std::any_of(entries.begin(), entries.end(), [&](const Entry& entry) {
    const bool defines = !entry.otherwise.empty() || (!entry.required.empty() && entry.only.empty());
    return defines && is_given(entry);
  });
}

// Declaration of the named tables [NAME.x]; null if there are none.
const TableDeclaration* named_table(const std::string& name) {
  const auto found = std::find_if(tables().begin(), tables().end(),
                                  [&](const auto& table) { return table->is_named() && table->name == name; });
  return found == tables().end() ? nullptr : found->get();
}

// A key of a named table must use a name from the file, or define a new table; otherwise a typing error would create a
// second body.
bool may_name_table(const Override& override, const std::vector<std::string>& parts, const toml::table& root,
                    Reading& reading) {
  if (parts.size() < 3) {
    return true;
  }
  const TableDeclaration* table = named_table(parts[0]);
  std::vector<std::string> names;
  if (const toml::table* found = root.get_as<toml::table>(parts[0])) {
    for (const auto& [key, node] : *found) {
      names.emplace_back(key.str());
    }
  }
  if (table == nullptr || std::find(names.begin(), names.end(), parts[1]) != names.end() ||
      defines_table(*table, parts[1], reading)) {
    return true;
  }
  reading.problems.add(location_of(override),
                       fmt::format("there is no {} '{}'{} In the case file: {}.", parts[0], parts[1],
                                   nearest(parts[1], names).empty() ? "." : did_you_mean(parts[1], names),
                                   names.empty() ? "none" : comma_list(names)));
  return false;
}

// A named table has no value itself: one of its keys was intended.
bool fits_named_table(const Override& override, const std::vector<std::string>& parts, const toml::node& value,
                      Reading& reading) {
  if (parts.size() != 2 || named_table(parts[0]) == nullptr || value.is_table()) {
    return true;
  }
  reading.problems.add(location_of(override),
                       fmt::format("[{}] is a table, and {} no table. Set one of its keys: --set {}.KEY=VALUE.",
                                   override.key, override.value, override.key));
  return false;
}

void apply(const Override& override, toml::table& root, Reading& reading) {
  const std::vector<std::string> parts = split_at_dots(override.key);
  if (!may_name_table(override, parts, root, reading)) {
    return;
  }
  const std::optional<toml::table> value = parse_value(override, reading);
  if (!value || !fits_named_table(override, parts, *value->get("value"), reading)) {
    return;
  }
  toml::table* table = &root;
  for (std::size_t k = 0; k + 1 < parts.size(); ++k) {
    toml::node* inner = table->get(parts[k]);
    if (inner == nullptr || !inner->is_table()) {
      table->insert_or_assign(parts[k], toml::table{});
    }
    table = table->get_as<toml::table>(parts[k]);
  }
  // The copy has no source location, by which Reading::location_of identifies the command line.
  value->get("value")->visit([&](const auto& node) { table->insert_or_assign(parts.back(), node); });
}

}  // namespace

Override parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  const Override override{trimmed(text.substr(0, equals)),
                          equals == std::string::npos ? "" : trimmed(text.substr(equals + 1))};
  const std::vector<std::string> parts = split_at_dots(override.key);
  const bool has_key = std::none_of(parts.begin(), parts.end(), [](const std::string& part) { return part.empty(); });
  if (equals == std::string::npos || !has_key) {
    throw UserError(fmt::format("--set {}: allowed: TABLE.KEY=VALUE, for example --set band.thickness=0.1.", text));
  }
  return override;
}

void apply_overrides(toml::table& root, Reading& reading) {
  for (const Override& override : reading.overrides) {
    apply(override, root, reading);
  }
}

}  // namespace thawslide::config
