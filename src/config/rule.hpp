// What a parameter may be, apart from where it is stored: key, unit, range, text and source, all said once.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace thawslide::config {

// The allowed numbers, each end open or closed. An infinite end is always open unless infinity itself is allowed.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
  bool infinity_allowed = false;

  [[nodiscard]] bool holds(double value) const;
  // "> 0", ">= 0", "between 0 and 1, ends excluded", "any number"
  [[nodiscard]] std::string text() const;
};

Range above(double low);
Range at_least(double low);
// Both ends included.
Range between(double low, double high);
// Both ends excluded.
Range inside(double low, double high);

// The numbers that are usual. Nothing holds a case to them; it is told where it has others. Their sources are not
// checked.
struct Usual {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  const char* where = "";  // "on a glacier"

  [[nodiscard]] bool is_specified() const;
  [[nodiscard]] bool holds(double value) const { return value >= low && value <= high; }
  // "0.01 to 2 (not checked)", "0.05 to 0.15 on a glacier (not checked)"; empty where none is told
  [[nodiscard]] std::string text(const std::string& unit = "") const;
};

// One of the words a key may hold.
struct Keyword {
  std::string word;
  std::string text;
};

struct Rule {
  std::string key = {};
  std::string unit = {};
  Range range = {};
  std::string text = {};            // what it is, in a line
  std::string source = {};          // equation, section or table of the paper, or another source
  std::vector<Keyword> words = {};  // the words allowed, for a text that is one of a few
  int dimension = 0;                // 2 or 3: has a meaning only there
  bool is_path = false;             // a file, told relative to the case file
  bool horizontal = false;          // of a point: x and y only, in three dimensions too
  Usual usual = {};
  std::string formerly = {};  // what the key was called before; a file that still says so is told the new name
};

// Shortest decimal text that reads back to the same number, as TOML wants it: always with a point or an exponent.
std::string number_text(double value);
// The same for people: without the ".0".
std::string plain_number(double value);

}  // namespace thawslide::config
