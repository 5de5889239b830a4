// Polygons and lines as GDAL's objects. For the sources of this room: it names GDAL.
#pragma once

#include <ogr_geometry.h>

#include "gis/polygons.hpp"

namespace thawslide::gis {

[[nodiscard]] OGRMultiPolygon to_geometry(const Polygons& polygons);
[[nodiscard]] OGRLineString to_geometry(const Polyline2& line);
[[nodiscard]] OGRPolygon to_geometry(const Polygon& polygon);

[[nodiscard]] Polygon from_geometry(const OGRPolygon& polygon);
[[nodiscard]] Polyline2 from_geometry(const OGRSimpleCurve& curve);
// The areas of a geometry of any kind; its lines and points are left out.
[[nodiscard]] Polygons areas_of(const OGRGeometry& geometry);

}  // namespace thawslide::gis
