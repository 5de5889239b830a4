#include "app/map_files.hpp"

#include "base/error.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/site.hpp"
#endif

namespace thawslide::app {

config::Site read_map_files(const config::Case& parameters) {
  if (parameters.terrain.kind != config::TerrainKind::dem) {
    return {};
  }
#ifdef THAWSLIDE_WITH_GIS
  std::vector<std::string> notes;
  config::Site site = gis::load_site(parameters, notes);
  for (const std::string& note : notes) {
    fmt::print("note: {}\n", note);
  }
  return site;
#else
  throw UserError(
      fmt::format("{}: terrain.type is \"dem\", and this build of thawslide cannot read maps: it was made without "
                  "GDAL. Install libgdal-dev and build again (`./run --setup`), or use a profile.",
                  config::place_of(parameters, "terrain.type")));
#endif
}

}  // namespace thawslide::app
