#include "gis/case_inputs.hpp"

#include "base/rounding.hpp"
#include "gis/reference_system.hpp"

namespace thawslide::gis {

std::string place_of(const config::Case& parameters, const std::string& key) {
  const std::string& location = config::location_of(parameters, key);
  // A command option such as --dem is sufficient; a location in a file and --set need the key.
  const bool is_option = location.rfind("--", 0) == 0 && location.rfind("--set", 0) != 0;
  return is_option ? location : fmt::format("{}: {}", location, key);
}

void add_warning(const std::string& warning, std::vector<std::string>& warnings) {
  if (!warning.empty()) {
    warnings.push_back(warning);
  }
}

std::string joined_by_and(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
  }
  return text;
}

std::string describe_overhang(const Rectangle& inner, const Rectangle& outer) {
  std::vector<std::string> sides;
  const auto add = [&](double distance, const char* side) {
    constexpr double rounding = 1e-6;  // m, of coordinates computed from files
    if (distance > rounding) {
      sides.push_back(fmt::format("{} m in the {}", rounded_text(distance, 3), side));
    }
  };
  add(outer.min_x - inner.min_x, "west");
  add(inner.max_x - outer.max_x, "east");
  add(outer.min_y - inner.min_y, "south");
  add(inner.max_y - outer.max_y, "north");
  return joined_by_and(sides);
}

std::string format_range(const Rectangle& rectangle) {
  return fmt::format("x from {} to {}, y from {} to {}", coordinate_text(rectangle.min_x),
                     coordinate_text(rectangle.max_x), coordinate_text(rectangle.min_y),
                     coordinate_text(rectangle.max_y));
}

Rectangle domain_of(const config::Grid& grid) { return {grid.min[0], grid.min[1], grid.max[0], grid.max[1]}; }

Raster read_map(const MapRequest& request, std::vector<std::string>& warnings) {
  return at_place(request.file.place, [&] {
    const std::string& name = request.file.value;
    const RasterFile file(name, request.quantity);
    if (!request.heights.empty()) {
      require_same_heights(name, height_system_of(file.layout().crs), request.heights);
    }
    const LikelySystem system = likely_system(name, file.layout().crs, file.extent(), request.crs);
    add_warning(system.warning, warnings);
    add_warning(file.conversion().warning, warnings);
    const bool same_system = Reprojection(system.wkt, request.crs).changes_nothing();
    const Rectangle span = span_of_points(file.layout());
    if (same_system && request.area && !request.area->touches(span)) {
      throw UserError(
          "{}: the raster ({}) does not reach {} ({}). Check that both are in the same place and reference system.",
          name, format_range(span), request.reason, format_range(*request.area));
    }
    Raster raster = file.read(same_system ? request.area : std::nullopt);
    raster.crs = system.wkt;
    return same_system
               ? raster
               : at_place(name, [&] { return reprojected(raster, request.crs, request.quantity == Quantity::code); });
  });
}

}  // namespace thawslide::gis
