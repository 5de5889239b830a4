#include "gis/error_location.hpp"

#include "base/rounding.hpp"

namespace thawslide::gis {

void fail_at(const config::Case& parameters, const std::string& key, const std::string& message) {
  const std::string& location = config::location_of(parameters, key);
  // A command option such as --dem is sufficient; a location in a file and --set need the key.
  const bool is_option = location.rfind("--", 0) == 0 && location.rfind("--set", 0) != 0;
  throw UserError(is_option ? fmt::format("{}: {}", location, message)
                            : fmt::format("{}: {}: {}", location, key, message));
}

void add_warning(const std::string& warning, std::vector<std::string>& warnings) {
  if (!warning.empty()) {
    warnings.push_back(warning);
  }
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
  std::string words;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    words += (k == 0 ? "" : k + 1 == sides.size() ? " and " : ", ") + sides[k];
  }
  return words;
}

std::string format_range(const Rectangle& rectangle) {
  return fmt::format("x from {} to {}, y from {} to {}", coordinate_text(rectangle.min_x),
                     coordinate_text(rectangle.max_x), coordinate_text(rectangle.min_y),
                     coordinate_text(rectangle.max_y));
}

Rectangle domain_of(const config::Case& parameters) {
  const auto& [min, max] = std::pair(parameters.grid.min, parameters.grid.max);
  return {min[0], min[1], max[0], max[1]};
}

}  // namespace thawslide::gis
