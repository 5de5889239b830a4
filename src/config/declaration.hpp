// Declarations: a parameter is a Rule bound to a member of the Case; a table is a list of parameters. Reading, errors,
// the reference, the resolved case file and the editor schema are all based on them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "config/values.hpp"

namespace thawslide::config {

// Reference entry of a parameter.
struct Entry {
  const Rule* rule = nullptr;
  std::string type;
  std::string default_text;  // TOML; empty: none
  std::string required;      // "always", or the condition; empty: never
  std::string otherwise;     // default of an absent key that has no fixed default
  std::vector<Keyword> keywords;
  nlohmann::json schema;
  std::string only;  // condition under which the key is allowed; empty: always
};

// Condition under which a key is allowed, as text, and the key of the same table that decides it.
struct Meaning {
  std::string when;
  std::string decided_by;
};

// Numbers of one key of the case.
struct KeyNumbers {
  std::string key;  // dotted
  std::vector<double> numbers;
  const Rule* rule = nullptr;
  bool is_usual = false;  // the usual range of the rule applies
};

// Numbers contained in a value; none for most types.
template <class T>
std::vector<double> numbers_in(const T& value) {
  if constexpr (std::is_same_v<T, double>) {
    return {value};
  } else if constexpr (std::is_same_v<T, BandThickness>) {
    return value.table.value;
  } else if constexpr (std::is_same_v<T, MapValue>) {
    return value.from == MapValue::From::number ? std::vector<double>{value.number} : std::vector<double>{};
  } else if constexpr (std::is_same_v<T, ReleaseTime>) {
    return value.attribute.empty() ? std::vector<double>{value.number} : std::vector<double>{};
  } else if constexpr (std::is_same_v<T, InitialField>) {
    return value.table.value;
  } else if constexpr (std::is_same_v<T, Point> || std::is_same_v<T, std::vector<double>>) {
    return {value.begin(), value.end()};
  } else {
    return {};
  }
}

template <class Section>
class Parameter {
 public:
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
    return std::move(*this).required_if("always", [](const Case&, const Section&) { return true; });
  }
  // No default: the key must be given when the condition holds; `when` is its text.
  Parameter required_if(std::string when, std::function<bool(const Case&, const Section&)> condition) && {
    required_text = std::move(when);
    is_required = std::move(condition);
    return std::move(*this);
  }
  // Text of the default of an absent key, and a function that sets it (null: the member's initializer applies).
  Parameter otherwise(std::string default_description, std::function<void(const Case&, Section&)> filler = nullptr) && {
    otherwise_text = std::move(default_description);
    fill = std::move(filler);
    return std::move(*this);
  }

  // The key is allowed only when the condition holds, with `when` as its text. Otherwise a given key is an error, and
  // the resolved case omits it. `decided_by` is the main key of the same table in the condition.
  Parameter only_if(std::string when, std::string decided_by,
                    std::function<bool(const Case&, const Section&)> condition) && {
    meaning = {std::move(when), std::move(decided_by)};
    has_meaning = std::move(condition);
    return std::move(*this);
  }

  // Usual range under the condition; other cases are not checked.
  Parameter usually(Usual usual, std::function<bool(const Case&, const Section&)> condition) && {
    rule.usual = usual;
    has_usual = std::move(condition);
    return std::move(*this);
  }

  // Default as TOML, from the member's initializer; empty if there is none.
  [[nodiscard]] std::string default_text() const {
    const bool has_default = required_text.empty() && otherwise_text.empty();
    return has_default ? write(Section{}, rule, WriteContext{}) : "";
  }

  Rule rule;
  std::string type;
  std::vector<Keyword> keywords;
  nlohmann::json schema;
  std::string required_text;
  std::string otherwise_text;
  Meaning meaning;
  std::function<bool(const toml::node&, const ValueReader&, Section&)> read;
  std::function<std::string(const Section&, const Rule&, const WriteContext&)> write;
  std::function<bool(const Case&, const Section&)> is_required;
  std::function<bool(const Case&, const Section&)> has_meaning;  // empty: always
  std::function<bool(const Case&, const Section&)> has_usual;    // empty: never
  std::function<std::vector<double>(const Section&)> numbers;
  std::function<void(const Case&, Section&)> fill;
};

template <class Section, class T>
Parameter<Section> parameter(T Section::*member, Rule rule) {
  return Parameter<Section>::bind(member, std::move(rule));
}

// Parameter for one entry of an array member.
template <class Section, class T, std::size_t Size>
Parameter<Section> element(std::array<T, Size> Section::*member, std::size_t index, Rule rule) {
  const auto access = [member, index](Section& section) -> T& { return (section.*member)[index]; };
  return Parameter<Section>::bind(access, std::move(rule));
}

class TableDeclaration {
 public:
  TableDeclaration(std::string table_name, std::string table_text)
      : name(std::move(table_name)), text(std::move(table_text)) {}
  virtual ~TableDeclaration() = default;

  std::string name;  // "band", "grid.boundary"
  std::string text;

  // "[band]" or, for named tables, "[body.NAME]".
  [[nodiscard]] std::string title() const { return "[" + name + (is_named() ? ".NAME]" : "]"); }
  [[nodiscard]] virtual bool is_named() const = 0;
  [[nodiscard]] virtual std::vector<Entry> entries() const = 0;
  // Reads the table if the file contains it; reports unknown keys and invalid values.
  virtual void read(const toml::table& root, Case& result, Reading& reading) const = 0;
  // Reports missing keys and fills in values that follow from other keys.
  virtual void complete(Case& result, Reading& reading) const = 0;
  virtual void write(const Case& source, const WriteContext& context, std::string& out) const = 0;
  // Adds the keys that have a meaning in the case and contain numbers.
  virtual void collect_numbers(const Case& source, std::vector<KeyNumbers>& found) const = 0;
  // Names of the instances of a named table in the case.
  [[nodiscard]] virtual std::vector<std::string> names(const Case& source) const = 0;
};

using Tables = std::vector<std::unique_ptr<TableDeclaration>>;

// Every table of the case file, [case] first.
const Tables& tables();

// Parts of tables(): parameters_run.cpp, parameters_material.cpp, parameters_bodies.cpp and parameters_model.cpp. The
// last includes those of parameters_basal.cpp, parameters_bed.cpp and parameters_contact.cpp.
void declare_run(Tables& tables);
void declare_material(Tables& tables);
void declare_bodies(Tables& tables);
void declare_model(Tables& tables);
void declare_basal(Tables& tables);
void declare_bed(Tables& tables);
void declare_contact(Tables& tables);

}  // namespace thawslide::config
