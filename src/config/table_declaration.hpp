// Parameters of a section of the Case, and the table that contains them: [band], or [body.NAME] for each body.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/declaration.hpp"

namespace thawslide::config {

// "[band]" of "band", and the key as a path below it.
inline std::string join(const std::string& table, const std::string& key) { return table + "." + key; }

// Records the location of a table; returns whether it is one.
bool enter_table(const toml::node& node, const std::string& dotted, Reading& reading);
// Reports unknown keys of a table.
void report_unknown_keys(const toml::table& table, const std::string& dotted, const std::vector<std::string>& known,
                         Reading& reading);
// Reports other entries next to the named tables of [body]; returns the names.
std::vector<std::string> table_names(const toml::node& node, const std::string& kind, Reading& reading);
void report_missing(const std::string& table, const Rule& rule, const std::string& type, const std::string& when,
                    Reading& reading);
// Reports an empty path.
void report_empty(const std::string& table, const Rule& rule, const std::string& type, const std::string& when,
                  Reading& reading);
// Reports a key that is given where it is not allowed: only `when`, as decided by another key of the table.
void report_without_meaning(const std::string& table, const Rule& rule, const std::string& when,
                            const std::string& decided_by, Reading& reading);
bool check_dimension(const toml::node& node, const std::string& dotted, const Rule& rule, Reading& reading);
// Line of the resolved case: `KEY = VALUE  # UNIT, not given`.
std::string value_line(const Rule& rule, const std::string& value, bool was_given);

// Numbers contained in a value; none for most types.
template <class T>
std::vector<double> numbers_in(const T& value) {
  if constexpr (std::is_same_v<T, double>) {
    return {value};
  } else if constexpr (std::is_same_v<T, BandThickness> || std::is_same_v<T, InitialField>) {
    return value.table.value;
  } else if constexpr (std::is_same_v<T, MapValue>) {
    return value.from == MapValue::From::number ? std::vector<double>{value.number} : std::vector<double>{};
  } else if constexpr (std::is_same_v<T, ReleaseTime>) {
    return value.attribute.empty() ? std::vector<double>{value.number} : std::vector<double>{};
  } else if constexpr (std::is_same_v<T, Point> || std::is_same_v<T, std::vector<double>>) {
    return {value.begin(), value.end()};
  } else {
    return {};
  }
}

// Condition on the case and the section, its text, and the main key of the same table in it. Default: none.
template <class Section>
struct Condition {
  std::string when = {};
  std::string decided_by = {};
  std::function<bool(const Case&, const Section&)> holds = nullptr;
};

// Condition that the member of a key has a value; `subject`: the key in the text.
template <class Section, class T>
Condition<Section> if_is(T Section::*member, std::type_identity_t<T> value, const std::string& subject,
                         const std::string& key) {
  return {"when " + subject + " is " + Value<T>::write(value, {}, {}), key,
          [member, value](const Case&, const Section& section) { return section.*member == value; }};
}

template <class Section>
class Parameter {
 public:
  using Holds = std::function<bool(const Case&, const Section&)>;

  // Binds a rule to the result of `access` (a pointer to member, or a function of the section).
  template <class Access>
  static Parameter bind(Access access, Rule rule) {
    using T = std::remove_cvref_t<std::invoke_result_t<Access, Section&>>;
    Parameter parameter;
    parameter.rule = std::move(rule);
    parameter.type = Value<T>::type(parameter.rule);
    parameter.keywords = parameter.rule.keywords.empty() ? Value<T>::keywords() : parameter.rule.keywords;
    parameter.schema = Value<T>::schema(parameter.rule);
    parameter.read = [access](const toml::node& node, const ValueReader& at, Section& section) {
      return Value<T>::read(node, at, std::invoke(access, section));
    };
    parameter.write = [access](const Section& section, const Rule& its_rule, const WriteContext& context) {
      Section copy = section;
      return Value<T>::write(std::invoke(access, copy), its_rule, context);
    };
    parameter.numbers = [access](const Section& section) {
      Section copy = section;
      return numbers_in<T>(std::invoke(access, copy));
    };
    return parameter;
  }

  // No default: the key must be given.
  Parameter required() && {
    return std::move(*this).required_if({"always", {}, [](const Case&, const Section&) { return true; }});
  }
  // No default: the key must be given when the condition holds.
  Parameter required_if(Condition<Section> condition) && {
    requirement = std::move(condition);
    return std::move(*this);
  }
  // Text of the default of an absent key, and a function that sets it (null: the member's initializer applies).
  Parameter otherwise(std::string default_description, std::function<void(const Case&, Section&)> filler = nullptr) && {
    otherwise_text = std::move(default_description);
    fill = std::move(filler);
    return std::move(*this);
  }

  // The key is allowed only when the condition holds, otherwise an error; the resolved case then omits it.
  Parameter only_if(Condition<Section> condition) && {
    meaning = std::move(condition);
    return std::move(*this);
  }

  // Usual range under the condition; other cases are not checked.
  Parameter usually(Usual usual, Holds condition) && {
    rule.usual = usual;
    has_usual = std::move(condition);
    return std::move(*this);
  }

  // Default as TOML, from the member's initializer; empty if there is none.
  [[nodiscard]] std::string default_text() const {
    const bool has_default = requirement.when.empty() && otherwise_text.empty();
    return has_default ? write(Section{}, rule, WriteContext{}) : "";
  }
  [[nodiscard]] bool is_required(const Case& whole, const Section& section) const {
    return requirement.holds && requirement.holds(whole, section);
  }
  [[nodiscard]] bool has_meaning(const Case& whole, const Section& section) const {
    return !meaning.holds || meaning.holds(whole, section);
  }

  Rule rule;
  std::string type;
  std::vector<Keyword> keywords;
  nlohmann::json schema;
  Condition<Section> requirement, meaning;
  std::string otherwise_text;
  std::function<bool(const toml::node&, const ValueReader&, Section&)> read;
  std::function<std::string(const Section&, const Rule&, const WriteContext&)> write;
  Holds has_usual;  // empty: never
  std::function<std::vector<double>(const Section&)> numbers;
  std::function<void(const Case&, Section&)> fill;
};

template <class Section>
using Parameters = std::vector<Parameter<Section>>;

// Parameter of a member; `rest`: its source, and other members of its rule.
template <class Section, class T>
Parameter<Section> parameter(T Section::*member, const char* key, const char* text, Rule rest = {}) {
  rest.key = key;
  rest.text = text;
  return Parameter<Section>::bind(member, std::move(rest));
}
template <class Section, class T>
Parameter<Section> parameter(T Section::*member, const char* key, const char* unit, const Range& range,
                             const char* text, Rule rest = {}) {
  rest.unit = unit;
  rest.range = range;
  return parameter(member, key, text, std::move(rest));
}

// Parameters that have a meaning only under one condition.
template <class Section>
Parameters<Section> only_if(const Condition<Section>& condition, Parameters<Section> parameters) {
  for (Parameter<Section>& each : parameters) {
    each.meaning = condition;
  }
  return parameters;
}

template <class Section>
Parameters<Section> joined(std::initializer_list<Parameters<Section>> lists) {
  Parameters<Section> all;
  for (const Parameters<Section>& list : lists) {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

// Parameter for each side of the grid, bound to an array of six.
template <class Section, class T>
Parameters<Section> six_sides(std::array<T, 6> Section::*member, const std::string& text) {
  const std::array<std::string, 6> sides{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  Parameters<Section> result;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    result.push_back(Parameter<Section>::bind(
        [member, side](Section& section) -> T& { return (section.*member)[side]; },
        {.key = sides[side], .text = text + " at the side " + sides[side], .dimension = side < 4 ? 0 : 3}));
  }
  return result;
}

// Table bound to a member of the Case: a section, or a map of sections by the names of their tables.
template <class Section, class Member>
class BoundTable : public TableDeclaration {
 public:
  BoundTable(std::string table_name, std::string table_text, Member Case::*member, Parameters<Section> parameters)
      : TableDeclaration(std::move(table_name), std::move(table_text)),
        member_(member),
        parameters_(std::move(parameters)) {}

  [[nodiscard]] bool is_named() const override { return has_names; }

  [[nodiscard]] std::vector<Entry> entries() const override {
    std::vector<Entry> entries;
    for (const auto& p : parameters_) {
      entries.push_back({&p.rule, p.type, p.default_text(), p.requirement.when, p.otherwise_text, p.keywords, p.schema,
                         p.meaning.when});
    }
    return entries;
  }

  void read(const toml::table& root, Case& result, Reading& reading) const override {
    const toml::node* node = root.at_path(name).node();  // a parent that is no table is reported when it is read itself
    if (node == nullptr) {
      return;
    }
    if constexpr (has_names) {
      for (const std::string& own_name : table_names(*node, name, reading)) {
        read_section(*node->as_table()->get_as<toml::table>(own_name), join(name, own_name),
                     (result.*member_)[own_name], reading);
      }
    } else if (enter_table(*node, name, reading)) {
      read_section(*node->as_table(), name, result.*member_, reading);
    }
  }

  void complete(Case& result, Reading& reading) const override {
    for_each_section(result, [&](const std::string& dotted, Section& section) {
      complete_section(dotted, result, section, reading);
    });
  }

  void write(const Case& source, const WriteContext& context, std::string& out) const override {
    for_each_section(source, [&](const std::string& dotted, const Section& section) {
      const std::string lines = lines_of(dotted, source, section, context);
      out += has_names || !lines.empty() ? "\n[" + dotted + "]\n" + lines : "";
    });
  }

  void collect_numbers(const Case& source, std::vector<KeyNumbers>& found) const override {
    for_each_section(source, [&](const std::string& dotted, const Section& section) {
      for (const auto& p : parameters_) {
        if (p.has_meaning(source, section)) {
          found.push_back(
              {join(dotted, p.rule.key), p.numbers(section), &p.rule, p.has_usual && p.has_usual(source, section)});
        }
      }
    });
  }

 private:
  static constexpr bool has_names = !std::is_same_v<Member, Section>;

  // Calls work(dotted name, section) for each section in the case.
  template <class AnyCase, class Work>
  void for_each_section(AnyCase& of, const Work& work) const {
    if constexpr (has_names) {
      for (auto& [own_name, section] : of.*member_) {
        work(join(name, own_name), section);
      }
    } else {
      work(name, of.*member_);
    }
  }

  void read_section(const toml::table& table, const std::string& dotted, Section& section, Reading& reading) const {
    std::vector<std::string> known;
    for (const auto& p : parameters_) {
      known.push_back(p.rule.key);
      const std::string key = join(dotted, p.rule.key);
      const toml::node* node = table.get(p.rule.key);
      if (node == nullptr) {
        continue;
      }
      reading.locations[key] = reading.location_of(key, node->source());
      if (check_dimension(*node, key, p.rule, reading)) {
        p.read(*node, ValueReader{reading, key, p.rule, p.default_text(), p.type}, section);
      }
    }
    report_unknown_keys(table, dotted, known, reading);
  }

  void complete_section(const std::string& dotted, const Case& whole, Section& section, Reading& reading) const {
    // An unknown keyword decides nothing: requirements of its default may not apply.
    const bool is_decided = std::all_of(parameters_.begin(), parameters_.end(), [&](const auto& p) {
      return p.keywords.empty() || reading.are_valid({join(dotted, p.rule.key)});
    });
    for (const auto& p : parameters_) {
      const std::string key = join(dotted, p.rule.key);
      if (reading.is_given(key)) {
        const bool may_judge = is_decided && reading.are_valid({key, join(dotted, p.meaning.decided_by)});
        if (may_judge && !p.has_meaning(whole, section)) {
          report_without_meaning(dotted, p.rule, p.meaning.when, p.meaning.decided_by, reading);
        }
        const bool is_empty = p.rule.is_path && p.write(section, p.rule, WriteContext{}) == quoted("");
        if (is_empty && is_decided && reading.are_valid({key}) && p.is_required(whole, section)) {
          report_empty(dotted, p.rule, p.type, p.requirement.when, reading);
        }
        continue;
      }
      if (!is_decided && p.requirement.holds && p.requirement.when != "always") {
        reading.invalid_keys.insert(key);
      } else if (p.is_required(whole, section)) {
        report_missing(dotted, p.rule, p.type, p.requirement.when, reading);
      } else if (p.fill) {
        p.fill(whole, section);
      }
    }
  }

  [[nodiscard]] std::string lines_of(const std::string& dotted, const Case& whole, const Section& section,
                                     const WriteContext& context) const {
    std::string lines;
    const Section defaults{};
    for (const auto& p : parameters_) {
      if (!p.has_meaning(whole, section)) {
        continue;
      }
      const std::string value = p.write(section, p.rule, context);
      const bool may_be_absent = !p.requirement.when.empty() || (!p.otherwise_text.empty() && !p.fill);
      const bool is_absent =
          may_be_absent && !p.is_required(whole, section) && value == p.write(defaults, p.rule, context);
      const bool elsewhere = p.rule.dimension != 0 && p.rule.dimension != context.dimension;
      if (!is_absent && !elsewhere) {
        lines += value_line(p.rule, value, was_given(whole, join(dotted, p.rule.key)));
      }
    }
    return lines;
  }

  Member Case::*member_;
  Parameters<Section> parameters_;
};

// Adds the table of a section, or of a map of sections.
template <class Section>
void declare(Tables& tables, const char* name, const char* text, Section Case::*member,
             Parameters<std::type_identity_t<Section>> parameters) {
  tables.push_back(std::make_unique<BoundTable<Section, Section>>(name, text, member, std::move(parameters)));
}
template <class Section>
void declare(Tables& tables, const char* name, const char* text, std::map<std::string, Section> Case::*member,
             Parameters<std::type_identity_t<Section>> parameters) {
  tables.push_back(
      std::make_unique<BoundTable<Section, std::map<std::string, Section>>>(name, text, member, std::move(parameters)));
}

}  // namespace thawslide::config
