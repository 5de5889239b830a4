// Problems found in a case file, collected with their locations so that all are reported together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace thawslide::config {

// Location of a value: a file with line and column (both from 1; 0: the file as a whole), or a `--set` text.
struct Location {
  std::string source;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  bool command_line = false;

  // "cases/lamplugh/case.toml:12:7" or "--set band.thicknes=0.1".
  [[nodiscard]] std::string text() const;
};

class Problems {
 public:
  void add(Location location, std::string message);
  [[nodiscard]] bool empty() const { return found_.empty(); }

  // Throws a UserError with every problem, one per line, in the order of their locations; returns if there is none.
  void raise_if_any() const;

 private:
  struct Problem {
    Location location;
    std::string message;
  };
  std::vector<Problem> found_;
};

// Candidate with the smallest edit distance, if it is a likely misspelling; empty otherwise.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

// Text such as "; did you mean 'thickness'?", or `otherwise` if no candidate is similar.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                         const std::string& otherwise = "");

// "a, b, c"
std::string comma_list(const std::vector<std::string>& words);

}  // namespace thawslide::config
