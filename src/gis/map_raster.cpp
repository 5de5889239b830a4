#include "gis/map_raster.hpp"

#include <filesystem>

#include "gis/raster_file.hpp"
#include "gis/reference_system.hpp"
#include "gis/told_at.hpp"

namespace thawslide::gis {

namespace {

std::string likely_system(const RasterFile& file, const std::string& ground, std::vector<std::string>& notes) {
  const std::string& own = file.layout().crs;
  const std::string name = std::filesystem::path(file.file()).filename().string();
  if (own.empty()) {
    notes.push_back(without_system_note(name, ground));
    return ground;
  }
  if (is_geographic(own) && !can_be_degrees(file.extent())) {
    notes.push_back(false_degrees_note(name, own, ground, file.extent().min_x, file.extent().min_y));
    return ground;
  }
  if (!Reprojection(own, ground).changes_nothing()) {
    notes.push_back(reprojection_note(name, own, ground));
  }
  return own;
}

}  // namespace

Raster read_map(const config::Case& parameters, const MapRequest& request, std::vector<std::string>& notes) {
  return told_at(parameters, request.key, [&] {
    const RasterFile file(request.file);
    const std::string system = likely_system(file, request.crs, notes);
    const bool same_place = Reprojection(system, request.crs).changes_nothing();
    if (same_place && request.area && !request.area->touches(span_of_points(file.layout()))) {
      throw UserError(
          fmt::format("{}: the raster ({}) does not reach the release ({}). Check that both are in the same "
                      "place and reference system.",
                      request.file, range_words(span_of_points(file.layout())), range_words(*request.area)));
    }
    Raster raster = file.read(same_place ? request.area : std::nullopt);
    raster.crs = system;
    return raster;
  });
}

}  // namespace thawslide::gis
