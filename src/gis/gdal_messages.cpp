#include "gis/gdal_messages.hpp"

#include <fmt/format.h>
#include <gdal.h>

#include <algorithm>

namespace thawslide::gis {

GdalMessages::GdalMessages() {
  CPLPushErrorHandlerEx(&GdalMessages::take, this);
  static const bool registered = [] {
    GDALAllRegister();
    return true;
  }();
  static_cast<void>(registered);
}

GdalMessages::~GdalMessages() { CPLPopErrorHandler(); }

void CPL_STDCALL GdalMessages::take(CPLErr severity, CPLErrorNum, const char* text) {
  auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
  if (severity < CE_Warning) {
    return;
  }
  self->any_error_ = self->any_error_ || severity >= CE_Failure;
  std::string line(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  line.erase(line.find_last_not_of(". ") + 1);  // our sentences add the full stop
  if (std::find(self->texts_.begin(), self->texts_.end(), line) == self->texts_.end()) {
    self->texts_.push_back(line);
  }
}

std::string GdalMessages::remark() const {
  return texts_.empty() ? "" : fmt::format("; GDAL says: {}", fmt::join(texts_, "; "));
}

std::string GdalMessages::reason() const {
  return texts_.empty() ? "for a reason that GDAL does not report" : remark().substr(2);
}

std::string GdalMessages::after(const std::string& words) const {
  for (const std::string& text : texts_) {
    const std::size_t at = text.find(words);
    if (at != std::string::npos) {
      return text.substr(at + words.size());
    }
  }
  return "";
}

bool GdalMessages::mention(const std::string& words) const {
  return std::any_of(texts_.begin(), texts_.end(),
                     [&](const std::string& text) { return text.find(words) != std::string::npos; });
}

}  // namespace thawslide::gis
