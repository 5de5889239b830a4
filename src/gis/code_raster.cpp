#include "gis/code_raster.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "gis/error_location.hpp"
#include "gis/map_raster.hpp"
#include "gis/point_window.hpp"
#include "gis/reference_system.hpp"
#include "gis/reprojection.hpp"

namespace thawslide::gis {

namespace {

std::string name_of_file(const std::string& file) { return std::filesystem::path(file).filename().string(); }

// Removes round-off of values that are stored with a scale.
void make_whole(const std::string& file, Raster& codes) {
  constexpr double round_off = 1e-9;
  for (int row = 0; row < codes.rows; ++row) {
    for (int column = 0; column < codes.columns; ++column) {
      double& code = codes.values[codes.index(column, row)];
      const double whole = std::round(code);
      if (std::abs(code - whole) <= round_off * std::max(1.0, std::abs(code))) {
        code = whole;
      } else if (!std::isnan(code)) {
        throw UserError(
            "{}: the raster holds {:g} at {}, {}; allowed: whole numbers, the codes of substrates. Check that it is "
            "the right file.",
            file, code, coordinate_text(codes.x_of(column)), coordinate_text(codes.y_of(row)));
      }
    }
  }
}

// Value of the nearest point at each point of a layout; NaN outside their cells.
Raster nearest_codes(const std::string& file, const Raster& codes, const Raster& layout) {
  const Reprojection reprojection(layout.crs, codes.crs);
  Raster sampled_codes = layout.filled(std::numeric_limits<double>::quiet_NaN());
  for (int row = 0; row < layout.rows; ++row) {
    std::vector<double> x, y;
    for (int column = 0; column < layout.columns; ++column) {
      x.push_back(layout.x_of(column));
      y.push_back(layout.y_of(row));
    }
    if (!reprojection.apply(x, y)) {
      throw UserError(
          "{}: points of the ground have no place in the raster's coordinate reference system, {}. Reproject the "
          "raster to {}.",
          file, name_of(codes.crs), name_of(layout.crs));
    }
    for (int column = 0; column < layout.columns; ++column) {
      const auto k = static_cast<std::size_t>(column);
      const double i = std::floor((x[k] - codes.x) / codes.cell_x + 0.5);
      const double j = std::floor((y[k] - codes.y) / codes.cell_y + 0.5);
      if (i >= 0.0 && j >= 0.0 && i < codes.columns && j < codes.rows) {
        sampled_codes.values[sampled_codes.index(column, row)] = codes.at(static_cast<int>(i), static_cast<int>(j));
      }
    }
  }
  return sampled_codes;
}

void count(CodesFound::Points& points, double x, double y) {
  if (points.count++ == 0) {
    points.extent = {x, y, x, y};
  }
  points.extent.include(x, y);
}

std::string format_fraction(const CodesFound::Points& points, const CodesFound& found) {
  return fmt::format("{:.2g} % of the domain, {}",
                     100.0 * static_cast<double>(points.count) / static_cast<double>(found.count),
                     format_range(points.extent));
}

}  // namespace

Raster read_codes(const config::Case& parameters, const std::string& key, const std::string& file, const Raster& ground,
                  std::vector<std::string>& warnings) {
  Raster codes =
      read_map(parameters, {key, file, Quantity::code, ground.crs, domain_of(parameters), "the domain"}, warnings);
  return with_error_location(parameters, key, [&] {
    make_whole(file, codes);
    if (Reprojection(codes.crs, ground.crs).changes_nothing()) {
      return codes;
    }
    warnings.push_back(fmt::format("note: the codes of {}, which is in {}, were resampled to the points of the DEM",
                                   name_of_file(file), name_of(codes.crs)));
    return nearest_codes(file, codes, ground);
  });
}

CodesFound codes_in(const Rectangle& area, const Raster& codes) {
  CodesFound found;
  for (int row = 0; row < codes.rows; ++row) {
    for (int column = 0; column < codes.columns; ++column) {
      const double x = codes.x_of(column), y = codes.y_of(row), code = codes.at(column, row);
      if (area.contains(x, y)) {
        ++found.count;
        count(std::isnan(code) ? found.without : found.by_code[code], x, y);
      }
    }
  }
  return found;
}

std::string format_codes(const CodesFound& found) {
  std::string words;
  std::size_t k = 0;
  for (const auto& [code, points] : found.by_code) {
    words += fmt::format("{}{:g}", k == 0 ? "" : k + 1 == found.by_code.size() ? " and " : ", ", code);
    ++k;
  }
  return words.empty() ? "none" : words;
}

std::vector<std::string> warnings_of_codes(const Rectangle& domain, const std::string& file, const Raster& codes,
                                           const std::set<double>& named) {
  const CodesFound found = codes_in(domain, codes);
  const std::string name = name_of_file(file);
  std::vector<std::string> warnings;
  for (const auto& [code, points] : found.by_code) {
    if (named.count(code) == 0) {
      warnings.push_back(fmt::format("the code {:g} of {} ({}) belongs to no substrate: [basal] applies there", code,
                                     name, format_fraction(points, found)));
    }
  }
  if (found.without.count > 0) {
    warnings.push_back(fmt::format("{} has no data at {} of its points in the domain ({}): [basal] applies there", name,
                                   found.without.count, format_fraction(found.without, found)));
  }
  const Rectangle covered = span_of_points(codes).widened(0.5 * codes.cell_x, 0.5 * codes.cell_y);
  if (const std::string beyond = describe_overhang(domain, covered); !beyond.empty()) {
    warnings.push_back(fmt::format("{} does not cover the domain, which reaches beyond it by {}: [basal] applies there",
                                   name, beyond));
  }
  return warnings;
}

}  // namespace thawslide::gis
