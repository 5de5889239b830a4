// Rasters of codes: whole numbers that say what lies where.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

// The codes of a file in the ground's coordinates, about the domain; NaN: none. In another reference system than the
// ground's they are taken to the ground's points, each from the nearest of the file. `key` named the file. Throws
// UserError for numbers that are not whole. Adds to the notes.
[[nodiscard]] Raster read_codes(const config::Case& parameters, const std::string& key, const std::string& file,
                                const Raster& ground, std::vector<std::string>& warnings);

// How many points of a raster in a rectangle hold each code, and where these lie.
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

// What the user should know of a domain and the codes in it: those not named, and what is without.
[[nodiscard]] std::vector<std::string> warnings_of_codes(const Rectangle& domain, const std::string& file,
                                                         const Raster& codes, const std::set<double>& named);

}  // namespace thawslide::gis
