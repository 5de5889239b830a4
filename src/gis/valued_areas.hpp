// Polygons grouped by the value of an attribute.
#pragma once

#include <string>
#include <vector>

#include "gis/vector_file.hpp"

namespace thawslide::gis {

struct ValuedArea {
  double value = 0.0;
  Polygons polygons;  // union of those with the value
};

// Features of a layer in groups, by increasing value. Throws UserError if a feature lacks the attribute or has a text
// as its value, and if features of different values overlap. `key`: key that names the attribute, for messages.
[[nodiscard]] std::vector<ValuedArea> areas_by_value(const VectorLayer& layer, const std::string& attribute,
                                                     const std::string& key);

}  // namespace thawslide::gis
