#include "config/table_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "base/error.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"
#include "config/text_file.hpp"

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_columns_listed = 12;

// Length in bytes of the UTF-8 character at the beginning of the text; 0 if it is invalid.
std::size_t length_of_sign(std::string_view text) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned first = byte(0), second = byte(1);
  const std::size_t length = first < 0x80                     ? 1
                             : first >= 0xC2 && first <= 0xDF ? 2
                             : first >= 0xE0 && first <= 0xEF ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  for (std::size_t k = 1; k < length; ++k) {
    if (byte(k) < 0x80 || byte(k) > 0xBF) {
      return 0;
    }
  }
  // Overlong, a surrogate, or beyond the last code point.
  const bool is_wrong = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                        (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
  return is_wrong ? 0 : length;
}

long line_of(std::string_view text, std::size_t offset) {
  return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
}

std::string with_plain_line_ends(std::string_view text) {
  std::string plain;
  for (std::size_t offset = 0; offset < text.size(); ++offset) {
    if (text[offset] == '\r') {
      plain += '\n';
      offset += text.substr(offset, 2) == "\r\n" ? 1U : 0U;
    } else {
      plain += text[offset];
    }
  }
  return plain;
}

std::string read_text(const std::string& file, double max_bytes) {
  require_size(file, max_bytes, "Is it the right file?");
  std::string text = read_text_file(file);
  const auto begins_with = [&](std::string_view mark) { return text.compare(0, mark.size(), mark) == 0; };
  using namespace std::string_view_literals;
  if (begins_with("\xFF\xFE\0\0"sv) || begins_with("\0\0\xFE\xFF"sv)) {
    throw UserError(fmt::format("{}: encoded as UTF-32; save it as UTF-8", file));
  }
  if (begins_with("\xFF\xFE") || begins_with("\xFE\xFF")) {
    throw UserError(fmt::format("{}: encoded as UTF-16; save it as UTF-8", file));
  }
  if (begins_with("\xEF\xBB\xBF")) {
    text.erase(0, 3);
  }
  for (std::size_t offset = 0; offset < text.size();) {
    const std::size_t length = length_of_sign(std::string_view(text).substr(offset, 4));
    if (length == 0) {
      throw UserError(fmt::format("{}:{}: byte 0x{:02x} is not UTF-8; save the file as UTF-8", file,
                                  line_of(text, offset), static_cast<unsigned char>(text[offset])));
    }
    offset += length;
  }
  const std::string plain = with_plain_line_ends(text);
  if (const std::size_t zero = plain.find('\0'); zero != std::string::npos) {
    throw UserError(
        fmt::format("{}:{}: a zero byte; this is not a text file, or it is damaged", file, line_of(plain, zero)));
  }
  return plain;
}

// A cell may be quoted, and must be if it contains a comma; a quote in it is doubled.
std::vector<std::string> cells_of(std::string_view line, const std::string& where) {
  const auto fail = [&](const char* why) {
    throw UserError(fmt::format("{}: not a row of comma-separated cells: {}", where, why));
  };
  std::vector<std::string> cells;
  for (std::size_t offset = 0; offset <= line.size(); ++offset) {
    std::string cell;
    if (offset < line.size() && line[offset] == '"') {
      for (++offset; offset < line.size() && (line[offset] != '"' || line.substr(offset, 2) == "\"\""); ++offset) {
        offset += line[offset] == '"' ? 1U : 0U;
        cell += line[offset];
      }
      if (offset == line.size()) {
        fail("a quote that does not end");
      }
      ++offset;
      if (offset < line.size() && line[offset] != ',') {
        fail("a comma is expected after a quote that ends");
      }
    } else {
      const std::size_t end = std::min(line.find(',', offset), line.size());
      cell = line.substr(offset, end - offset);
      offset = end;
    }
    cells.push_back(trimmed(cell));
  }
  return cells;
}

void require_columns(const TableCsv& table, const std::string& where, const std::vector<std::string>& needed) {
  for (const std::string& name : needed) {
    if (std::find(table.columns.begin(), table.columns.end(), name) == table.columns.end()) {
      std::vector<std::string> found;
      std::transform(
          table.columns.begin(),
          table.columns.begin() + static_cast<std::ptrdiff_t>(std::min(table.columns.size(), most_columns_listed)),
          std::back_inserter(found), in_quotes);
      const bool by_semicolons = table.columns.size() == 1 && table.columns[0].find(';') != std::string::npos;
      throw UserError(fmt::format("{}: no column {}; found {}{}{}", where, name, fmt::join(found, ", "),
                                  found.size() < table.columns.size() ? ", ..." : "",
                                  by_semicolons ? ". Columns are parted by commas: write , in place of ;" : ""));
    }
  }
  for (auto name = table.columns.begin(); name != table.columns.end(); ++name) {
    if (std::find(table.columns.begin(), name, *name) != name) {
      throw UserError(fmt::format("{}: two columns {}", where, in_quotes(*name)));
    }
  }
}

}  // namespace

TableCsv read_table_csv(const fs::path& file, const std::vector<std::string>& needed, double max_bytes) {
  const std::string name = file.string(), text = read_text(name, max_bytes);
  TableCsv table;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (trimmed(line).empty() || line.front() == '#') {
      continue;
    }
    const std::string where = fmt::format("{}:{}", name, number);
    std::vector<std::string> cells = cells_of(line, where);
    if (table.line > 0) {
      table.rows.push_back({number, std::move(cells)});
      continue;
    }
    table.columns = std::move(cells);
    table.line = number;
    require_columns(table, where, needed);
  }
  if (table.line == 0) {
    throw UserError(fmt::format("{}: empty; expected the columns {}", name, fmt::join(needed, ", ")));
  }
  return table;
}

std::string hint_of(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest(shown(word), known);
  return near.empty() ? "." : "; did you mean " + near + "?";
}

void require_known_columns(const TableCsv& table, const std::string& file, const std::vector<std::string>& allowed) {
  for (const std::string& name : table.columns) {
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
      throw UserError(fmt::format("{}:{}: no column is called {}{} allowed are {}", file, table.line, in_quotes(name),
                                  hint_of(name, allowed), comma_list(allowed)));
    }
  }
}

std::string read_finite_number(const std::string& cell, double& value) {
  const char* begin = cell.data() + (!cell.empty() && cell.front() == '+' ? 1 : 0);
  const char* end = cell.data() + cell.size();
  const auto result = std::from_chars(begin, end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) {
    const bool has_decimal_comma = std::count(cell.begin(), cell.end(), ',') == 1;
    return fmt::format("expected a number, found {}{}", in_quotes(cell),
                       has_decimal_comma ? "; write the decimals behind a point" : "");
  }
  if (result.ec == std::errc::result_out_of_range) {
    value = std::strtod(begin, nullptr);  // infinite, or almost 0
  }
  return std::isfinite(value) ? "" : fmt::format("expected a finite number, found {}", in_quotes(cell));
}

}  // namespace thawslide::config
