// Reference systems as GDAL's objects. For the sources of this room: it names GDAL.
#pragma once

#include <ogr_spatialref.h>

#include <string>

namespace thawslide::gis {

// x is the easting or longitude, y the northing or latitude, whatever order the system's authority has.
[[nodiscard]] OGRSpatialReference reference_from_wkt(const std::string& wkt);
// Empty for null and for a system without content.
[[nodiscard]] std::string wkt_from_reference(const OGRSpatialReference* reference);

// The unit of the heights of a compound or three-dimensional system; without a name: it has none.
struct HeightUnit {
  std::string name;
  double metres = 1.0;
};
[[nodiscard]] HeightUnit height_unit_of(const OGRSpatialReference* reference);

}  // namespace thawslide::gis
