// Declarations: a parameter is a Rule bound to a member of the Case; a table is a list of parameters. Reading, errors,
// the reference, the resolved case file and the editor schema are all driven by them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "config/values.hpp"

namespace thawslide::config {

// What the reference tells of a parameter.
struct Entry {
  const Rule* rule = nullptr;
  std::string type;
  std::string default_text;  // TOML; empty: none
  std::string required;      // "always", or when; empty: never
  std::string otherwise;     // what holds where the key is absent and there is no fixed default
  std::vector<Keyword> words;
  nlohmann::json schema;
  std::string only;  // when the key has a meaning; empty: always
};

// When a key has a meaning, in words, and the key of the same table that decides it.
struct Meaning {
  std::string when;
  std::string decided_by;
};

// A number of the case outside the usual ones.
struct Unusual {
  std::string key;  // dotted
  double value = 0.0;
  const Rule* rule = nullptr;
};

// The numbers that a value holds; of most types none.
template <class T>
std::vector<double> numbers_in(const T& value) {
  if constexpr (std::is_same_v<T, double>) {
    return {value};
  } else if constexpr (std::is_same_v<T, Table>) {
    return value.value;
  } else {
    return {};
  }
}

template <class Section>
class Parameter {
 public:
  // Binds a rule to what `access` (a pointer to member, or a function of the section) gives.
  template <class Access>
  static Parameter bind(Access access, Rule rule) {
    using T = std::remove_cvref_t<std::invoke_result_t<Access, Section&>>;
    Parameter parameter;
    parameter.rule = std::move(rule);
    parameter.type = Value<T>::type(parameter.rule);
    parameter.words = parameter.rule.words.empty() ? Value<T>::words() : parameter.rule.words;
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
  // No default: the key must be given when the condition holds; `when` says it in words.
  Parameter required_if(std::string when, std::function<bool(const Case&, const Section&)> condition) && {
    required_text = std::move(when);
    is_required = std::move(condition);
    return std::move(*this);
  }
  // What holds where the key is absent, in words, and how to fill it in (nothing: the member's initialiser says it).
  Parameter otherwise(std::string default_description, std::function<void(const Case&, Section&)> filler = nullptr) && {
    otherwise_text = std::move(default_description);
    fill = std::move(filler);
    return std::move(*this);
  }

  // The key has a meaning only when the condition holds, which `when` says in words: given without it is a mistake, and
  // the resolved case leaves it out. `decided_by` is the key of the same table that the condition asks most of.
  Parameter only_if(std::string when, std::string decided_by,
                    std::function<bool(const Case&, const Section&)> condition) && {
    meaning = {std::move(when), std::move(decided_by)};
    has_meaning = std::move(condition);
    return std::move(*this);
  }

  // The numbers that are usual where the condition holds; nothing is said of others.
  Parameter usually(Usual usual, std::function<bool(const Case&, const Section&)> condition) && {
    rule.usual = usual;
    has_usual = std::move(condition);
    return std::move(*this);
  }

  // The default as TOML, from the member's initialiser; empty where there is none.
  [[nodiscard]] std::string default_text() const {
    const bool has_default = required_text.empty() && otherwise_text.empty();
    return has_default ? write(Section{}, rule, WriteContext{}) : "";
  }

  Rule rule;
  std::string type;
  std::vector<Keyword> words;
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

// One entry of an array member.
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

  // "[band]" or, for tables with a name of their own, "[body.NAME]".
  [[nodiscard]] std::string title() const { return "[" + name + (is_named() ? ".NAME]" : "]"); }
  [[nodiscard]] virtual bool is_named() const = 0;
  [[nodiscard]] virtual std::vector<Entry> entries() const = 0;
  // Reads the table if the file has it; reports unknown keys and wrong values.
  virtual void read(const toml::table& root, Case& result, Reading& reading) const = 0;
  // Reports missing keys and fills in what follows from other keys.
  virtual void complete(Case& result, Reading& reading) const = 0;
  virtual void write(const Case& source, const WriteContext& context, std::string& out) const = 0;
  virtual void find_unusual(const Case& source, std::vector<Unusual>& found) const = 0;
  // The names in the case of a named table.
  [[nodiscard]] virtual std::vector<std::string> names(const Case& source) const = 0;
};

using Tables = std::vector<std::unique_ptr<TableDeclaration>>;

// Every table of the case file, [case] first.
const Tables& tables();

// The parts of tables(): parameters_run.cpp, parameters_material.cpp, parameters_bodies.cpp and
// parameters_model.cpp, among whose tables those of parameters_basal.cpp, parameters_bed.cpp and
// parameters_contact.cpp stand.
void declare_run(Tables& tables);
void declare_material(Tables& tables);
void declare_bodies(Tables& tables);
void declare_model(Tables& tables);
void declare_basal(Tables& tables);
void declare_bed(Tables& tables);
void declare_contact(Tables& tables);

}  // namespace thawslide::config
