#include "run/map_files.hpp"

#include <utility>

#include "base/error.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/dem_warnings.hpp"
#include "gis/roughness.hpp"
#include "gis/site.hpp"
#include "sim/direction.hpp"
#endif

namespace thawslide::run {

config::Site read_map_files(const config::Case& parameters, [[maybe_unused]] Warnings& warnings) {
  if (parameters.terrain.kind != config::TerrainKind::dem) {
    return {};
  }
#ifdef THAWSLIDE_WITH_GIS
  gis::SiteAndWarnings read = gis::load_site(parameters);
  warnings.add(read.warnings);
  warnings.add(gis::holes_warning(parameters, read.site));
  warnings.add(gis::probes_in_holes(read.site));
  warnings.add(sim::orient_lines(parameters, read.site));
  warnings.add(sim::warning_of_path(parameters, read.site));
  warnings.add(gis::roughness_warning(parameters, read.site));
  return std::move(read.site);
#else
  throw UserError(
      "{}: terrain.type is \"dem\", and this build of thawslide cannot read maps: it was made without GDAL. Install "
      "libgdal-dev and build again (`./run --setup`), or use a profile.",
      config::location_of(parameters, "terrain.type"));
#endif
}

}  // namespace thawslide::run
