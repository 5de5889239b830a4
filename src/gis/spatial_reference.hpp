// Reference systems as GDAL's objects. For the sources of this room: it names GDAL.
#pragma once

#include <ogr_spatialref.h>

#include <string>

namespace thawslide::gis {

// x is the easting or longitude, y the northing or latitude, whatever order the system's authority has.
[[nodiscard]] OGRSpatialReference reference_from_wkt(const std::string& wkt);
// Empty for null and for a system without content.
[[nodiscard]] std::string wkt_from_reference(const OGRSpatialReference* reference);

}  // namespace thawslide::gis
