#include "gis/gdal_messages.hpp"

#include <cpl_conv.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <gdal.h>
#include <link.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace thawslide::gis {

namespace {

// Returns the folder of the file that contains this code: the program, or the extension module of the Python package.
std::filesystem::path folder_of_code() {
  static const char in_this_file = 0;
  Dl_info symbol{};
  void* entry = nullptr;
  if (dladdr1(&in_this_file, &symbol, &entry, RTLD_DL_LINKMAP) == 0) {
    return {};
  }
  const std::string name = static_cast<const link_map*>(entry)->l_name;  // empty for the program
  std::error_code error;
  return std::filesystem::canonical(name.empty() ? "/proc/self/exe" : name, error).parent_path();
}

// A repaired wheel contains PROJ and GDAL with their data, which precede those of other versions on the system.
// Environment variables would also affect the rasterio package.
void use_packaged_data() {
  const std::filesystem::path share = folder_of_code() / "share";
  std::error_code error;
  if (std::filesystem::exists(share / "proj" / "proj.db", error)) {
    const std::string folder = (share / "proj").string();
    const char* const folders[] = {folder.c_str(), nullptr};
    OSRSetPROJSearchPaths(folders);
    CPLSetConfigOption("GDAL_DATA", (share / "gdal").c_str());
  }
}

}  // namespace

GdalMessages::GdalMessages() {
  CPLPushErrorHandlerEx(&GdalMessages::collect, this);
  static const bool registered = [] {
    use_packaged_data();
    GDALAllRegister();
    return true;
  }();
  static_cast<void>(registered);
}

GdalMessages::~GdalMessages() { CPLPopErrorHandler(); }

void CPL_STDCALL GdalMessages::collect(CPLErr severity, CPLErrorNum, const char* text) {
  auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
  if (severity < CE_Warning) {
    return;
  }
  self->any_error_ = self->any_error_ || severity >= CE_Failure;
  std::string line(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  line.erase(line.find_last_not_of(". ") + 1);  // our sentences add the full stop
  if (std::ranges::find(self->texts_, line) == self->texts_.end()) {
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

std::string released(char* text) {
  const std::string copy = text == nullptr ? "" : text;
  CPLFree(text);
  return copy;
}

}  // namespace thawslide::gis
