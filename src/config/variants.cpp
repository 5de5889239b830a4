#include "config/variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "config/declaration.hpp"
#include "config/input_limits.hpp"
#include "config/reading.hpp"

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  require_size(file, largest_case_file, "Profiles, polygons and rasters are separate files.");
  return read_text_file(file);
}

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
      throw UserError(fmt::format(
          "{}:{}: this is not a case: a key of more than {} parts; allowed: TABLE.NAME.KEY. Is it the right file?",
          file, line, most_key_parts));
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
      throw UserError(fmt::format(
          "{}:1:1: the file is empty; a case has at least [time], [grid], [material.NAME] and [body.NAME].", file));
    }
    return root;
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw UserError(fmt::format(
        "{}:{}:{}: this is not TOML: {}. {}Correct the line; see https://toml.io for the syntax.", file, begin.line,
        begin.column, shown(std::string(error.description())), likely_slip(error.description())));
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
  if (chain.size() >= most_case_files) {
    throw UserError(fmt::format("{}: a chain of {} files precedes it; allowed: {}. Combine some of them.", location,
                                chain.size(), most_case_files));
  }
  if (std::any_of(chain.begin(), chain.end(), [&base](const CaseFile& each) { return each.file == base; })) {
    throw UserError(location + ": the chain of files forms a cycle. Remove based_on from one of the files.");
  }
  return base;
}

// True if tables of the case have this dotted name, or lie inside it: "grid", "body", "body.slide". All other tables
// are values: { raster = "thickness.tif" }.
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

}  // namespace

std::vector<CaseFile> read_with_bases(const fs::path& file) {
  std::vector<CaseFile> files;
  for (std::optional<fs::path> next = file; next; next = base_of(parse(files.back().text, next->string()), files)) {
    files.push_back({*next, read_text(*next)});
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

}  // namespace thawslide::config
