// Coordinate reference systems as WKT texts: their suitability for the computation, names, and transformations.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gis/point_window.hpp"

class OGRCoordinateTransformation;

namespace thawslide::gis {

// Raster properties used in messages about its reference system.
struct MapExtent {
  std::string file;
  Rectangle extent;   // of its coordinates, in the units of the file
  double cell = 0.0;  // in the units of the file
};

// Throws UserError if PROJ does not find its database.
void require_projection_database();

// WKT of a system specified by the user, such as "EPSG:31254" or a WKT. Throws UserError if it is unknown.
[[nodiscard]] std::string reference_system_named(const std::string& text);

// "EPSG:31254", or the system's title if it has no number; empty for an empty one.
[[nodiscard]] std::string name_of(const std::string& wkt);

// False for values beyond 360 or 90, which cannot be longitude and latitude.
[[nodiscard]] bool can_be_degrees(const Rectangle& extent);

// Horizontal part of `terrain.crs` or, if empty, of the file's system. Throws UserError if it is no metric projection.
[[nodiscard]] std::string metric_system(const MapExtent& raster, const std::string& wkt_of_file,
                                        const std::string& terrain_crs);

// Note if lengths on the map differ from those on the ground by more than 1 % at a corner. Throws UserError beyond 5 %.
[[nodiscard]] std::string distortion_note(const MapExtent& raster, const std::string& wkt, bool from_key);

// Name of the vertical datum, or of the horizontal one for ellipsoidal heights; empty if it is not specified.
[[nodiscard]] std::string height_system_of(const std::string& wkt);
// Throws UserError if both height systems are specified, and differ.
void require_same_heights(const std::string& file, const std::string& found, const std::string& dem);

// Warning if a raster lies far outside the area of use of its system; empty otherwise.
[[nodiscard]] std::string location_warning(const MapExtent& raster, const std::string& wkt);

// Transforms coordinates between two systems in WKT. If one is empty, or both are equal, coordinates are unchanged.
class Reprojection {
 public:
  Reprojection(const std::string& from_wkt, const std::string& to_wkt);

  [[nodiscard]] bool changes_nothing() const { return transformation_ == nullptr; }
  // Transforms x, y in place. Returns false if a point has no coordinates in the other system.
  [[nodiscard]] bool apply(std::vector<double>& x, std::vector<double>& y) const;

 private:
  std::shared_ptr<OGRCoordinateTransformation> transformation_;
};

// A raster in another system, with about its own spacing: bilinear between its points, or codes of the nearest point.
[[nodiscard]] Raster reprojected(const Raster& raster, const std::string& to_wkt, bool is_code);

// Reference system of a file other than the DEM; with a warning, that of the ground if it is missing or impossible.
struct LikelySystem {
  std::string wkt;
  std::string warning;
};
[[nodiscard]] LikelySystem likely_system(const std::string& file, const std::string& specified, const Rectangle& extent,
                                         const std::string& ground);

}  // namespace thawslide::gis
