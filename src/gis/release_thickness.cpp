// Vertical thickness of a release.
#include <optional>
#include <utility>

#include "base/rounding.hpp"
#include "base/text.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/release.hpp"
#include "gis/sampling.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

namespace {

using config::MapValue;

class ThicknessMaker {
 public:
  ThicknessMaker(const ReleaseInput& input, const ReleaseArea& area)
      : input_(input), body_(input.body), area_(area), ground_(input.ground.raster) {}

  Raster make() {
    Raster thickness = thickness_before_taper();
    check_ground(thickness, Spread::by_outline);
    if (body_.thickness_along == config::ThicknessAlong::normal) {
      for_each_positive(thickness, [&](int column, int row, double& value) {
        const auto [i, j] = *in_ground(column, row);
        const Gradient gradient = gradient_at(ground_, i, j);
        value = vertical_thickness(value, gradient.x, gradient.y);
      });
    }
    thickness = tapered(thickness, body_.taper);
    check_ground(thickness, Spread::by_taper);
    return thickness;
  }

 private:
  enum class Spread { by_outline, by_taper };

  // Indices of a point of the area in the ground raster; nothing if there is no ground.
  [[nodiscard]] std::optional<std::pair<int, int>> in_ground(int column, int row) const {
    const Raster& fraction = area_.fraction;
    const int i = column + static_cast<int>(std::lround((fraction.x - ground_.x) / ground_.cell_x));
    const int j = row + static_cast<int>(std::lround((fraction.y - ground_.y) / ground_.cell_y));
    const bool is_inside = i >= 0 && j >= 0 && i < ground_.columns && j < ground_.rows;
    return is_inside && !std::isnan(ground_.at(i, j)) ? std::optional(std::pair(i, j)) : std::nullopt;
  }

  // Calls work(column, row, value) for the points with a value.
  template <class Work>
  static void for_each_positive(Raster& raster, const Work& work) {
    for_each_point(raster, [&](int column, int row, double& value) {
      if (value > 0.0) {
        work(column, row, value);
      }
    });
  }

  // `spread`: method that distributed the release to its points.
  void check_ground(Raster& thickness, Spread spread) const {
    int without = 0;
    std::string first;
    for_each_positive(thickness, [&](int column, int row, double) {
      if (!in_ground(column, row) && without++ == 0) {
        first = fmt::format("{}, {}", coordinate_text(thickness.x_of(column)), coordinate_text(thickness.y_of(row)));
      }
    });
    if (without > 0 && spread == Spread::by_taper) {
      input_.fail("taper",
                  "a taper of {:g} m spreads the release of {} over nodata of the DEM at {} points, such as {}. Set a "
                  "narrower one, or fill the holes (gdal_fillnodata.py {} filled.tif).",
                  body_.taper, input_.area_file(), without, first, shell_quote(input_.dem_file));
    }
    if (without > 0) {
      input_.fail(input_.area_key(),
                  "{}: the release lies over nodata of the DEM at {} of its points, such as {}. Fill the holes "
                  "(gdal_fillnodata.py {} filled.tif), or move the release.",
                  input_.area_file(), without, first, shell_quote(input_.dem_file));
    }
  }

  Raster thickness_before_taper() const {
    switch (body_.thickness.from) {
      case MapValue::From::number:
        return times_fraction(area_.fraction.filled(body_.thickness.number));
      case MapValue::From::attribute:
        return of_attribute();
      case MapValue::From::raster:
      case MapValue::From::surface:
        break;
    }
    if (area_.is_raster()) {
      require_not_negative(area_.source, nullptr);
      return sampled(area_.source, area_.fraction, Missing::zero);
    }
    return body_.thickness.from == MapValue::From::raster ? of_raster() : of_surface();
  }

  Raster of_attribute() const {
    Raster thickness = area_.fraction.filled(0.0);
    for (const ValuedArea& part : at_place(input_.place("thickness"), [&] {
           return areas_by_value(area_.layer, body_.thickness.source, input_.full_key("thickness"));
         })) {
      if (part.value < 0.0) {
        input_.fail("thickness", "{}: the attribute '{}' is {:g} m somewhere; allowed: 0 and more.", body_.release,
                    body_.thickness.source, part.value);
      }
      const Raster fraction = coverage_of(part.polygons, area_.fraction);
      for (std::size_t k = 0; k < fraction.values.size(); ++k) {
        thickness.values[k] += part.value * fraction.values[k];
      }
    }
    return thickness;
  }

  Raster read_thickness_map() const {
    return read_map({{body_.thickness.source, input_.place("thickness")},
                     Quantity::length,
                     ground_.crs,
                     span_of_points(area_.fraction),
                     "the release",
                     body_.thickness.from == MapValue::From::surface ? input_.ground.heights : ""},
                    input_.warnings);
  }

  Raster of_raster() const {
    const Raster source = read_thickness_map();
    if (is_finer(source, area_.fraction)) {
      return of_finer_raster(source);
    }
    const Raster map = sampled(source, area_.fraction, Missing::zero);
    require_not_negative(map, &area_.fraction);
    return times_fraction(map);
  }

  // Raster cells across an outline may share an area with a ground cell beyond it; the others receive this volume.
  Raster of_finer_raster(const Raster& source) const {
    const CoveredRaster part = covered_part(source, area_.polygons);
    require_not_negative(part.values, &part.fraction);
    const Raster amount = averaged(part, area_.fraction).amount;
    Raster within = amount;
    for (std::size_t k = 0; k < within.values.size(); ++k) {
      within.values[k] = area_.fraction.values[k] > 0.0 ? within.values[k] : 0.0;
    }
    const double scale = volume_of(within) > 0.0 ? volume_of(amount) / volume_of(within) : 1.0;
    for (double& value : within.values) {
      value *= scale;
    }
    return within;
  }

  Raster of_surface() const {
    const Raster surface = read_thickness_map(), &measured = input_.ground.as_measured();
    const Raster above =
        is_finer(surface, area_.fraction)
            ? averaged(covered_part(above_ground(surface, measured), area_.polygons), area_.fraction).mean
            : above_ground(sampled(surface, area_.fraction, Missing::nothing), measured);
    Raster thickness = area_.fraction;
    for_each_positive(thickness, [&](int column, int row, double& value) {
      const double difference = above.at(column, row);
      const auto specified = [&](const std::string& what) {
        input_.fail("thickness", "{}: at {}, {}, within the release, {}", body_.thickness.source,
                    coordinate_text(above.x_of(column)), coordinate_text(above.y_of(row)), what);
      };
      if (!in_ground(column, row)) {
        return;
      }
      if (std::isnan(difference)) {
        specified("the surface has no data. Fill it, or draw the release smaller.");
      }
      if (difference < -body_.surface_tolerance) {
        specified(
            fmt::format("the surface before the slide lies {} m below the DEM; allowed: above it, or below by up to "
                        "{:g} m. Are the two files swapped? Else draw the release smaller, or set "
                        "body.{}.surface_tolerance to the noise of the two.",
                        rounded_text(-difference, 3), body_.surface_tolerance, input_.name));
      }
      value *= difference > body_.surface_tolerance ? difference : 0.0;
    });
    return thickness;
  }

  Raster times_fraction(const Raster& map) const {
    Raster thickness = area_.fraction;
    for (std::size_t k = 0; k < thickness.values.size(); ++k) {
      thickness.values[k] *= thickness.values[k] > 0.0 ? map.values[k] : 0.0;
    }
    return thickness;
  }

  // `fraction`: at the same points, those that count; null: all of them.
  void require_not_negative(const Raster& raster, const Raster* fraction) const {
    for_each_point(raster, [&](int column, int row, double value) {
      if (value < 0.0 && (fraction == nullptr || fraction->at(column, row) > 0.0)) {
        input_.fail("thickness", "{}: the thickness at {}, {} is {:g} m; allowed: 0 and more.", body_.thickness.source,
                    coordinate_text(raster.x_of(column)), coordinate_text(raster.y_of(row)), value);
      }
    });
  }

  const ReleaseInput& input_;
  const config::Body& body_;
  const ReleaseArea& area_;
  const Raster& ground_;
};

}  // namespace

Raster vertical_thickness_of(const ReleaseInput& input, const ReleaseArea& area) {
  return ThicknessMaker(input, area).make();
}

}  // namespace thawslide::gis
