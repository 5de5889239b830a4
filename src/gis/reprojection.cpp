#include "gis/reprojection.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/reference_system.hpp"
#include "gis/spatial_reference.hpp"

namespace thawslide::gis {

struct Reprojection::Transformation {
  std::unique_ptr<OGRCoordinateTransformation> transformation;
};

Reprojection::Reprojection(const std::string& from_wkt, const std::string& to_wkt) {
  if (from_wkt.empty() || to_wkt.empty() || from_wkt == to_wkt) {
    return;
  }
  const GdalMessages messages;
  // Only horizontal coordinates are transformed; heights remain unchanged.
  OGRSpatialReference from = reference_from_wkt(from_wkt);
  OGRSpatialReference to = reference_from_wkt(to_wkt);
  for (OGRSpatialReference* system : {&from, &to}) {
    system->StripVertical();
    system->DemoteTo2D(nullptr);
  }
  const char* const options[] = {"CRITERION=EQUIVALENT", nullptr};
  if (from.IsSame(&to, options) != 0) {
    return;
  }
  transformation_ = std::make_unique<Transformation>();
  transformation_->transformation.reset(OGRCreateCoordinateTransformation(&from, &to));
  if (transformation_->transformation == nullptr) {
    require_projection_database();
    throw UserError(
        "no transformation is available from the coordinate reference system {} to {}{}. Reproject the file to the "
        "latter.",
        name_of(from_wkt), name_of(to_wkt), messages.remark());
  }
}

Reprojection::~Reprojection() = default;
Reprojection::Reprojection(Reprojection&&) noexcept = default;
Reprojection& Reprojection::operator=(Reprojection&&) noexcept = default;

bool Reprojection::apply(std::vector<double>& x, std::vector<double>& y) const {
  if (transformation_ == nullptr) {
    return true;
  }
  const GdalMessages messages;
  std::vector<int> success(x.size(), 0);
  transformation_->transformation->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr, success.data());
  for (const int one : success) {
    if (one == 0) {
      return false;
    }
  }
  return true;
}

LikelySystem likely_system(const std::string& file, const std::string& specified, const Rectangle& extent,
                           const std::string& ground) {
  const std::string name = std::filesystem::path(file).filename().string();
  if (ground.empty()) {
    return {specified, ""};
  }
  if (specified.empty()) {
    return {ground, fmt::format("{} specifies no coordinate reference system: that of the DEM, {}, is assumed", name,
                                name_of(ground))};
  }
  if (is_geographic(specified) && !can_be_degrees(extent)) {
    return {
        ground,
        fmt::format("{} specifies degrees ({}), which {}, {} cannot be: the system of the DEM, {}, is assumed", name,
                    name_of(specified), coordinate_text(extent.min_x), coordinate_text(extent.min_y), name_of(ground))};
  }
  if (Reprojection(specified, ground).changes_nothing()) {
    return {ground, ""};
  }
  return {specified, fmt::format("note: {} was reprojected from {} to {}", name, name_of(specified), name_of(ground))};
}

}  // namespace thawslide::gis
