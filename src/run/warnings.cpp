#include "run/warnings.hpp"

namespace thawslide::run {

std::string warning_line(const std::string& text) { return (text.rfind("note: ", 0) == 0 ? "" : "warning: ") + text; }

void Warnings::add(const std::string& text) {
  if (text.empty()) {
    return;
  }
  if (observer_ != nullptr) {
    observer_->text(warning_line(text));
  }
  all_.push_back(text);
}

void Warnings::add(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    add(text);
  }
}

}  // namespace thawslide::run
