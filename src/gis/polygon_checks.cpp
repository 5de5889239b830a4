#include "gis/polygon_checks.hpp"

#include <memory>

#include "base/error.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/geometry.hpp"

namespace thawslide::gis {

namespace {

// A ring needs three corners that are not collinear.
bool has_area(const OGRPolygon& polygon) {
  if (polygon.getExteriorRing()->getNumPoints() < 4) {
    return false;
  }
  const std::unique_ptr<OGRGeometry> hull(polygon.ConvexHull());
  return hull != nullptr && wkbFlatten(hull->getGeometryType()) == wkbPolygon && hull->toPolygon()->get_Area() > 0.0;
}

}  // namespace

void check_polygons(const VectorLayer& layer) {
  for (const Feature& feature : layer.features) {
    for (const Polygon& polygon : feature.polygons) {
      const GdalMessages messages;
      const OGRPolygon geometry = to_geometry(polygon);
      if (!has_area(geometry)) {
        throw UserError("{}: {} has no area. Delete it, or draw its outline.", layer.file, feature.title);
      }
      if (geometry.IsValid()) {
        continue;
      }
      const std::string crossing = messages.after("Self-intersection at or near point ");
      if (!crossing.empty()) {
        throw UserError(
            "{}: {} crosses itself at or near {}. Correct its outline there (QGIS: Vector > Geometry Tools > Check "
            "Validity).",
            layer.file, feature.title, crossing);
      }
      throw UserError(
          "{}: {} is not a valid polygon{}. Correct its outline (QGIS: Vector > Geometry Tools > Check Validity).",
          layer.file, feature.title, messages.remark());
    }
  }
}

}  // namespace thawslide::gis
