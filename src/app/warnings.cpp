#include "app/warnings.hpp"

#include "app/print.hpp"

namespace thawslide::app {

void Warnings::add(const std::string& text) {
  if (text.empty()) {
    return;
  }
  if (form_ == Form::printed) {
    print_text("warning: {}\n", text);
  }
  all_.push_back(text);
}

void Warnings::add(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    add(text);
  }
}

}  // namespace thawslide::app
