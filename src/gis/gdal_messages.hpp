// GDAL for this module: its messages, which are collected, texts, and geometries and systems as its objects.
#pragma once

#include <cpl_error.h>
#include <ogr_geometry.h>
#include <ogr_spatialref.h>

#include <array>
#include <string>
#include <vector>

#include "gis/polygons.hpp"

namespace thawslide::gis {

// Collects GDAL's errors and warnings of this thread during its lifetime. The first instance registers GDAL's drivers.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  // All messages in order, without repetitions: "; GDAL says: A; B"; empty if there are none.
  [[nodiscard]] std::string remark() const;
  // All messages as the reason of a failure: "GDAL says: A; B".
  [[nodiscard]] std::string reason() const;
  // Rest of the first message that contains `words`, after them; empty if there is none.
  [[nodiscard]] std::string after(const std::string& words) const;
  [[nodiscard]] bool any_error() const { return any_error_; }

 private:
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum number, const char* text);
  std::vector<std::string> texts_;
  bool any_error_ = false;
};

// Copy of a text that GDAL has allocated, which is released; empty for null.
[[nodiscard]] std::string released(char* text);

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
