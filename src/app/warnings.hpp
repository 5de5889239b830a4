// Warnings and notes about a case, other than results and errors: printed immediately, or collected for JSON output.
#pragma once

#include <string>
#include <vector>

namespace thawslide::app {

// Prints "warning: " and the text. Information, which needs no action, begins with "note: " instead.
void print_warning(const std::string& text);

class Warnings {
 public:
  enum class Form { printed, kept };
  explicit Warnings(Form form = Form::printed) : form_(form) {}

  // Ignores an empty text.
  void add(const std::string& text);
  void add(const std::vector<std::string>& texts);

  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

 private:
  Form form_;
  std::vector<std::string> all_;
};

}  // namespace thawslide::app
