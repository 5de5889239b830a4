#include "app/notes.hpp"

#include "app/print.hpp"

namespace thawslide::app {

void Notes::add(const std::string& text) {
  if (text.empty()) {
    return;
  }
  if (form_ == Form::printed) {
    print_text("note: {}\n", text);
  }
  all_.push_back(text);
}

void Notes::add(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    add(text);
  }
}

}  // namespace thawslide::app
