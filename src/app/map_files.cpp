#include "app/map_files.hpp"

#include <utility>

#include "base/error.hpp"
#include "config/notices.hpp"
#include "sim/map_grid.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/holes.hpp"
#include "gis/site.hpp"
#endif

namespace thawslide::app {

config::Site read_map_files(const config::Case& parameters) {
  if (parameters.terrain.kind != config::TerrainKind::dem) {
    return {};
  }
#ifdef THAWSLIDE_WITH_GIS
  gis::SiteAndNotes read = gis::load_site(parameters);
  if (const std::string holes = gis::holes_note(parameters, read.site); !holes.empty()) {
    read.notes.push_back(holes);
  }
  for (const std::string& note : read.notes) {
    fmt::print("note: {}\n", note);
  }
  return std::move(read.site);
#else
  throw UserError(
      fmt::format("{}: terrain.type is \"dem\", and this build of thawslide cannot read maps: it was made without "
                  "GDAL. Install libgdal-dev and build again (`./run --setup`), or use a profile.",
                  config::place_of(parameters, "terrain.type")));
#endif
}

void print_map_note(const config::Case& parameters, const config::Site& site) {
  if (const std::string note = sim::note_on_map_cell(parameters, site); !note.empty()) {
    fmt::print("note: {}\n", note);
  }
}

void print_notices(const config::Case& parameters) {
  for (const std::string& notice : config::notices(parameters)) {
    fmt::print("note: {}\n", notice);
  }
}

}  // namespace thawslide::app
