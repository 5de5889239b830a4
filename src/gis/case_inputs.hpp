// Inputs of a case that a key names: their places in messages, warnings, and rasters other than the DEM.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/raster.hpp"
#include "config/case.hpp"
#include "gis/point_window.hpp"
#include "gis/raster_file.hpp"

namespace thawslide::gis {

// Value of a key, and its place for messages: "case.toml:12:7: terrain.file", or an option such as "--dem".
template <class T>
struct Located {
  T value;
  std::string place;  // empty: not from a case
};

[[nodiscard]] std::string place_of(const config::Case& parameters, const std::string& key);

template <class T>
[[nodiscard]] Located<T> located(const config::Case& parameters, const std::string& key, const T& value) {
  return {value, place_of(parameters, key)};
}

// Adds the place of the key that named a file to errors of `work`.
template <class Work>
auto at_place(const std::string& place, const Work& work) {
  try {
    return work();
  } catch (const UserError& error) {
    throw UserError("{}{}{}", place, place.empty() ? "" : ": ", error.what());
  }
}

// Appends a warning unless it is empty.
void add_warning(const std::string& warning, std::vector<std::string>& warnings);

// "1, 2 and 7"
[[nodiscard]] std::string joined_by_and(const std::vector<std::string>& words);

// Distance by which a rectangle extends beyond another: "120 m in the west and 30 m in the north"; or empty.
[[nodiscard]] std::string describe_overhang(const Rectangle& inner, const Rectangle& outer);

// "x from 0 to 10, y from 2 to 5"
[[nodiscard]] std::string format_range(const Rectangle& rectangle);

// Sides of the domain.
[[nodiscard]] Rectangle domain_of(const config::Grid& grid);

struct MapRequest {
  Located<std::string> file;
  Quantity quantity;                   // of its values
  std::string crs;                     // of the ground
  std::optional<Rectangle> area;       // required area in the ground's coordinates; empty: the whole raster
  std::string reason = "the release";  // purpose in that area
  std::string heights = {};            // vertical reference system of the DEM, for elevations
};

// In the system of the file; with a warning, in that of the ground if that is missing or impossible. Throws UserError.
[[nodiscard]] Raster read_map(const MapRequest& request, std::vector<std::string>& warnings);

}  // namespace thawslide::gis
