// Rasters of codes: integers that identify substrates.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

// Codes of a file in the ground's coordinates, around the domain; NaN: none. A raster in another reference system is
// sampled at the ground's points by nearest neighbour. `key`: key that named the file. Throws UserError for non-integer
// values. Appends warnings.
[[nodiscard]] Raster read_codes(const config::Case& parameters, const std::string& key, const std::string& file,
                                const Raster& ground, std::vector<std::string>& warnings);

// Number of raster points in a rectangle with each code, and their extent.
struct CodesFound {
  struct Points {
    long count = 0;
    Rectangle extent;
  };
  std::map<double, Points> by_code;
  Points without;
  long count = 0;  // with and without a code
};
[[nodiscard]] CodesFound codes_in(const Rectangle& area, const Raster& codes);

// "1, 2 and 7"
[[nodiscard]] std::string format_codes(const CodesFound& found);

// Warnings about unnamed codes in a domain, and about parts of it without a code.
[[nodiscard]] std::vector<std::string> warnings_of_codes(const Rectangle& domain, const std::string& file,
                                                         const Raster& codes, const std::set<double>& named);

}  // namespace thawslide::gis
