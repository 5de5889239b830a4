// The way from one coordinate reference system to another.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gis/rectangle.hpp"

namespace thawslide::gis {

// Takes coordinates from one system to another, both in WKT. Where one is empty, and where both are the same, they stay
// what they are.
class Reprojection {
 public:
  Reprojection(const std::string& from_wkt, const std::string& to_wkt);
  ~Reprojection();
  Reprojection(Reprojection&&) noexcept;
  Reprojection& operator=(Reprojection&&) noexcept;

  [[nodiscard]] bool changes_nothing() const { return transformation_ == nullptr; }
  // x, y in place. Returns false where a point has no coordinates in the other system.
  [[nodiscard]] bool apply(std::vector<double>& x, std::vector<double>& y) const;

 private:
  struct Transformation;
  std::unique_ptr<Transformation> transformation_;
};

// The system of a file beside the DEM: what it tells, or the ground's where it tells nothing and where its
// numbers cannot be in what it tells. `note`: what the user should know of that; empty: nothing.
struct LikelySystem {
  std::string wkt;
  std::string warning;
};
[[nodiscard]] LikelySystem likely_system(const std::string& file, const std::string& specified, const Rectangle& extent,
                                         const std::string& ground);

}  // namespace thawslide::gis
