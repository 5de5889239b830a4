// The two kinds of tables, for any section of the Case: [band], and [body.NAME].
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "config/declaration.hpp"

namespace thawslide::config {

// "[band]" of "band", and the key as a path below it.
inline std::string join(const std::string& table, const std::string& key) { return table + "." + key; }

// Node of a dotted table name; nullptr if the file has none.
const toml::node* find_node(const toml::table& root, const std::string& dotted);
// Records the location of a table; returns whether it is one.
bool enter_table(const toml::node& node, const std::string& dotted, Reading& reading);
// Notes that a key is given by its former name.
void note_new_key(const std::string& former, const std::string& key, const toml::source_region& source,
                  Reading& reading);
// Reports unknown keys of a table; `renamed`: keys by their former names.
void report_unknown_keys(const toml::table& table, const std::string& dotted, const std::vector<std::string>& known,
                         const std::map<std::string, std::string>& renamed, Reading& reading);
// Reports other entries next to the named tables of [body]; returns the names.
std::vector<std::string> table_names(const toml::node& node, const std::string& kind, Reading& reading);
void report_missing(const std::string& table, const Rule& rule, const std::string& type, const std::string& when,
                    Reading& reading);
// Reports an empty path.
void report_empty(const std::string& table, const Rule& rule, const std::string& type, const std::string& when,
                  Reading& reading);
// Reports a key that is given where it is not allowed.
void report_without_meaning(const std::string& table, const Rule& rule, const Meaning& meaning, Reading& reading);
bool check_dimension(const toml::node& node, const std::string& dotted, const Rule& rule, Reading& reading);
// Line of the resolved case: `KEY = VALUE  # UNIT, not given`.
std::string value_line(const Rule& rule, const std::string& value, bool was_given);

// Parameters of one section, independent of its table.
template <class Section>
class SectionParameters {
 public:
  explicit SectionParameters(std::vector<Parameter<Section>> parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] std::vector<Entry> entries() const {
    std::vector<Entry> entries;
    for (const auto& p : parameters_) {
      entries.push_back(
          {&p.rule, p.type, p.default_text(), p.required_text, p.otherwise_text, p.keywords, p.schema, p.meaning.when});
    }
    return entries;
  }

  void read(const toml::table& table, const std::string& dotted, Section& section, Reading& reading) const {
    std::vector<std::string> known;
    std::map<std::string, std::string> renamed;
    for (const auto& p : parameters_) {
      known.push_back(p.rule.key);
      if (!p.rule.formerly.empty()) {
        renamed[p.rule.formerly] = p.rule.key;
      }
      const std::string key = join(dotted, p.rule.key);
      const toml::node* node = table.get(p.rule.key);
      if (node == nullptr && !p.rule.formerly.empty() && table.contains(p.rule.formerly)) {
        node = table.get(p.rule.formerly);
        known.push_back(p.rule.formerly);
        note_new_key(join(dotted, p.rule.formerly), key, node->source(), reading);
      }
      if (node == nullptr) {
        continue;
      }
      reading.locations[key] = reading.location_of(key, node->source());
      if (check_dimension(*node, key, p.rule, reading)) {
        p.read(*node, ValueReader{reading, key, p.rule, p.default_text(), p.type}, section);
      }
    }
    report_unknown_keys(table, dotted, known, renamed, reading);
  }

  void complete(const std::string& dotted, const Case& whole, Section& section, Reading& reading) const {
    // An unknown keyword decides nothing: requirements of its default may not apply.
    const bool is_decided = std::all_of(parameters_.begin(), parameters_.end(), [&](const auto& p) {
      return p.keywords.empty() || reading.are_valid({join(dotted, p.rule.key)});
    });
    for (const auto& p : parameters_) {
      const std::string key = join(dotted, p.rule.key);
      if (reading.is_given(key)) {
        const bool may_judge =
            p.has_meaning && is_decided && reading.are_valid({key, join(dotted, p.meaning.decided_by)});
        if (may_judge && !p.has_meaning(whole, section)) {
          report_without_meaning(dotted, p.rule, p.meaning, reading);
        }
        const bool is_empty = p.rule.is_path && p.write(section, p.rule, WriteContext{}) == quoted("");
        if (is_empty && is_decided && reading.are_valid({key}) && p.is_required && p.is_required(whole, section)) {
          report_empty(dotted, p.rule, p.type, p.required_text, reading);
        }
        continue;
      }
      if (!is_decided && p.is_required && p.required_text != "always") {
        reading.invalid_keys.insert(key);
      } else if (p.is_required && p.is_required(whole, section)) {
        report_missing(dotted, p.rule, p.type, p.required_text, reading);
      } else if (p.fill) {
        p.fill(whole, section);
      }
    }
  }

  void write(const std::string& dotted, const Case& whole, const Section& section, const WriteContext& context,
             std::string& out) const {
    const Section defaults{};
    for (const auto& p : parameters_) {
      if (p.has_meaning && !p.has_meaning(whole, section)) {
        continue;
      }
      const std::string value = p.write(section, p.rule, context);
      const bool may_be_absent = !p.required_text.empty() || (!p.otherwise_text.empty() && !p.fill);
      const bool is_absent = may_be_absent && !(p.is_required && p.is_required(whole, section)) &&
                             value == p.write(defaults, p.rule, context);
      const bool elsewhere = p.rule.dimension != 0 && p.rule.dimension != context.dimension;
      if (!is_absent && !elsewhere) {
        out += value_line(p.rule, value, was_given(whole, join(dotted, p.rule.key)));
      }
    }
  }

  void collect_numbers(const std::string& dotted, const Case& whole, const Section& section,
                       std::vector<KeyNumbers>& found) const {
    for (const auto& p : parameters_) {
      if (!p.has_meaning || p.has_meaning(whole, section)) {
        found.push_back(
            {join(dotted, p.rule.key), p.numbers(section), &p.rule, p.has_usual && p.has_usual(whole, section)});
      }
    }
  }

 private:
  std::vector<Parameter<Section>> parameters_;
};

// Parameter for each side of the grid, bound to an array of six.
template <class Section, class T>
std::vector<Parameter<Section>> six_sides(std::array<T, 6> Section::*member, const std::string& text) {
  const std::array<std::string, 6> sides{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  std::vector<Parameter<Section>> result;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    result.push_back(
        element(member, side,
                {.key = sides[side], .text = text + " at the side " + sides[side], .dimension = side < 4 ? 0 : 3}));
  }
  return result;
}

// Table that occurs once, bound to a member of the Case.
template <class Section>
class SingleTable : public TableDeclaration {
 public:
  SingleTable(std::string table_name, std::string table_text, Section Case::*member,
              std::vector<Parameter<Section>> parameters)
      : TableDeclaration(std::move(table_name), std::move(table_text)),
        member_(member),
        section_(std::move(parameters)) {}

  [[nodiscard]] bool is_named() const override { return false; }
  [[nodiscard]] std::vector<Entry> entries() const override { return section_.entries(); }
  void read(const toml::table& root, Case& result, Reading& reading) const override {
    const toml::node* node = find_node(root, name);
    if (node != nullptr && enter_table(*node, name, reading)) {
      section_.read(*node->as_table(), name, result.*member_, reading);
    }
  }
  void complete(Case& result, Reading& reading) const override {
    section_.complete(name, result, result.*member_, reading);
  }
  void write(const Case& source, const WriteContext& context, std::string& out) const override {
    std::string lines;
    section_.write(name, source, source.*member_, context, lines);
    out += lines.empty() ? "" : "\n[" + name + "]\n" + lines;
  }
  void collect_numbers(const Case& source, std::vector<KeyNumbers>& found) const override {
    section_.collect_numbers(name, source, source.*member_, found);
  }
  [[nodiscard]] std::vector<std::string> names(const Case&) const override { return {}; }

 private:
  Section Case::*member_;
  SectionParameters<Section> section_;
};

// Table that occurs once per name, bound to a map of the Case.
template <class Section>
class NamedTable : public TableDeclaration {
 public:
  using Map = std::map<std::string, Section>;

  NamedTable(std::string table_name, std::string table_text, Map Case::*member,
             std::vector<Parameter<Section>> parameters)
      : TableDeclaration(std::move(table_name), std::move(table_text)),
        member_(member),
        section_(std::move(parameters)) {}

  [[nodiscard]] bool is_named() const override { return true; }
  [[nodiscard]] std::vector<Entry> entries() const override { return section_.entries(); }
  void read(const toml::table& root, Case& result, Reading& reading) const override {
    const toml::node* node = find_node(root, name);
    if (node == nullptr) {
      return;
    }
    for (const std::string& own_name : table_names(*node, name, reading)) {
      section_.read(*node->as_table()->get_as<toml::table>(own_name), join(name, own_name), (result.*member_)[own_name],
                    reading);
    }
  }
  void complete(Case& result, Reading& reading) const override {
    for (auto& [own_name, section] : result.*member_) {
      section_.complete(join(name, own_name), result, section, reading);
    }
  }
  void write(const Case& source, const WriteContext& context, std::string& out) const override {
    for (const auto& [own_name, section] : source.*member_) {
      const std::string dotted = join(name, own_name);
      out += "\n[" + dotted + "]\n";
      section_.write(dotted, source, section, context, out);
    }
  }
  void collect_numbers(const Case& source, std::vector<KeyNumbers>& found) const override {
    for (const auto& [own_name, section] : source.*member_) {
      section_.collect_numbers(join(name, own_name), source, section, found);
    }
  }
  [[nodiscard]] std::vector<std::string> names(const Case& source) const override {
    std::vector<std::string> result;
    for (const auto& [own_name, section] : source.*member_) {
      result.push_back(own_name);
    }
    return result;
  }

 private:
  Map Case::*member_;
  SectionParameters<Section> section_;
};

}  // namespace thawslide::config
