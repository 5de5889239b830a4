// Numbers by name: what a checkpoint holds beside the particles, so that those who write and who read it agree.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace thawslide {

using NamedNumbers = std::map<std::string, std::vector<double>>;

}  // namespace thawslide
