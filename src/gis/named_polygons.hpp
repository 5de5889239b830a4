// Polygons of a file that a case names: all of them, or those selected by their names.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

struct PolygonRequest {
  std::string table;  // of the case, with a point: "bed."
  std::string key;    // in that table, which names the file
  std::string file;
  std::vector<std::string> names;  // empty: all polygons
  std::string name_attribute;
};

// The file with the selected features, in the ground's coordinates (WKT). Appends warnings.
[[nodiscard]] VectorLayer read_named_polygons(const config::Case& parameters, const PolygonRequest& request,
                                              const std::string& crs, std::vector<std::string>& warnings);

[[nodiscard]] Polygons union_of_features(const VectorLayer& layer);

// Part of the request's polygons in the domain. Throws UserError if there is none.
[[nodiscard]] Polygons part_in_domain(const config::Case& parameters, const PolygonRequest& request,
                                      const Polygons& polygons);

}  // namespace thawslide::gis
