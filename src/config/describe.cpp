#include "config/describe.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "config/declaration.hpp"

namespace thawslide::config {

namespace {

using Json = nlohmann::ordered_json;

// Effect of omitting a key that is allowed.
std::string absence_in_meaning(const Entry& entry) {
  if (entry.required.empty()) {
    return entry.otherwise.empty() ? entry.default_text : entry.otherwise;
  }
  const std::string required = entry.required == "always" ? "required" : "required " + entry.required;
  return entry.otherwise.empty() ? required : required + "; otherwise " + entry.otherwise;
}

// Effect of omitting a key, and the condition under which it is allowed.
std::string absence(const Entry& entry) {
  const std::string text = absence_in_meaning(entry);
  const bool is_specified = entry.only.empty() || entry.only == entry.required;
  return is_specified ? text : fmt::format("{}{}only {}", text, text.empty() ? "" : "; ", entry.only);
}

std::string range_text(const Entry& entry) {
  const bool is_number = entry.rule->range.low > -std::numeric_limits<double>::infinity() ||
                         entry.rule->range.high < std::numeric_limits<double>::infinity();
  return is_number ? entry.rule->range.text() : "";
}

// Text such as "usually 0.01 to 2 (assumption)"; empty if no range is specified.
std::string usual_text(const Entry& entry) {
  return entry.rule->usual.is_specified() ? "usually " + entry.rule->usual.text() : "";
}

std::string keywords_text(const Entry& entry, const std::string& separator) {
  std::string text;
  for (const Keyword& keyword : entry.keywords) {
    text += fmt::format("{}\"{}\": {}", text.empty() ? "" : separator, keyword.name, keyword.text);
  }
  return text;
}

std::string in_table_cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
    text.replace(at, 1, "\\|");
  }
  return text;
}

Json described(const Entry& entry) {
  Json json{{"key", entry.rule->key}, {"type", entry.type}, {"unit", entry.rule->unit}, {"allowed", range_text(entry)}};
  json["dimension"] = entry.rule->dimension == 0 ? Json(nullptr) : Json(entry.rule->dimension);  // null: any
  json["usual"] = entry.rule->usual.text();
  json["default"] = entry.default_text.empty() ? Json(nullptr) : Json(entry.default_text);
  json["required"] = entry.required;
  json["otherwise"] = entry.otherwise;
  json["only"] = entry.only;
  json["text"] = entry.rule->text;
  json["source"] = entry.rule->source;
  json["keywords"] = Json::array();
  for (const Keyword& keyword : entry.keywords) {
    json["keywords"].push_back({{"name", keyword.name}, {"text", keyword.text}});
  }
  return json;
}

// Schema of one table's keys.
Json table_schema(const TableDeclaration& table) {
  Json properties = Json::object();
  for (const Entry& entry : table.entries()) {
    Json property = Json::parse(entry.schema.dump());
    property["description"] = entry.rule->text + (entry.rule->unit.empty() ? "" : " [" + entry.rule->unit + "]");
    properties[entry.rule->key] = property;
  }
  Json schema{{"type", "object"}, {"description", table.text}, {"properties", properties}};
  schema["additionalProperties"] = false;
  for (const Entry& entry : table.entries()) {
    if (entry.required == "always") {
      schema["required"].push_back(entry.rule->key);
    }
  }
  return schema;
}

}  // namespace

std::string describe_text() {
  std::string out;
  for (const auto& table : tables()) {
    out += fmt::format("\n{}  {}\n", table->title(), table->text);
    for (const Entry& entry : table->entries()) {
      const std::string unit = entry.rule->unit.empty() ? "" : " [" + entry.rule->unit + "]";
      out += fmt::format("  {:<26}{}{}\n", entry.rule->key, entry.rule->text, unit);
      std::string line = entry.type;
      for (const std::string& part : {range_text(entry), usual_text(entry),
                                      absence(entry).empty() ? "" : "default: " + absence(entry), entry.rule->source}) {
        line += part.empty() || line.find(part) != std::string::npos ? "" : "; " + part;
      }
      if (!entry.required.empty()) {
        line.replace(line.find("default: "), 9, "");
      }
      out += fmt::format("  {:<26}{}\n", "", line);
      for (const Keyword& keyword : entry.keywords) {
        out += fmt::format("  {:<26}  \"{}\": {}\n", "", keyword.name, keyword.text);
      }
    }
  }
  return out.substr(1);
}

std::string describe_json() {
  Json json = Json::array();
  for (const auto& table : tables()) {
    Json keys = Json::array();
    for (const Entry& entry : table->entries()) {
      keys.push_back(described(entry));
    }
    json.push_back({{"table", table->title()}, {"text", table->text}, {"keys", keys}});
  }
  return json.dump(2) + "\n";
}

std::string describe_markdown() {
  std::string out =
      "# The case file\n\nThis page lists the keys of a case file. `thawslide describe --md` generates it. Angles are "
      "in degrees, temperatures in degrees Celsius, and all other quantities in SI units.\n\n"
      "- *allowed*: type, range and keywords of the value. A value outside the range that follows *usually* is "
      "allowed, and `check` and `run` warn. These ranges are assumptions.\n"
      "- *default*: value that applies if the key is not given, or the condition that requires the key. *Only when* is "
      "the condition for a key to be allowed.\n"
      "- *source*: publication, listed in [References](theory/references.md). Equations, sections and tables without "
      "author are those of Lei et al. [Theory](theory.md) explains them, and [Symbols](theory/symbols.md) lists the "
      "symbols.\n";
  for (const auto& table : tables()) {
    out += fmt::format(
        "\n## `{}`\n\n{}.\n\n| key | unit | allowed | default | meaning | source |\n|---|---|---|---|---|---|\n",
        table->title(), table->text);
    for (const Entry& entry : table->entries()) {
      const std::string usual = usual_text(entry);
      const std::string allowed =
          entry.keywords.empty() ? entry.type + (usual.empty() ? "" : "; " + usual) : keywords_text(entry, "<br>");
      out +=
          fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", entry.rule->key, entry.rule->unit, in_table_cell(allowed),
                      in_table_cell(absence(entry)), in_table_cell(entry.rule->text), entry.rule->source);
    }
  }
  return out;
}

std::string schema_json() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Thawslide case"},
              {"type", "object"},
              {"properties", Json::object()},
              {"additionalProperties", false}};
  for (const auto& table : tables()) {
    Json own = table_schema(*table);
    if (table->is_named()) {
      own = {{"type", "object"}, {"description", table->text}, {"additionalProperties", own}};
    }
    const std::size_t dot = table->name.find('.');
    if (dot == std::string::npos) {
      schema["properties"][table->name].update(own, true);
    } else {
      schema["properties"][table->name.substr(0, dot)]["properties"][table->name.substr(dot + 1)] = own;
    }
  }
  return schema.dump(2) + "\n";
}

std::string resolved_toml(const Case& parameters, const std::filesystem::path& input_folder) {
  WriteContext context;
  context.dimension = parameters.general.dimension;
  context.input_folder = input_folder;
  std::string out = "# The case of this run, every default written out: what the case did not give is marked so.\n";
  for (const auto& table : tables()) {
    table->write(parameters, context, out);
  }
  return out;
}

}  // namespace thawslide::config
