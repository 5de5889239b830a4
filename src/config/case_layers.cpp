#include "config/case_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "config/declaration.hpp"
#include "config/input_limits.hpp"

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

bool is_of_key(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '-' || letter == '"' ||
         letter == '\'';
}

// The parser handles dotted keys recursively, so their depth is limited. Other text with as many dots between words is
// refused too.
void require_shallow(const std::string& text, const std::string& file) {
  std::size_t line = 1, parts = 1;
  char before = '\0';  // excluding blanks
  bool after_dot = false;
  for (const char letter : text) {
    if (letter == ' ' || letter == '\t') {
      continue;
    }
    parts += after_dot && is_of_key(letter) ? 1 : 0;
    after_dot = letter == '.' && is_of_key(before);
    before = letter;
    if (parts > most_key_parts) {
      throw UserError(
          "{}:{}: this is not a case: a key of more than {} parts; allowed: TABLE.NAME.KEY. Is it the right file?",
          file, line, most_key_parts);
    }
    if (std::string_view(",=[]{}\n").find(letter) != std::string_view::npos) {
      parts = 1;
    }
    line += letter == '\n' ? 1 : 0;
  }
}

// Advice on the probable cause of a parser error.
std::string likely_slip(std::string_view description) {
  const std::string_view end = "expected a comment or whitespace, saw '";
  const std::size_t at = description.find(end);
  const char seen = at == std::string_view::npos ? '\0' : description[at + end.size()];
  if (seen == ',') {
    return "Write a decimal point, not a comma. ";
  }
  if (std::isalpha(static_cast<unsigned char>(seen)) != 0) {
    return "Write numbers without units, and text in quotes. ";
  }
  return description.find("cannot redefine") == std::string_view::npos ? "" : "A table contains a key only once. ";
}

toml::table parse(const std::string& text, const std::string& file) {
  require_shallow(text, file);
  try {
    toml::table root = toml::parse(text, std::string_view(file));
    if (root.empty()) {
      throw UserError("{}:1:1: the file is empty; a case has at least [time], [grid], [material.NAME] and [body.NAME].",
                      file);
    }
    return root;
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw UserError("{}:{}:{}: this is not TOML: {}. {}Correct the line; see https://toml.io for the syntax.", file,
                    begin.line, begin.column, shown(std::string(error.description())),
                    likely_slip(error.description()));
  }
}

// File named by case.based_on, if any; `chain`: the files that led here.
std::optional<fs::path> base_of(const toml::table& root, const std::vector<CaseFile>& chain) {
  const fs::path& file = chain.back().file;
  const auto* node = root.at_path("case.based_on").node();
  const auto* text = node == nullptr ? nullptr : node->as_string();
  if (text == nullptr || text->get().empty()) {
    return std::nullopt;  // a value of another type is reported with the other keys
  }
  const auto& begin = node->source().begin;
  const std::string location =
      fmt::format("{}:{}:{}: case.based_on is \"{}\"", file.string(), begin.line, begin.column, shown(text->get()));
  const fs::path name(text->get());
  const fs::path base = file.parent_path() / name;
  if (name.has_parent_path()) {
    throw UserError(location + ", which is a path; allowed: the name of a case file of the same folder.");
  }
  std::error_code error;
  if (!fs::is_regular_file(base, error)) {
    throw UserError(location + ": no such file; allowed: the name of a case file of the same folder.");
  }
  if (!lies_within(base, file.parent_path())) {
    throw UserError(location + ", a link that leads out of the folder; allowed: a case file in it. Copy it there.");
  }
  if (std::any_of(chain.begin(), chain.end(), [&base](const CaseFile& each) { return each.file == base; })) {
    throw UserError(location + ": the chain of files forms a cycle. Remove based_on from one of the files.");
  }
  return base;
}

// True for the name of a table, "body.slide", or of one that contains tables. Others are values: { raster = "a.tif" }.
bool names_a_table(const std::string& dotted) {
  return std::any_of(tables().begin(), tables().end(), [&](const auto& table) {
    const std::string inside = dotted + ".", outside = table->name + ".";
    const bool is_named_one = table->is_named() && dotted.compare(0, outside.size(), outside) == 0 &&
                              dotted.find('.', outside.size()) == std::string::npos;
    return table->name == dotted || table->name.compare(0, inside.size(), inside) == 0 || is_named_one;
  });
}

// Moves the contents of `over` into `under`, both of this dotted name; tables are merged, everything else is replaced.
void merge_over(toml::table& under, toml::table&& over, const std::string& dotted) {
  for (auto&& entry : over) {
    const toml::key& key = entry.first;
    toml::node& node = entry.second;
    toml::table* inner = under.get_as<toml::table>(key.str());
    const std::string name = (dotted.empty() ? "" : dotted + ".") + std::string(key.str());
    if (inner != nullptr && node.is_table() && names_a_table(name)) {
      merge_over(*inner, std::move(*node.as_table()), name);
    } else {
      node.visit([&](auto& value) { under.insert_or_assign(key, std::move(value)); });
    }
  }
}

std::set<std::uint32_t> lines_not_given(std::string_view text) {
  std::set<std::uint32_t> lines;
  std::uint32_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view words = text.substr(begin, end - begin), mark = not_given_mark;
    if (words.size() > mark.size() && words.substr(words.size() - mark.size()) == mark &&
        words.find('#') != std::string_view::npos) {
      lines.insert(line);
    }
    begin = end + 1;
  }
  return lines;
}

std::vector<std::string> split_at_dots(const std::string& key) {
  std::vector<std::string> parts;
  std::istringstream stream(key + ".");
  for (std::string part; std::getline(stream, part, '.');) {
    parts.push_back(part);
  }
  return parts;
}

Location location_of_set(const Override& override) {
  return {fmt::format("--set {}={}", override.key, override.value), 0, 0, true};
}

// Value as TOML; a bare word is a string. Returns nothing (and reports a problem) for invalid TOML.
std::optional<toml::table> parse_value(const Override& override, Reading& reading) {
  try {
    toml::table parsed = toml::parse("value = " + override.value, std::string_view("--set"));
    if (parsed.size() == 1) {
      return parsed;
    }
  } catch (const toml::parse_error& error) {
    const bool is_bare =
        std::string_view("[{\"'").find(override.value.empty() ? '"' : override.value.front()) == std::string_view::npos;
    if (is_bare) {
      toml::table text;
      text.insert_or_assign("value", override.value);
      return text;
    }
  }
  reading.report_at(location_of_set(override), override.key,
                    "'{}' is not one TOML value. Write for example --set band.thickness=0.1, --set grid.min='[0, 0]' "
                    "or --set terrain.type=flat.",
                    override.value);
  return std::nullopt;
}

// True if `--set` specifies a key that is always required or, in a table without such keys, one that has no default.
bool defines_table(const TableDeclaration& table, const std::string& own_name, const Reading& reading) {
  const std::vector<Entry> entries = table.entries();
  const auto is_needed = [](const Entry& entry) { return entry.required == "always"; };
  const bool has_needed = std::any_of(entries.begin(), entries.end(), is_needed);
  return std::any_of(entries.begin(), entries.end(), [&](const Entry& entry) {
    const bool has_no_default = entry.default_text.empty() && (!entry.otherwise.empty() || entry.only.empty());
    const std::string key = fmt::format("{}.{}.{}", table.name, own_name, entry.rule->key);
    return (has_needed ? is_needed(entry) : has_no_default) &&
           std::any_of(reading.overrides.begin(), reading.overrides.end(),
                       [&](const Override& override) { return override.key == key; });
  });
}

// Declaration of the named tables [NAME.x]; null if there are none.
const TableDeclaration* named_table(const std::string& name) {
  const auto found = std::find_if(tables().begin(), tables().end(),
                                  [&](const auto& table) { return table->is_named() && table->name == name; });
  return found == tables().end() ? nullptr : found->get();
}

// A key of a named table must be of a table in the file, or define one: a typing error would create a second body.
bool may_name_table(const Override& override, const std::vector<std::string>& parts, const toml::table& root,
                    Reading& reading) {
  if (parts.size() < 3) {
    return true;
  }
  const TableDeclaration* table = named_table(parts[0]);
  std::vector<std::string> names;
  if (const toml::table* found = root.get_as<toml::table>(parts[0])) {
    for (const auto& [key, node] : *found) {
      names.emplace_back(key.str());
    }
  }
  if (table == nullptr || std::find(names.begin(), names.end(), parts[1]) != names.end() ||
      defines_table(*table, parts[1], reading)) {
    return true;
  }
  reading.report_at(location_of_set(override), override.key, "there is no {} '{}'{} In the case file: {}.", parts[0],
                    parts[1], did_you_mean(parts[1], names, "."), names.empty() ? "none" : comma_list(names));
  return false;
}

// A named table has no value itself: one of its keys was intended.
bool fits_named_table(const Override& override, const std::vector<std::string>& parts, const toml::node& value,
                      Reading& reading) {
  if (parts.size() != 2 || named_table(parts[0]) == nullptr || value.is_table()) {
    return true;
  }
  reading.report_at(location_of_set(override), override.key,
                    "[{}] is a table, and {} no table. Set one of its keys: --set {}.KEY=VALUE.", override.key,
                    override.value, override.key);
  return false;
}

void apply_override(const Override& override, toml::table& root, Reading& reading) {
  const std::vector<std::string> parts = split_at_dots(override.key);
  if (!may_name_table(override, parts, root, reading)) {
    return;
  }
  const std::optional<toml::table> value = parse_value(override, reading);
  if (!value || !fits_named_table(override, parts, *value->get("value"), reading)) {
    return;
  }
  toml::table* table = &root;
  for (std::size_t k = 0; k + 1 < parts.size(); ++k) {
    toml::node* inner = table->get(parts[k]);
    if (inner == nullptr || !inner->is_table()) {
      table->insert_or_assign(parts[k], toml::table{});
    }
    table = table->get_as<toml::table>(parts[k]);
  }
  // The copy has no source location, by which Reading::location_of identifies the command line.
  value->get("value")->visit([&](const auto& node) { table->insert_or_assign(parts.back(), node); });
}

}  // namespace

std::vector<CaseFile> read_with_bases(const fs::path& file) {
  std::vector<CaseFile> files;
  for (std::optional<fs::path> next = file; next; next = base_of(parse(files.back().text, next->string()), files)) {
    require_size(*next, largest_case_file, "Profiles, polygons and rasters are separate files.");
    files.push_back({*next, read_text_file(*next)});
  }
  return files;
}

LayeredCase merged(const std::vector<CaseFile>& files) {
  LayeredCase result;
  for (auto each = files.rbegin(); each != files.rend(); ++each) {
    const std::string name = each->file.string();
    merge_over(result.root, parse(each->text, name), "");
    result.lines_not_given[name] = lines_not_given(each->text);
  }
  return result;
}

Override parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  const Override override{trimmed(text.substr(0, equals)),
                          equals == std::string::npos ? "" : trimmed(text.substr(equals + 1))};
  const std::vector<std::string> parts = split_at_dots(override.key);
  const bool has_key = std::none_of(parts.begin(), parts.end(), [](const std::string& part) { return part.empty(); });
  if (equals == std::string::npos || !has_key) {
    throw UserError("--set {}: allowed: TABLE.KEY=VALUE, for example --set band.thickness=0.1.", text);
  }
  return override;
}

void apply_overrides(toml::table& root, Reading& reading) {
  for (const Override& override : reading.overrides) {
    apply_override(override, root, reading);
  }
}

}  // namespace thawslide::config
