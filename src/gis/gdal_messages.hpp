// GDAL messages, collected instead of printed, and texts. Only for the sources of this module, because it includes
// GDAL.
#pragma once

#include <cpl_error.h>

#include <string>
#include <vector>

namespace thawslide::gis {

// Collects GDAL's errors and warnings of this thread during its lifetime. The first instance registers GDAL's drivers.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  // All messages in order, without repetitions: "; GDAL says: A; B"; empty if there are none.
  [[nodiscard]] std::string remark() const;
  // All messages as the reason of a failure: "GDAL says: A; B".
  [[nodiscard]] std::string reason() const;
  // Rest of the first message that contains `words`, after them; empty if there is none.
  [[nodiscard]] std::string after(const std::string& words) const;
  [[nodiscard]] bool any_error() const { return any_error_; }

 private:
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum number, const char* text);
  std::vector<std::string> texts_;
  bool any_error_ = false;
};

// Copy of a text that GDAL has allocated, which is released; empty for null.
[[nodiscard]] std::string released(char* text);

}  // namespace thawslide::gis
