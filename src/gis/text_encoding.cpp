#include "gis/text_encoding.hpp"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include "base/composition.hpp"

namespace thawslide::gis {

bool has_unknown_encoding(GDALDataset& dataset) {
  constexpr const char* domain = "SHAPEFILE";
  if (std::string(dataset.GetDriverName()) != "ESRI Shapefile" || dataset.GetLayerCount() != 1) {
    return false;
  }
  OGRLayer& layer = *dataset.GetLayer(0);
  const char* const page = layer.GetMetadataItem("LDID_VALUE", domain);
  constexpr int ansi = 0x57;
  const int number = page == nullptr ? 0 : std::atoi(page);
  return layer.GetMetadataItem("CPG_VALUE", domain) == nullptr && (number == 0 || number == ansi);
}

std::string as_utf8(const std::string& text) {
  if (CPLIsUTF8(text.c_str(), -1) != 0) {
    return composed(text);
  }
  char* const recoded = CPLRecode(text.c_str(), "CP1252", CPL_ENC_UTF8);
  std::string result = recoded;
  CPLFree(recoded);
  return result;
}

}  // namespace thawslide::gis
