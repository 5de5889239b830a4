// Releases of bodies: their areas, and their thickness and other mapped fields at the points of the ground.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/dem.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

// A body that is a release, and the ground on which it lies.
struct ReleaseInput {
  std::string name;
  const config::Body& body;
  std::function<std::string(const std::string& key)> place;  // of a key of the body, for messages
  const Dem& ground;                                         // before excavation
  Rectangle domain;
  std::string dem_file;
  double end = 0.0;                    // time at which the run ends [s]
  std::vector<std::string>& warnings;  // to which all functions append

  // Key and file that specify the area: polygons or, without these, a thickness.
  [[nodiscard]] const char* area_key() const { return body.release.empty() ? "thickness" : "release"; }
  [[nodiscard]] const std::string& area_file() const {
    return body.release.empty() ? body.thickness.source : body.release;
  }
  // "body.NAME.KEY"
  [[nodiscard]] std::string full_key(const char* key) const { return fmt::format("body.{}.{}", name, key); }
  template <class... Values>
  [[noreturn]] void fail(const char* key, fmt::format_string<Values...> form, Values&&... values) const {
    throw UserError("{}: {}", place(key), fmt::format(form, std::forward<Values>(values)...));
  }
};

// Area of a release: polygons or, without these, points of a raster with a thickness, or a surface above the ground.
struct ReleaseArea {
  VectorLayer layer;  // selected features; none for a raster
  Polygons polygons;  // their union
  Raster source;      // thickness [m] for a raster
  Raster fraction;    // covered fraction of each point's cell, without a taper; at points of the ground
  [[nodiscard]] bool is_raster() const { return !source.empty(); }
};

// [m]; a raster with larger values contains elevations.
inline constexpr double thickest = 500.0;
inline constexpr const char* swapped_dem =
    "Is this raster a DEM, swapped with the raster of the thickness? It needs the thickness.";

// Vertical thickness [m] at the points of the area's `fraction`, with its taper. Throws UserError if it is invalid.
[[nodiscard]] Raster vertical_thickness_of(const ReleaseInput& input, const ReleaseArea& area);

// Vertical thickness [m] of a layer `along_normal` [m] thick on a plane with the gradient dz/dx, dz/dy.
inline double vertical_thickness(double along_normal, double dz_dx, double dz_dy) {
  return along_normal * std::sqrt(1.0 + dz_dx * dz_dx + dz_dy * dz_dy);
}

struct LoadedRelease {
  config::Release release;
  Polygons polygons;  // covered area; for a raster, the cells around its points
  Raster fraction;    // covered fraction of each point's cell
  Raster spread;      // the same, distributed by the taper like the thickness
};

// Throws UserError if the release extends beyond the domain or the DEM.
[[nodiscard]] LoadedRelease load_release(const ReleaseInput& input);

// Throws UserError if the outlines of two bodies overlap by more than a thousandth of the smaller area.
void check_overlaps(const config::Case& parameters, const std::map<std::string, LoadedRelease>& releases);

// Sets the thickness T_b (`assigned_thickness`) of touching bodies in their own parts, and fractions that assign points
// to them (`claim`), and conserves volumes. Throws UserError if their tapers differ. t_b falls to 0 at the outline, but
// not where another body continues. With the fraction w_b of cells that b covers, distributed by its taper like t_b:
//    T_b = t_b / w_b  min(1, sum of w over all bodies)
void join_touching(const config::Case& parameters, std::map<std::string, LoadedRelease>& releases);

}  // namespace thawslide::gis
