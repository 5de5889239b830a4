// Problems found in a case file: each with its place, gathered so that all of them reach the user together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace thawslide::config {

// Where a value was written: a file with line and column (both from 1; 0: the file as a whole), or a `--set` text.
struct Place {
  std::string source;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  bool command_line = false;

  // "cases/lamplugh/case.toml:12:7" or "--set band.thicknes=0.1".
  [[nodiscard]] std::string text() const;
};

class Problems {
 public:
  void add(Place place, std::string message);
  [[nodiscard]] bool empty() const { return found_.empty(); }

  // Throws a UserError holding every problem, one a line, in the order of their places; returns if there is none.
  void raise_if_any() const;

 private:
  struct Problem {
    Place place;
    std::string message;
  };
  std::vector<Problem> found_;
};

// Number of single-letter edits (insert, delete, replace, swap of neighbours) from one word to the other, letter case
// and '-' against '_' ignored.
std::size_t edit_distance(const std::string& first, const std::string& second);

// The candidate with the smallest edit distance, if it is near enough to be a likely misspelling; empty otherwise.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

// "; did you mean 'thickness'?", or nothing where no candidate is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

// "a, b, c"
std::string comma_list(const std::vector<std::string>& words);

}  // namespace thawslide::config
