// Warnings and notes about a case, other than results and errors: reported immediately, and kept.
#pragma once

#include <string>
#include <vector>

#include "run/observer.hpp"

namespace thawslide::run {

// "warning: " and the text. Information, which needs no action, begins with "note: " instead.
[[nodiscard]] std::string warning_line(const std::string& text);

class Warnings {
 public:
  // observer: reports each warning at once; null: they are only kept.
  explicit Warnings(Observer* observer = nullptr) : observer_(observer) {}

  // Ignores an empty text.
  void add(const std::string& text);
  void add(const std::vector<std::string>& texts);

  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

 private:
  Observer* observer_;
  std::vector<std::string> all_;
};

}  // namespace thawslide::run
