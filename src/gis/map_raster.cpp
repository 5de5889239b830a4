#include "gis/map_raster.hpp"

#include "gis/error_location.hpp"
#include "gis/raster_file.hpp"
#include "gis/reference_system.hpp"
#include "gis/reprojection.hpp"

namespace thawslide::gis {

Raster read_map(const config::Case& parameters, const MapRequest& request, std::vector<std::string>& warnings) {
  return with_error_location(parameters, request.key, [&] {
    const RasterFile file(request.file, request.quantity);
    if (!request.heights.empty()) {
      require_same_heights(request.file, height_system_of(file.layout().crs), request.heights);
    }
    const LikelySystem system = likely_system(request.file, file.layout().crs, file.extent(), request.crs);
    add_warning(system.warning, warnings);
    add_warning(file.conversion().warning, warnings);
    const bool same_system = Reprojection(system.wkt, request.crs).changes_nothing();
    if (same_system && request.area && !request.area->touches(span_of_points(file.layout()))) {
      throw UserError(
          "{}: the raster ({}) does not reach {} ({}). Check that both are in the same place and reference system.",
          request.file, format_range(span_of_points(file.layout())), request.reason, format_range(*request.area));
    }
    Raster raster = file.read(same_system ? request.area : std::nullopt);
    raster.crs = system.wkt;
    return raster;
  });
}

}  // namespace thawslide::gis
