// Known causes for which GDAL cannot open a file, with their remedies.
#pragma once

#include <string>

namespace thawslide::gis {

// Complete sentences without the name of the file: "its index release.shx is missing. ..."; empty: no known cause.
[[nodiscard]] std::string cause_of_unreadable_vector(const std::string& file);
[[nodiscard]] std::string cause_of_unreadable_raster(const std::string& file);

}  // namespace thawslide::gis
