// Ground of a case from its DEM.
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/case_inputs.hpp"
#include "gis/raster_file.hpp"

namespace thawslide::gis {

// DEM file, and the points at which it is read.
class DemFile {
 public:
  // `crs`: as terrain.crs; `resample`: distance of points [m], or 0. Throws UserError for no map projection in metres.
  DemFile(const Located<std::string>& file, const Located<std::string>& crs, const Located<double>& resample,
          std::vector<std::string>& warnings);

  // Without values, in the reference system of the computation.
  [[nodiscard]] const Raster& points() const { return points_; }
  [[nodiscard]] const std::string& file() const { return file_.file(); }
  // Vertical reference system of the elevations; empty: not specified.
  [[nodiscard]] const std::string& heights() const { return heights_; }
  // The file's own points.
  [[nodiscard]] const Raster& own_points() const { return file_.layout(); }
  // At `points` within a rectangle, and at the file's own points. Throw UserError for impossible elevations.
  [[nodiscard]] Raster read(const Rectangle& area) const;
  [[nodiscard]] Raster read_own_points(const std::optional<Rectangle>& area = std::nullopt) const;

 private:
  std::string place_;
  Located<double> resample_;
  RasterFile file_;
  Raster points_;
  std::string heights_;
};

struct Dem {
  Raster raster;            // around the domain, in the reference system of the computation; NaN in holes
  Raster before_smoothing;  // at the same points; empty: no smoothing
  config::Roughness roughness;
  std::string heights;  // as DemFile
  Rectangle span;       // from the first to the last possible point of the file: limit of a domain

  [[nodiscard]] const Raster& as_measured() const { return before_smoothing.empty() ? raster : before_smoothing; }
};

// DEM in a domain with a margin of some cells of the grid [m], smoothed as specified. `bodies`: rectangles around them.
[[nodiscard]] Dem load_dem(const DemFile& file, const Rectangle& domain, double cell,
                           const config::NumberOrAuto& smooth, const std::vector<Rectangle>& bodies,
                           std::vector<std::string>& warnings);

// Warnings about no-data points in the domain, with their effect on a slide, and about probes without terrain data.
[[nodiscard]] std::vector<std::string> warnings_of_holes(const config::Case& parameters, const config::Site& site);

// Warning about points of 0 in ground that is nowhere near this height, which are probably no data; or empty.
[[nodiscard]] std::string warning_of_zeros(const std::string& file, const Raster& ground);

}  // namespace thawslide::gis
