// What GDAL has to say, gathered instead of printed. For the sources of this room: it names GDAL.
#pragma once

#include <cpl_error.h>

#include <string>
#include <vector>

namespace thawslide::gis {

// Gathers GDAL's errors and warnings of this thread for as long as it lives. The first one registers GDAL's drivers.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  // All of them in their order, each once: "; GDAL says: A; B", or nothing where GDAL was silent.
  [[nodiscard]] std::string remark() const;
  // The rest of the first message after `words`; empty if none holds them.
  [[nodiscard]] std::string after(const std::string& words) const;
  [[nodiscard]] bool mention(const std::string& words) const;
  [[nodiscard]] bool any_error() const { return any_error_; }

 private:
  static void CPL_STDCALL take(CPLErr severity, CPLErrorNum number, const char* text);
  std::vector<std::string> texts_;
  bool any_error_ = false;
};

}  // namespace thawslide::gis
