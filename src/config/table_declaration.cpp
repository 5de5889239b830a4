#include "config/table_declaration.hpp"

#include <fmt/format.h>

#include <cctype>

#include "config/case_layers.hpp"

namespace thawslide::config {

namespace {

// Tables directly within this one: "boundary" in [grid].
std::vector<std::string> tables_inside(const std::string& dotted) {
  std::vector<std::string> result;
  for (const auto& table : tables()) {
    if (table->name.size() > dotted.size() && table->name.compare(0, dotted.size() + 1, dotted + ".") == 0) {
      result.push_back(table->name.substr(dotted.size() + 1));
    }
  }
  return result;
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '-';
  });
}

}  // namespace

const Tables& tables() {
  static const Tables all = [] {
    Tables result;
    declare_run(result);
    declare_bodies(result);
    declare_model(result);
    return result;
  }();
  return all;
}

std::vector<std::string> tables_with(const std::string& key) {
  std::vector<std::string> result;
  for (const auto& table : tables()) {
    for (const Entry& entry : table->entries()) {
      if (entry.rule->key == key) {
        result.push_back(table->title());
      }
    }
  }
  return result;
}

bool enter_table(const toml::node& node, const std::string& dotted, Reading& reading) {
  reading.locations[dotted] = reading.location_of(dotted, node.source());
  if (!node.is_table()) {
    reading.report({dotted}, "'{}' is {}; allowed: one table. Write [{}] on a line of its own and its keys below.",
                   dotted, describe_node(node), dotted);
    return false;
  }
  return true;
}

void report_unknown_keys(const toml::table& table, const std::string& dotted, const std::vector<std::string>& known,
                         Reading& reading) {
  std::vector<std::string> allowed = known;
  const std::vector<std::string> inside = tables_inside(dotted);
  allowed.insert(allowed.end(), inside.begin(), inside.end());
  for (const auto& [key, node] : table) {
    const std::string word(key.str());
    if (std::find(allowed.begin(), allowed.end(), word) != allowed.end()) {
      continue;
    }
    const std::string whole = join(dotted, word);
    const std::vector<std::string> elsewhere = tables_with(word);
    const std::string hint = elsewhere.empty() ? did_you_mean(word, allowed, ".")
                                               : fmt::format("; it belongs in {}.", fmt::join(elsewhere, " or "));
    reading.report_at(reading.location_of(whole, key.source()), whole,
                      "key '{}' is not known in [{}]{} Allowed here: {}.", whole, dotted, hint, comma_list(allowed));
  }
}

std::vector<std::string> table_names(const toml::node& node, const std::string& kind, Reading& reading) {
  std::vector<std::string> names;
  if (!enter_table(node, kind, reading)) {
    return names;
  }
  for (const auto& [key, child] : *node.as_table()) {
    const std::string name(key.str());
    const std::string dotted = join(kind, name);
    const bool in_file = child.source().begin.line > 0;
    reading.locations[dotted] =
        reading.location_of(dotted, child.is_table() || !in_file ? child.source() : key.source());
    if (!child.is_table()) {
      reading.report({dotted},
                     "'{}' stands in [{}], which needs a name; write [{}.NAME] with a name of your "
                     "choice above it.",
                     name, kind, kind);
    } else if (!is_plain_name(name)) {
      reading.report({dotted}, "'{}' cannot name a {}; allowed: letters a to z, digits, '_' and '-'. Rename it.", name,
                     kind);
    } else {
      names.push_back(name);
    }
  }
  return names;
}

namespace {

std::string reason_for(const std::string& when) {
  return when == "always" ? "it has no default" : "it is needed " + when;
}

}  // namespace

void report_missing(const std::string& table, const Rule& rule, const std::string& type, const std::string& when,
                    Reading& reading) {
  reading.report({join(table, rule.key)}, "key '{}' is missing: {}. Add '{} = ...' to [{}]: {}, {}.",
                 join(table, rule.key), reason_for(when), rule.key, table, rule.text, type);
}

void report_empty(const std::string& table, const Rule& rule, const std::string& type, const std::string& when,
                  Reading& reading) {
  const std::string key = join(table, rule.key);
  reading.report({key}, "{} is empty, and {}. Allowed: {}, {}.", key, reason_for(when), rule.text, type);
}

void report_without_meaning(const std::string& table, const Rule& rule, const std::string& when,
                            const std::string& decided_by, Reading& reading) {
  const std::string key = join(table, rule.key), other = join(table, decided_by);
  reading.report({key, other}, "{} has a meaning only {}. Remove it, or change {}.", key, when, other);
}

bool check_dimension(const toml::node& node, const std::string& dotted, const Rule& rule, Reading& reading) {
  if (rule.dimension == 0 || reading.dimension == 0 || rule.dimension == reading.dimension) {
    return true;
  }
  reading.report_at(reading.location_of(dotted, node.source()), dotted,
                    "{} has a meaning only in {} dimensions, and case.dimension is {}. Remove it.", dotted,
                    rule.dimension == 2 ? "two" : "three", reading.dimension);
  return false;
}

std::string value_line(const Rule& rule, const std::string& value, bool was_given) {
  std::string comment = rule.unit;
  if (!was_given) {
    comment += (comment.empty() ? "" : ", ") + std::string(not_given_mark);
  }
  return fmt::format("{} = {}{}{}\n", rule.key, value, comment.empty() ? "" : "  # ", comment);
}

}  // namespace thawslide::config
