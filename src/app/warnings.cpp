#include "app/warnings.hpp"

#include "app/print.hpp"

namespace thawslide::app {

void print_warning(const std::string& text) {
  print_text("{}{}\n", text.rfind("note: ", 0) == 0 ? "" : "warning: ", text);
}

void Warnings::add(const std::string& text) {
  if (text.empty()) {
    return;
  }
  if (form_ == Form::printed) {
    print_warning(text);
  }
  all_.push_back(text);
}

void Warnings::add(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    add(text);
  }
}

}  // namespace thawslide::app
