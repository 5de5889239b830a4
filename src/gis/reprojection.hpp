// Transformation between coordinate reference systems, and distortion by a map projection.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gis/point_window.hpp"

namespace thawslide::gis {

// Transforms coordinates between two systems in WKT. If one is empty, or both are equal, coordinates are unchanged.
class Reprojection {
 public:
  Reprojection(const std::string& from_wkt, const std::string& to_wkt);
  ~Reprojection();
  Reprojection(Reprojection&&) noexcept;
  Reprojection& operator=(Reprojection&&) noexcept;

  [[nodiscard]] bool changes_nothing() const { return transformation_ == nullptr; }
  // Transforms x, y in place. Returns false if a point has no coordinates in the other system.
  [[nodiscard]] bool apply(std::vector<double>& x, std::vector<double>& y) const;

 private:
  struct Transformation;
  std::unique_ptr<Transformation> transformation_;
};

// A raster in another system, with about its own spacing: bilinear between its points, or codes of the nearest point.
// Points of which the nearest one has no data have none. Throws UserError without a transformation.
[[nodiscard]] Raster reprojected(const Raster& raster, const std::string& to_wkt, bool is_code);

// Reference system of a file other than the DEM: that of the file, or that of the ground if the file has none, or one
// that its coordinates cannot be in. `warning`: empty if there is none.
struct LikelySystem {
  std::string wkt;
  std::string warning;
};
[[nodiscard]] LikelySystem likely_system(const std::string& file, const std::string& specified, const Rectangle& extent,
                                         const std::string& ground);

// Principal point scales: the smallest and the largest length on the map over the length on the ellipsoid, by direction
// (Snyder 1987, Map projections: a working manual, USGS Professional Paper 1395, pp. 20-26). Their ratio is that of the
// axes of Tissot's indicatrix, which measures the angular distortion.
struct PointScales {
  double smallest = 1.0, largest = 1.0;
  double x = 0.0, y = 0.0;  // on the map [m]

  // Largest relative error of lengths, or of ratios of lengths in two directions.
  [[nodiscard]] double error() const;
};

// Scales at the corner of the extent with the largest error. `wkt`: a projection in metres. Without distortion if no
// corner lies on the ellipsoid.
[[nodiscard]] PointScales worst_scales(const std::string& wkt, const Rectangle& extent);

}  // namespace thawslide::gis
