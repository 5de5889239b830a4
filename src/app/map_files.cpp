#include "app/map_files.hpp"

#include <utility>

#include "base/error.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/holes.hpp"
#include "gis/roughness.hpp"
#include "gis/site.hpp"
#include "sim/direction.hpp"
#endif

namespace thawslide::app {

config::Site read_map_files(const config::Case& parameters, [[maybe_unused]] Notes& notes) {
  if (parameters.terrain.kind != config::TerrainKind::dem) {
    return {};
  }
#ifdef THAWSLIDE_WITH_GIS
  gis::SiteAndNotes read = gis::load_site(parameters);
  notes.add(read.notes);
  notes.add(gis::holes_note(parameters, read.site));
  notes.add(gis::probes_in_holes(read.site));
  notes.add(sim::orient_lines(parameters, read.site));
  notes.add(sim::warning_of_path(parameters, read.site));
  notes.add(gis::roughness_note(parameters, read.site));
  return std::move(read.site);
#else
  throw UserError(
      fmt::format("{}: terrain.type is \"dem\", and this build of thawslide cannot read maps: it was made without "
                  "GDAL. Install libgdal-dev and build again (`./run --setup`), or use a profile.",
                  config::place_of(parameters, "terrain.type")));
#endif
}

}  // namespace thawslide::app
