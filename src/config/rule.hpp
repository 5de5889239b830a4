// Rule of a parameter, independent of its storage: key, unit, range, text and source.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace thawslide::config {

// Allowed numbers, each end open or closed. An infinite end is always open unless infinity itself is allowed.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
  bool infinity_allowed = false;

  [[nodiscard]] bool contains(double value) const;
  // "> 0", ">= 0", "between 0 and 1, ends excluded", "any number"
  [[nodiscard]] std::string text() const;
};

inline Range above(double low) { return {.low = low, .low_open = true}; }
inline Range at_least(double low) { return {.low = low}; }
// Both ends included.
inline Range between(double low, double high) { return {.low = low, .high = high}; }
// Both ends excluded.
inline Range inside(double low, double high) { return {low, high, true, true}; }

// Usual range of a number. Values outside it are allowed but reported. The ranges are assumptions.
struct Usual {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  const char* where = "";  // "for ice bonds"

  [[nodiscard]] bool is_specified() const;
  [[nodiscard]] bool contains(double value) const { return value >= low && value <= high; }
  // Text such as "0.01 to 2 (assumption)", "1 to 100 for ice bonds (assumption)"; empty if no range is specified
  [[nodiscard]] std::string text(const std::string& unit = "") const;
};

// Keyword allowed as the value of a key.
struct Keyword {
  std::string name;
  std::string text;
};

struct Rule {
  std::string key = {};
  std::string unit = {};
  Range range = {};
  std::string text = {};               // description in one line
  std::string source = {};             // publication, with equation, section or table
  std::vector<Keyword> keywords = {};  // keywords allowed, for a text that is one of a few
  int dimension = 0;                   // 2 or 3: allowed only in this dimension
  bool is_path = false;                // a file, relative to the case file
  bool horizontal = false;             // of a point: x and y only, in three dimensions too
  Usual usual = {};
};

// Shortest decimal text that reads back to the same number, in TOML form: always with a point or an exponent.
std::string number_text(double value);
// The same for messages: without the ".0".
std::string plain_number(double value);

}  // namespace thawslide::config
