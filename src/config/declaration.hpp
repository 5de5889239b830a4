// Declared tables of the case file, for reading, errors, reference, resolved case and schema; each parameter is a
// Rule bound to a member of the Case (table_declaration.hpp).
#pragma once

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

// Numbers of one key of the case.
struct KeyNumbers {
  std::string key;  // dotted
  std::vector<double> numbers;
  const Rule* rule = nullptr;
  bool is_usual = false;  // the usual range of the rule applies
};

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
};

using Tables = std::vector<std::unique_ptr<TableDeclaration>>;

// Every table of the case file, [case] first.
const Tables& tables();

// Titles of the tables that have a parameter with this key.
std::vector<std::string> tables_with(const std::string& key);

// Parts of tables(), by the files parameters_*.cpp; declare_model includes declare_basal.
void declare_run(Tables& tables);
void declare_bodies(Tables& tables);
void declare_model(Tables& tables);
void declare_basal(Tables& tables);

}  // namespace thawslide::config
