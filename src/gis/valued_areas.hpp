// Polygons in groups of one value of an attribute.
#pragma once

#include <string>
#include <vector>

#include "gis/vector_file.hpp"

namespace thawslide::gis {

struct ValuedArea {
  double value = 0.0;
  Polygons polygons;  // union of those with the value
};

// The features of a layer in groups, by rising value. Throws UserError where a feature lacks the attribute or has a
// text there, and where features of different values overlap. `key` asks for the attribute, for the messages.
[[nodiscard]] std::vector<ValuedArea> areas_by_value(const VectorLayer& layer, const std::string& attribute,
                                                     const std::string& key);

}  // namespace thawslide::gis
