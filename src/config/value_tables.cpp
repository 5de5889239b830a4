// Values that are a number or an inline table: tables over time, initial fields, map values, heat boundaries.
#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "config/values.hpp"

namespace thawslide::config {

namespace {

using nlohmann::json;

// A value in one of its forms: a number, a table over a variable, or the name of its source.
struct Form {
  std::string key;  // of the variable or of the source; empty: a number
  Table table;
  std::string source;
};

json object_schema(const char* key, const json& value) {
  return {{"type", "object"},
          {"additionalProperties", false},
          {"required", json::array({key})},
          {"properties", {{key, value}}}};
}

json array_of(const json& items) { return {{"type", "array"}, {"items", items}}; }

bool fail_keys(const toml::node& node, const ValueReader& at) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : *node.as_table()) {
    keys.emplace_back(key.str());
  }
  return at.fail(node, "is a table with {}; allowed: {}", keys.empty() ? "no key" : "the keys " + comma_list(keys),
                 at.allowed);
}

// Reads { ABSCISSA = [...], value = [...] }: equal lengths, ascending; two equal abscissae form a jump.
bool read_table(const toml::table& node, const std::string& abscissa, const ValueReader& at, bool may_jump,
                Table& table) {
  Table found;
  if (!at.numbers(*node.get(abscissa), found.abscissa, false) || !at.numbers(*node.get("value"), found.value, true)) {
    return false;
  }
  if (found.abscissa.size() != found.value.size() || found.value.empty()) {
    return at.fail(node, "has {} entries of {} and {} of value; allowed: as many of both, at least one",
                   found.abscissa.size(), abscissa, found.value.size());
  }
  for (std::size_t k = 1; k < found.abscissa.size(); ++k) {
    const bool descends = found.abscissa[k] < found.abscissa[k - 1];
    const bool jumps_here = found.abscissa[k] == found.abscissa[k - 1];
    const bool third_at_a_jump = k > 1 && found.abscissa[k] == found.abscissa[k - 2];
    if (descends || third_at_a_jump || (jumps_here && !may_jump)) {
      return at.fail(*node.get(abscissa)->as_array()->get(k), "holds {} {} after {}; allowed: {}", abscissa,
                     plain_number(found.abscissa[k]), plain_number(found.abscissa[k - 1]),
                     may_jump ? "ascending, and a jump as two equal entries" : "strictly increasing");
    }
  }
  table = std::move(found);
  return true;
}

// Reads the text of { KEY = "..." }: the name of an attribute, or a path, which becomes absolute.
bool read_source(const toml::table& table, const std::string& key, const ValueReader& at, std::string& source) {
  const toml::node& node = *table.get(key);
  const bool is_name = key == "attribute";
  const auto* text = node.as_string();
  if (text == nullptr || text->get().empty()) {
    return at.fail(node, "has {} as its {}; allowed: {}", describe_node(node), key,
                   is_name ? "the name of an attribute of the polygons, in quotes" : "the path of a file, in quotes");
  }
  std::string found = text->get();
  if (!is_name && !at.resolve_path(node, found, fmt::format("'{{ {} = \"PATH\" }}'", key))) {
    return false;
  }
  source = std::move(found);
  return true;
}

bool is_source(const std::string& key) { return key == "attribute" || key == "raster" || key == "surface"; }

// Forms of a value by their keys: "" for a number, variables of tables, and sources.
struct Forms {
  std::span<const char* const> keys;
  bool may_jump = true;  // of tables

  [[nodiscard]] std::string type(const Rule& rule) const {
    std::vector<std::string> forms{"a number"};
    for (const std::string key : keys.subspan(1)) {
      forms.push_back(!is_source(key) ? fmt::format("{{ {} = [...], value = [...] }}", key)
                                      : fmt::format("{{ {} = \"{}\" }}", key, key == "attribute" ? "NAME" : "FILE"));
    }
    const std::string last = " or " + forms.back(), range = rule.range.text();
    forms.pop_back();
    return comma_list(forms) + last + (range == "any number" ? "" : ", " + range) +
           (rule.unit.empty() ? "" : " [" + rule.unit + "]");
  }

  [[nodiscard]] json schema(const Rule& rule) const {
    const json number = Value<double>::schema(rule);
    json any_of = json::array({number});
    for (const char* key : keys.subspan(1)) {
      json form = object_schema(key, is_source(key) ? json{{"type", "string"}} : array_of({{"type", "number"}}));
      if (!is_source(key)) {
        form["required"].push_back("value");
        form["properties"]["value"] = array_of(number);
      }
      any_of.push_back(form);
    }
    return {{"anyOf", any_of}};
  }

  // The key is found even if its contents are invalid.
  bool read(const toml::node& node, const ValueReader& at, Form& found) const {
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      double number = 0.0;
      const bool is_valid = at.number_in_range(node, number);
      found.table = Table(number);
      return is_valid;
    }
    for (const std::string key : keys.subspan(1)) {
      if (table->contains(key) && table->size() == (is_source(key) ? 1 : 2) &&
          (is_source(key) || table->contains("value"))) {
        found.key = key;
        return is_source(key) ? read_source(*table, key, at, found.source)
                              : read_table(*table, key, at, may_jump, found.table);
      }
    }
    return fail_keys(node, at);
  }
};

std::string write_table(const Table& table, const char* variable) {
  if (table.is_constant()) {
    return table.value.empty() ? "" : number_text(table.value.front());
  }
  const auto array = [](const Numbers& numbers) { return Value<Numbers>::write(numbers, {}, {}); };
  return fmt::format("{{ {} = {}, value = {} }}", variable, array(table.abscissa), array(table.value));
}

std::string write_source(const char* key, const std::string& source, const WriteContext& context) {
  return fmt::format("{{ {} = {} }}", key,
                     std::string(key) == "attribute" ? quoted(source) : path_text(source, context));
}

constexpr const char* time_keys[] = {"", "time"};
constexpr const char* x_keys[] = {"", "x"};
constexpr const char* release_keys[] = {"", "attribute"};
constexpr const char* field_keys[] = {"", "depth", "x", "attribute", "raster"};  // as InitialField::Over
constexpr const char* map_keys[] = {"", "attribute", "raster", "surface"};       // as MapValue::From
constexpr Forms over_time{time_keys}, over_x{x_keys, false}, release_forms{release_keys}, field_forms{field_keys},
    map_forms{map_keys};

// Entry of one of these lists, as its enumeration.
template <class Enum, std::size_t Size>
Enum of_key(const char* const (&keys)[Size], const std::string& key) {
  return static_cast<Enum>(std::find(std::begin(keys), std::end(keys), key) - std::begin(keys));
}

}  // namespace

// thickness of the band
std::string Value<BandThickness>::type(const Rule& rule) { return over_time.type(rule); }
bool Value<BandThickness>::read(const toml::node& node, const ValueReader& at, BandThickness& value) {
  Form found;
  if (!over_time.read(node, at, found)) {
    return false;
  }
  value.table = std::move(found.table);
  return true;
}
std::string Value<BandThickness>::write(const BandThickness& value, const Rule&, const WriteContext&) {
  return write_table(value.table, "time");
}
json Value<BandThickness>::schema(const Rule& rule) { return over_time.schema(rule); }

// width of a section
std::string Value<WidthOverX>::type(const Rule& rule) { return over_x.type(rule); }
bool Value<WidthOverX>::read(const toml::node& node, const ValueReader& at, WidthOverX& value) {
  Form found;
  if (!over_x.read(node, at, found)) {
    return false;
  }
  for (std::size_t k = 0; k < found.table.abscissa.size(); ++k) {
    if (!(found.table.value[k] > 0.0)) {
      return at.fail(*node.as_table()->get("value")->as_array()->get(k),
                     "holds the value {} at x = {}; allowed in a table: > 0", plain_number(found.table.value[k]),
                     plain_number(found.table.abscissa[k]));
    }
  }
  value.table = std::move(found.table);
  return true;
}
std::string Value<WidthOverX>::write(const WidthOverX& value, const Rule&, const WriteContext&) {
  return write_table(value.table, "x");
}
json Value<WidthOverX>::schema(const Rule& rule) { return over_x.schema(rule); }

// initial field
std::string Value<InitialField>::type(const Rule& rule) { return field_forms.type(rule); }
bool Value<InitialField>::read(const toml::node& node, const ValueReader& at, InitialField& value) {
  Form found;
  if (!field_forms.read(node, at, found)) {
    return false;
  }
  value.over = of_key<InitialField::Over>(field_keys, found.key);
  value.table = std::move(found.table);
  value.source = std::move(found.source);
  return true;
}
std::string Value<InitialField>::write(const InitialField& value, const Rule&, const WriteContext& context) {
  const char* key = field_keys[static_cast<std::size_t>(value.over)];
  return value.is_map() ? write_source(key, value.source, context) : write_table(value.table, key);
}
json Value<InitialField>::schema(const Rule& rule) { return field_forms.schema(rule); }

// map value
std::string Value<MapValue>::type(const Rule& rule) { return map_forms.type(rule); }
bool Value<MapValue>::read(const toml::node& node, const ValueReader& at, MapValue& value) {
  Form found;
  const bool is_valid = map_forms.read(node, at, found);
  value = {of_key<MapValue::From>(map_keys, found.key), found.key.empty() && is_valid ? found.table.value.front() : 0.0,
           found.source};  // where it is from also with a problem of the source
  return is_valid;
}
std::string Value<MapValue>::write(const MapValue& value, const Rule&, const WriteContext& context) {
  const char* key = map_keys[static_cast<std::size_t>(value.from)];
  return value.from == MapValue::From::number ? number_text(value.number) : write_source(key, value.source, context);
}
json Value<MapValue>::schema(const Rule& rule) { return map_forms.schema(rule); }

// release time
std::string Value<ReleaseTime>::type(const Rule& rule) { return release_forms.type(rule); }
bool Value<ReleaseTime>::read(const toml::node& node, const ValueReader& at, ReleaseTime& value) {
  Form found;
  if (!release_forms.read(node, at, found)) {
    return false;
  }
  value = {found.key.empty() ? found.table.value.front() : 0.0, found.source};
  return true;
}
std::string Value<ReleaseTime>::write(const ReleaseTime& value, const Rule&, const WriteContext& context) {
  return value.attribute.empty() ? number_text(value.number) : write_source("attribute", value.attribute, context);
}
json Value<ReleaseTime>::schema(const Rule& rule) { return release_forms.schema(rule); }

// heat boundary
std::string Value<HeatBoundary>::type(const Rule&) {
  return "\"insulated\", { temperature = T } with T > -273.15 [C] or { flux = q } with q into the body [W/m2]";
}
bool Value<HeatBoundary>::read(const toml::node& node, const ValueReader& at, HeatBoundary& value) {
  if (const auto* text = node.as_string()) {
    if (text->get() != "insulated") {
      return at.fail_type(node);
    }
    value = HeatBoundary{};
    return true;
  }
  const toml::table* table = node.as_table();
  if (table == nullptr) {
    return at.fail_type(node);
  }
  const bool is_temperature = table->contains("temperature");
  if (table->size() != 1 || (!is_temperature && !table->contains("flux"))) {
    return fail_keys(node, at);
  }
  HeatBoundary found;
  found.kind = is_temperature ? HeatBoundaryKind::temperature : HeatBoundaryKind::flux;
  const toml::node& number = *table->get(is_temperature ? "temperature" : "flux");
  if (!at.finite_number(number, found.value)) {
    return false;
  }
  if (is_temperature && found.value <= -273.15) {
    return at.fail(number, "has the temperature {}; allowed: > -273.15 C", plain_number(found.value));
  }
  value = found;
  return true;
}
std::string Value<HeatBoundary>::write(const HeatBoundary& value, const Rule&, const WriteContext&) {
  const char* key = value.kind == HeatBoundaryKind::temperature ? "temperature" : "flux";
  return value.kind == HeatBoundaryKind::insulated ? quoted("insulated")
                                                   : fmt::format("{{ {} = {} }}", key, number_text(value.value));
}
json Value<HeatBoundary>::schema(const Rule&) {
  const json number{{"type", "number"}};
  return {{"anyOf", json::array({json{{"enum", json::array({"insulated"})}}, object_schema("temperature", number),
                                 object_schema("flux", number)})}};
}

}  // namespace thawslide::config
