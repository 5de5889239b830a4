#include "config/values.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "config/input_limits.hpp"

namespace thawslide::config {

namespace {

using nlohmann::json;

constexpr const char* automatic = "auto";

std::string with_range(const std::string& type, const Rule& rule) {
  const std::string range = rule.range.text();
  const std::string unit = rule.unit.empty() ? "" : " [" + rule.unit + "]";
  return range == "any number" ? type + unit : fmt::format("{}, {}{}", type, range, unit);
}

json range_schema(const Range& range, const char* type) {
  json schema = {{"type", type}};
  if (std::isfinite(range.low)) {
    schema[range.low_open ? "exclusiveMinimum" : "minimum"] = range.low;
  }
  if (std::isfinite(range.high)) {
    schema[range.high_open ? "exclusiveMaximum" : "maximum"] = range.high;
  }
  return schema;
}

json array_schema(const json& items) { return {{"type", "array"}, {"items", items}}; }

json number_schema() { return {{"type", "number"}}; }

// "[a, b]" of the texts of elements.
template <class Elements, class Text>
std::string array_text(const Elements& elements, const Text& text_of) {
  std::vector<std::string> texts;
  std::transform(elements.begin(), elements.end(), std::back_inserter(texts), text_of);
  return "[" + comma_list(texts) + "]";
}

}  // namespace

// Rules of numbers (rule.hpp).
bool Range::contains(double value) const {
  if (std::isnan(value) || (std::isinf(value) && !infinity_allowed)) {
    return false;
  }
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
  const bool has_low = std::isfinite(low);
  const bool has_high = std::isfinite(high);
  std::string text = "any number";
  if (has_low && has_high && low_open == high_open) {
    text = fmt::format("between {} and {}, ends {}", plain_number(low), plain_number(high),
                       low_open ? "excluded" : "included");
  } else if (has_low && has_high) {
    text = fmt::format("{} {} and {} {}", low_open ? ">" : ">=", plain_number(low),
                       high_open ? "<" : "<=", plain_number(high));
  } else if (has_low) {
    text = fmt::format("{} {}", low_open ? ">" : ">=", plain_number(low));
  } else if (has_high) {
    text = fmt::format("{} {}", high_open ? "<" : "<=", plain_number(high));
  }
  return infinity_allowed ? text + ", or inf" : text;
}

bool Usual::is_specified() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return low > -infinity || high < infinity;
}

std::string Usual::text(const std::string& unit) const {
  return is_specified() ? fmt::format("{:g} to {:g}{}{}{}{} (assumption)", low, high, unit.empty() ? "" : " ", unit,
                                      *where == '\0' ? "" : " ", where)
                        : "";
}

std::string plain_number(double value) { return fmt::format("{}", value); }

std::string number_text(double value) {
  const std::string text = plain_number(value);
  return text.find_first_of(".enia") == std::string::npos ? text + ".0" : text;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') {
      result += '\\';
      result += letter;
    } else if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(letter)));
    } else {
      result += letter;
    }
  }
  return result + "\"";
}

std::string path_text(const std::string& path, const WriteContext& context) {
  const std::filesystem::path whole(path);
  const bool is_copied = !context.input_folder.empty();
  return quoted((is_copied ? context.input_folder / whole.filename() : whole).generic_string());
}

std::string keyword_list(const std::vector<Keyword>& keywords) {
  const std::string list = array_text(keywords, [](const Keyword& keyword) { return quoted(keyword.name); });
  return list.substr(1, list.size() - 2);
}

json keyword_schema(const std::vector<Keyword>& keywords) {
  json names = json::array();
  for (const Keyword& keyword : keywords) {
    names.push_back(keyword.name);
  }
  return {{"enum", names}};
}

bool read_keyword(const toml::node& node, const ValueReader& at, const std::vector<Keyword>& keywords,
                  std::string& found) {
  const auto* text = node.as_string();
  if (text == nullptr) {
    return at.fail_type(node);
  }
  std::vector<std::string> names;
  for (const Keyword& keyword : keywords) {
    names.push_back(keyword.name);
  }
  if (std::find(names.begin(), names.end(), text->get()) == names.end()) {
    const std::string hint = did_you_mean(text->get(), names);
    return at.fail(node, "is \"{}\"{}: {}", shown(text->get()), hint.empty() ? "; allowed" : hint + " Allowed",
                   keyword_list(keywords));
  }
  found = text->get();
  return true;
}

// double
std::string Value<double>::type(const Rule& rule) { return with_range("a number", rule); }
bool Value<double>::read(const toml::node& node, const ValueReader& at, double& value) {
  return at.number_in_range(node, value);
}
std::string Value<double>::write(const double& value, const Rule&, const WriteContext&) { return number_text(value); }
json Value<double>::schema(const Rule& rule) { return range_schema(rule.range, "number"); }

// number or "auto"
std::string Value<NumberOrAuto>::type(const Rule& rule) { return with_range("a number", rule) + ", or \"auto\""; }
bool Value<NumberOrAuto>::read(const toml::node& node, const ValueReader& at, NumberOrAuto& value) {
  const auto* text = node.as_string();
  NumberOrAuto found{.is_auto = text != nullptr && text->get() == automatic};
  if (!found.is_auto && !at.number_in_range(node, found.number)) {
    return false;
  }
  value = found;
  return true;
}
std::string Value<NumberOrAuto>::write(const NumberOrAuto& value, const Rule&, const WriteContext&) {
  return value.is_auto ? quoted(automatic) : number_text(value.number);
}
json Value<NumberOrAuto>::schema(const Rule& rule) {
  return {{"anyOf", json::array({json{{"enum", json::array({automatic})}}, range_schema(rule.range, "number")})}};
}

// int
std::string Value<int>::type(const Rule& rule) { return with_range("a whole number", rule); }
bool Value<int>::read(const toml::node& node, const ValueReader& at, int& value) {
  double number = 0.0;
  if (!node.is_integer()) {
    return at.fail_type(node);
  }
  if (!at.number_in_range(node, number)) {
    return false;
  }
  constexpr double largest = std::numeric_limits<int>::max();
  if (std::abs(number) > largest) {
    return at.fail(node, "is {:.0f}; allowed: whole numbers up to {:.0f} ({})", number, largest, at.rule.text);
  }
  value = static_cast<int>(number);
  return true;
}
std::string Value<int>::write(const int& value, const Rule&, const WriteContext&) { return fmt::format("{}", value); }
json Value<int>::schema(const Rule& rule) { return range_schema(rule.range, "integer"); }

// bool
std::string Value<bool>::type(const Rule&) { return "true or false"; }
bool Value<bool>::read(const toml::node& node, const ValueReader& at, bool& value) {
  const auto* truth = node.as_boolean();
  if (truth == nullptr) {
    return at.fail_type(node);
  }
  value = truth->get();
  return true;
}
std::string Value<bool>::write(const bool& value, const Rule&, const WriteContext&) { return value ? "true" : "false"; }
json Value<bool>::schema(const Rule&) { return {{"type", "boolean"}}; }

// text: a title, a name, a keyword, or a path
std::string Value<std::string>::type(const Rule& rule) {
  if (!rule.keywords.empty()) {
    return "one of " + keyword_list(rule.keywords);
  }
  return rule.is_path ? "the path of a file, in quotes" : "a text in quotes";
}
bool Value<std::string>::read(const toml::node& node, const ValueReader& at, std::string& value) {
  if (!at.rule.keywords.empty()) {
    return read_keyword(node, at, at.rule.keywords, value);
  }
  const auto* text = node.as_string();
  if (text == nullptr) {
    return at.fail_type(node);
  }
  std::string found = text->get();
  if (at.rule.is_path && !found.empty() && !at.resolve_path(node, found)) {
    return false;
  }
  value = std::move(found);
  return true;
}
std::string Value<std::string>::write(const std::string& value, const Rule& rule, const WriteContext& context) {
  return rule.is_path && !value.empty() ? path_text(value, context) : quoted(value);
}
json Value<std::string>::schema(const Rule& rule) {
  return rule.keywords.empty() ? json{{"type", "string"}} : keyword_schema(rule.keywords);
}

// texts
std::string Value<Names>::type(const Rule&) { return "an array of texts in quotes"; }
bool Value<Names>::read(const toml::node& node, const ValueReader& at, Names& value) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    return at.fail_type(node);
  }
  Names found;
  for (const toml::node& element : *array) {
    const auto* text = element.as_string();
    if (text == nullptr) {
      return at.fail(element, "holds {}; allowed: {}", describe_node(element), at.allowed);
    }
    found.push_back(text->get());
  }
  value = std::move(found);
  return true;
}
std::string Value<Names>::write(const Names& value, const Rule&, const WriteContext&) {
  return array_text(value, quoted);
}
json Value<Names>::schema(const Rule&) { return array_schema({{"type", "string"}}); }

// point
std::string Value<Point>::type(const Rule& rule) {
  return fmt::format("an array of 2 numbers, x and y{}{}", rule.horizontal ? "" : " (3 in three dimensions)",
                     rule.unit.empty() ? "" : " [" + rule.unit + "]");
}
bool Value<Point>::read(const toml::node& node, const ValueReader& at, Point& value) {
  std::vector<double> found;
  if (!at.numbers(node, found, false)) {
    return false;
  }
  const std::size_t size = found.size(),
                    dimension = at.rule.horizontal ? 2U : static_cast<std::size_t>(at.reading.dimension);
  if (dimension == 0 ? size != 2 && size != 3 : size != dimension) {
    const std::string allowed = at.rule.horizontal ? "2 numbers, x and y"
                                : dimension == 0   ? "2 or 3 numbers"
                                                   : fmt::format("{0} numbers, as case.dimension is {0}", dimension);
    return at.fail(node, "is an array of {} numbers; allowed: {}{}", size, allowed,
                   size > 0 && size == 2 * dimension ? ". Write decimal points, not commas" : "");
  }
  value = {found[0], found[1], found.size() > 2 ? found[2] : 0.0};
  return true;
}
std::string Value<Point>::write(const Point& value, const Rule& rule, const WriteContext& context) {
  const std::size_t count = context.dimension == 3 && !rule.horizontal ? 3 : 2;
  return array_text(std::vector<double>(value.begin(), value.begin() + count), number_text);
}
json Value<Point>::schema(const Rule& rule) {
  json schema = array_schema(number_schema());
  schema["minItems"] = 2;
  schema["maxItems"] = rule.horizontal ? 2 : 3;
  return schema;
}

// polygon
std::string Value<Vertices>::type(const Rule&) { return "an array of at least 3 pairs [x, y] [m]"; }
bool Value<Vertices>::read(const toml::node& node, const ValueReader& at, Vertices& value) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() < 3) {
    return at.fail_type(node);
  }
  Vertices found;
  for (const toml::node& element : *array) {
    std::vector<double> pair;
    if (!at.numbers(element, pair, false)) {
      return false;
    }
    if (pair.size() != 2) {
      return at.fail(element, "holds a vertex of {} numbers; allowed: pairs [x, y]", pair.size());
    }
    found.push_back({pair[0], pair[1]});
  }
  value = std::move(found);
  return true;
}
std::string Value<Vertices>::write(const Vertices& value, const Rule&, const WriteContext&) {
  return array_text(value, [](const auto& vertex) { return array_text(vertex, number_text); });
}
json Value<Vertices>::schema(const Rule&) {
  json schema = array_schema(array_schema(number_schema()));
  schema["minItems"] = 3;
  return schema;
}

// ascending numbers
std::string Value<Numbers>::type(const Rule& rule) { return with_range("an array of ascending numbers", rule); }
bool Value<Numbers>::read(const toml::node& node, const ValueReader& at, Numbers& value) {
  Numbers found;
  if (!at.numbers(node, found, true)) {
    return false;
  }
  for (std::size_t k = 1; k < found.size(); ++k) {
    if (!(found[k] > found[k - 1])) {
      return at.fail(*node.as_array()->get(k), "holds {} after {}; allowed: ascending numbers", plain_number(found[k]),
                     plain_number(found[k - 1]));
    }
  }
  value = std::move(found);
  return true;
}
std::string Value<Numbers>::write(const Numbers& value, const Rule&, const WriteContext&) {
  return array_text(value, number_text);
}
json Value<Numbers>::schema(const Rule& rule) { return array_schema(range_schema(rule.range, "number")); }

// Tables, initial fields, map values and heat boundaries: value_tables.cpp.

}  // namespace thawslide::config
