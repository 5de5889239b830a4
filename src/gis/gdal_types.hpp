// Polygons, lines and reference systems as GDAL objects. Only for the sources of this module, because it includes GDAL.
#pragma once

#include <ogr_geometry.h>
#include <ogr_spatialref.h>

#include <array>

#include "gis/polygons.hpp"

namespace thawslide::gis {

[[nodiscard]] OGRMultiPolygon to_geometry(const Polygons& polygons);
[[nodiscard]] OGRLineString to_geometry(const Polyline2& line);
[[nodiscard]] inline OGRPoint to_geometry(const std::array<double, 2>& point) { return {point[0], point[1]}; }
[[nodiscard]] OGRPolygon to_geometry(const Polygon& polygon);

[[nodiscard]] Polygon from_geometry(const OGRPolygon& polygon);
[[nodiscard]] Polyline2 from_geometry(const OGRSimpleCurve& curve);
// Areas of a geometry of any kind, without its lines and points.
[[nodiscard]] Polygons areas_of(const OGRGeometry& geometry);

// x is the easting or longitude, y the northing or latitude, regardless of the axis order of the system's authority.
[[nodiscard]] OGRSpatialReference reference_from_wkt(const std::string& wkt);
// Empty for null and for a system without content.
[[nodiscard]] std::string wkt_from_reference(const OGRSpatialReference* reference);

// Height unit of a compound or three-dimensional system; the name is empty if there is none.
struct HeightUnit {
  std::string name;
  double metres = 1.0;
};
[[nodiscard]] HeightUnit height_unit_of(const OGRSpatialReference* reference);

}  // namespace thawslide::gis
