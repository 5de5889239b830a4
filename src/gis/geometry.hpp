// Polygons and lines as GDAL objects. Only for the sources of this module, because it includes GDAL.
#pragma once

#include <ogr_geometry.h>

#include "gis/polygons.hpp"

namespace thawslide::gis {

[[nodiscard]] OGRMultiPolygon to_geometry(const Polygons& polygons);
[[nodiscard]] OGRLineString to_geometry(const Polyline2& line);
[[nodiscard]] OGRPolygon to_geometry(const Polygon& polygon);

[[nodiscard]] Polygon from_geometry(const OGRPolygon& polygon);
[[nodiscard]] Polyline2 from_geometry(const OGRSimpleCurve& curve);
// Areas of a geometry of any kind, without its lines and points.
[[nodiscard]] Polygons areas_of(const OGRGeometry& geometry);

}  // namespace thawslide::gis
