// Numbers by name: checkpoint data in addition to the particles, with one format for writer and reader.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace thawslide {

using NamedNumbers = std::map<std::string, std::vector<double>>;

}  // namespace thawslide
