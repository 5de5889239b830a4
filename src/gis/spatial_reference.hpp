// Reference systems as GDAL objects. Only for the sources of this module, because it includes GDAL.
#pragma once

#include <ogr_spatialref.h>

#include <string>

namespace thawslide::gis {

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
