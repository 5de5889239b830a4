// Warnings and notes about a case, other than results and errors: printed immediately, or collected for JSON output.
#pragma once

#include <string>
#include <vector>

namespace thawslide::app {

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
