// Values that are a number or an inline table: tables over time, initial fields, map values, heat boundaries.
#include <utility>

#include "config/values.hpp"

namespace thawslide::config {

namespace {

using nlohmann::json;

const Rule rule_of_numbers{};

// Keys that specify the source of a map value.
struct MapKeyword {
  MapValue::From from;
  const char* key;
};
constexpr MapKeyword map_keywords[] = {
    {MapValue::From::attribute, "attribute"}, {MapValue::From::raster, "raster"}, {MapValue::From::surface, "surface"}};

std::string write_array(const std::vector<double>& numbers) {
  return Value<Numbers>::write(numbers, rule_of_numbers, WriteContext{});
}

std::string write_table(const Table& table, const char* abscissa) {
  if (table.is_constant()) {
    return table.value.empty() ? "" : number_text(table.value.front());
  }
  return fmt::format("{{ {} = {}, value = {} }}", abscissa, write_array(table.abscissa), write_array(table.value));
}

json table_schema(const std::vector<const char*>& abscissae, const Rule& rule) {
  const json number = Value<double>::schema(rule);
  const json numbers = {{"type", "array"}, {"items", number}};
  json any_of = json::array({number});
  for (const char* abscissa : abscissae) {
    any_of.push_back(
        {{"type", "object"},
         {"additionalProperties", false},
         {"required", json::array({abscissa, "value"})},
         {"properties", {{abscissa, {{"type", "array"}, {"items", {{"type", "number"}}}}}, {"value", numbers}}}});
  }
  return {{"anyOf", any_of}};
}

std::vector<std::string> keys_of(const toml::table& table) {
  std::vector<std::string> keys;
  for (const auto& [key, node] : table) {
    keys.emplace_back(key.str());
  }
  return keys;
}

enum class Jumps { allowed, refused };

// Reads { ABSCISSA = [...], value = [...] }: equal lengths, ascending; two equal abscissae form a jump.
bool read_table(const toml::table& node, const std::string& abscissa, const ValueReader& at, Table& table,
                Jumps jumps = Jumps::allowed) {
  Table found;
  if (!at.numbers(*node.get(abscissa), found.abscissa, false) || !at.numbers(*node.get("value"), found.value, true)) {
    return false;
  }
  if (found.abscissa.size() != found.value.size() || found.value.empty()) {
    return at.fail(node, fmt::format("has {} entries of {} and {} of value; allowed: as many of both, at least one",
                                     found.abscissa.size(), abscissa, found.value.size()));
  }
  for (std::size_t k = 1; k < found.abscissa.size(); ++k) {
    const bool descends = found.abscissa[k] < found.abscissa[k - 1];
    const bool jumps_here = found.abscissa[k] == found.abscissa[k - 1];
    const bool third_at_a_jump = k > 1 && found.abscissa[k] == found.abscissa[k - 2];
    if (descends || third_at_a_jump || (jumps_here && jumps == Jumps::refused)) {
      return at.fail(
          *node.get(abscissa)->as_array()->get(k),
          fmt::format("holds {} {} after {}; allowed: {}", abscissa, plain_number(found.abscissa[k]),
                      plain_number(found.abscissa[k - 1]),
                      jumps == Jumps::allowed ? "ascending, and a jump as two equal entries" : "strictly increasing"));
    }
  }
  table = std::move(found);
  return true;
}

bool has_exactly(const toml::table& table, const std::string& abscissa) {
  return table.size() == 2 && table.contains(abscissa) && table.contains("value");
}

bool fail_keys(const toml::node& node, const ValueReader& at) {
  return at.fail(node,
                 fmt::format("is a table with {}; allowed: {}",
                             node.as_table()->empty() ? "no key" : "the keys " + comma_list(keys_of(*node.as_table())),
                             at.allowed));
}

// Reads a number, or { ABSCISSA = [...], value = [...] }.
bool read_number_or_table(const toml::node& node, const std::string& abscissa, const ValueReader& at, Table& value,
                          Jumps jumps = Jumps::allowed) {
  if (const toml::table* table = node.as_table()) {
    return has_exactly(*table, abscissa) ? read_table(*table, abscissa, at, value, jumps) : fail_keys(node, at);
  }
  double number = 0.0;
  if (!at.number_in_range(node, number)) {
    return false;
  }
  value = Table(number);
  return true;
}

// Key that the table contains, if it is its only key; empty otherwise.
std::string only_key(const toml::table& table, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (table.size() == 1 && table.contains(key)) {
      return key;
    }
  }
  return "";
}

// Reads the text of { KEY = "..." }: the name of an attribute, or a path, which becomes absolute.
bool read_source(const toml::table& table, const std::string& key, const ValueReader& at, std::string& source) {
  const toml::node& node = *table.get(key);
  const bool is_name = key == "attribute";
  const auto* text = node.as_string();
  if (text == nullptr || text->get().empty()) {
    return at.fail(node, fmt::format("has {} as its {}; allowed: {}", describe_node(node), key,
                                     is_name ? "the name of an attribute of the polygons, in quotes"
                                             : "the path of a file, in quotes"));
  }
  std::string found = text->get();
  if (!is_name && !at.resolve_path(node, found, fmt::format("'{{ {} = \"PATH\" }}'", key))) {
    return false;
  }
  source = std::move(found);
  return true;
}

// { KEY = "..." }
std::string write_source(const std::string& key, const std::string& source, const WriteContext& context) {
  return fmt::format("{{ {} = {} }}", key, key == "attribute" ? quoted(source) : path_text(source, context));
}

json source_schema(const char* key) {
  return {{"type", "object"},
          {"additionalProperties", false},
          {"required", json::array({key})},
          {"properties", {{key, {{"type", "string"}}}}}};
}

std::string range_and_unit(const Rule& rule) {
  const std::string range = rule.range.text();
  return fmt::format("{}{}{}", range == "any number" ? "" : ", " + range, rule.unit.empty() ? "" : " [" + rule.unit,
                     rule.unit.empty() ? "" : "]");
}

}  // namespace

// thickness of the band
std::string Value<BandThickness>::type(const Rule& rule) {
  return fmt::format("a number or {{ time = [...], value = [...] }}{}", range_and_unit(rule));
}
bool Value<BandThickness>::read(const toml::node& node, const ValueReader& at, BandThickness& value) {
  return read_number_or_table(node, "time", at, value.table);
}
std::string Value<BandThickness>::write(const BandThickness& value, const Rule&, const WriteContext&) {
  return write_table(value.table, "time");
}
json Value<BandThickness>::schema(const Rule& rule) { return table_schema({"time"}, rule); }

// width of a section
std::string Value<WidthOverX>::type(const Rule& rule) {
  return fmt::format("a number or {{ x = [...], value = [...] }}{}", range_and_unit(rule));
}
bool Value<WidthOverX>::read(const toml::node& node, const ValueReader& at, WidthOverX& value) {
  Table found;
  if (!read_number_or_table(node, "x", at, found, Jumps::refused)) {
    return false;
  }
  for (std::size_t k = 0; k < found.abscissa.size(); ++k) {
    if (!(found.value[k] > 0.0)) {
      return at.fail(*node.as_table()->get("value")->as_array()->get(k),
                     fmt::format("holds the value {} at x = {}; allowed in a table: > 0", plain_number(found.value[k]),
                                 plain_number(found.abscissa[k])));
    }
  }
  value.table = std::move(found);
  return true;
}
std::string Value<WidthOverX>::write(const WidthOverX& value, const Rule&, const WriteContext&) {
  return write_table(value.table, "x");
}
json Value<WidthOverX>::schema(const Rule& rule) { return table_schema({"x"}, rule); }

// initial field
std::string Value<InitialField>::type(const Rule& rule) {
  return fmt::format(
      "a number, {{ depth = [...], value = [...] }}, {{ x = [...], value = [...] }}, {{ attribute = \"NAME\" }} or "
      "{{ raster = \"FILE\" }}{}",
      range_and_unit(rule));
}
bool Value<InitialField>::read(const toml::node& node, const ValueReader& at, InitialField& value) {
  InitialField found;
  const toml::table* table = node.as_table();
  const std::string map = table == nullptr ? "" : only_key(*table, {"attribute", "raster"});
  if (table != nullptr && !map.empty()) {
    found.over = map == "raster" ? InitialField::Over::raster : InitialField::Over::attribute;
    if (!read_source(*table, map, at, found.source)) {
      return false;
    }
  } else if (table != nullptr) {
    found.over = has_exactly(*table, "depth") ? InitialField::Over::depth : InitialField::Over::x;
    const char* abscissa = found.over == InitialField::Over::depth ? "depth" : "x";
    if (!has_exactly(*table, abscissa)) {
      return fail_keys(node, at);
    }
    if (!read_table(*table, abscissa, at, found.table)) {
      return false;
    }
  } else {
    double number = 0.0;
    if (!at.number_in_range(node, number)) {
      return false;
    }
    found = InitialField(number);
  }
  value = std::move(found);
  return true;
}
std::string Value<InitialField>::write(const InitialField& value, const Rule&, const WriteContext& context) {
  if (value.is_map()) {
    return write_source(value.over == InitialField::Over::raster ? "raster" : "attribute", value.source, context);
  }
  return write_table(value.table, value.over == InitialField::Over::depth ? "depth" : "x");
}
json Value<InitialField>::schema(const Rule& rule) {
  json schema = table_schema({"depth", "x"}, rule);
  schema["anyOf"].push_back(source_schema("attribute"));
  schema["anyOf"].push_back(source_schema("raster"));
  return schema;
}

// map value
std::string Value<MapValue>::type(const Rule& rule) {
  return fmt::format("a number, {{ attribute = \"NAME\" }}, {{ raster = \"FILE\" }} or {{ surface = \"FILE\" }}{}",
                     range_and_unit(rule));
}
bool Value<MapValue>::read(const toml::node& node, const ValueReader& at, MapValue& value) {
  const toml::table* table = node.as_table();
  if (table == nullptr) {
    value = MapValue{};
    return at.number_in_range(node, value.number);
  }
  const std::string key = only_key(*table, {"attribute", "raster", "surface"});
  if (key.empty()) {
    return fail_keys(node, at);
  }
  for (const MapKeyword& keyword : map_keywords) {
    value.from = key == keyword.key ? keyword.from : value.from;  // valid regardless of problems with the source
  }
  return read_source(*table, key, at, value.source);
}
std::string Value<MapValue>::write(const MapValue& value, const Rule&, const WriteContext& context) {
  for (const MapKeyword& keyword : map_keywords) {
    if (value.from == keyword.from) {
      return write_source(keyword.key, value.source, context);
    }
  }
  return number_text(value.number);
}
json Value<MapValue>::schema(const Rule& rule) {
  json any_of = json::array({Value<double>::schema(rule)});
  for (const MapKeyword& keyword : map_keywords) {
    any_of.push_back(source_schema(keyword.key));
  }
  return {{"anyOf", any_of}};
}

// release time
std::string Value<ReleaseTime>::type(const Rule& rule) {
  return fmt::format("a number or {{ attribute = \"NAME\" }}{}", range_and_unit(rule));
}
bool Value<ReleaseTime>::read(const toml::node& node, const ValueReader& at, ReleaseTime& value) {
  const toml::table* table = node.as_table();
  if (table == nullptr) {
    value = ReleaseTime{};
    return at.number_in_range(node, value.number);
  }
  const std::string key = only_key(*table, {"attribute"});
  return key.empty() ? fail_keys(node, at) : read_source(*table, key, at, value.attribute);
}
std::string Value<ReleaseTime>::write(const ReleaseTime& value, const Rule&, const WriteContext& context) {
  return value.attribute.empty() ? number_text(value.number) : write_source("attribute", value.attribute, context);
}
json Value<ReleaseTime>::schema(const Rule& rule) {
  return {{"anyOf", json::array({Value<double>::schema(rule), source_schema("attribute")})}};
}

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
    return at.fail(number, fmt::format("has the temperature {}; allowed: > -273.15 C", plain_number(found.value)));
  }
  value = found;
  return true;
}
std::string Value<HeatBoundary>::write(const HeatBoundary& value, const Rule&, const WriteContext&) {
  switch (value.kind) {
    case HeatBoundaryKind::temperature:
      return fmt::format("{{ temperature = {} }}", number_text(value.value));
    case HeatBoundaryKind::flux:
      return fmt::format("{{ flux = {} }}", number_text(value.value));
    case HeatBoundaryKind::insulated:
      break;
  }
  return quoted("insulated");
}
json Value<HeatBoundary>::schema(const Rule&) {
  const auto object = [](const char* key) {
    return json{{"type", "object"},
                {"additionalProperties", false},
                {"required", json::array({key})},
                {"properties", {{key, {{"type", "number"}}}}}};
  };
  return {{"anyOf", json::array({json{{"enum", json::array({"insulated"})}}, object("temperature"), object("flux")})}};
}

}  // namespace thawslide::config
