#include "gis/roughness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "base/table.hpp"
#include "gis/sampling.hpp"

namespace thawslide::gis {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr int tile_size = 16;              // points along each axis
constexpr double median_of_unit = 0.6745;  // of |x| for a normal distribution of variance 1
constexpr double rough_fraction = 0.86;    // quantile of the tiles: noise that a seventh of them exceeds
constexpr double striped_fraction = 0.25;  // the same for noise of whole rows or columns, which is due to the survey
constexpr std::size_t least_of_tile = 16;  // minimum number of deviations or slopes

// Deviation of the centre of nine points from their best-fit parabola: weights of the centre and of neighbours 1 to 4
// points away (Savitzky and Golay 1964).
constexpr std::array<double, 5> deviation_weights{172.0 / 231.0, -54.0 / 231.0, -39.0 / 231.0, -14.0 / 231.0,
                                                  21.0 / 231.0};

// For white noise with rms 1: a least-squares fit leaves 1 minus the weight of the centre, 59/231, of the variance.
const double rms_of_deviation = std::sqrt(deviation_weights[0]);

// Width of the Gaussian that separates short waves, relative to the distance that resolves them, and times it is
// subtracted. Waves of length L keep the fraction (1 - exp(-2 pi^2 s^2 / L^2))^3.
constexpr double width_of_short_waves = 2.2;
constexpr int times_of_short_waves = 3;
constexpr double length_of_half = 7.8;  // L relative to the same distance

double resolving(double spacing, double cell) { return std::max(spacing, 0.5 * cell); }

double spacing_of(const Raster& raster) { return std::sqrt(raster.cell_x * raster.cell_y); }

// Variance of a virtual filter for the effect of a cell on bumps. 1/(4 sqrt(pi)) makes the slope of triangles between
// points, 2 rms / spacing, that of noise; 0.0225 follows from the friction measured with points half a cell apart.
double variance_of_cell(double spacing, double cell) {
  return spacing * spacing / (4.0 * std::sqrt(std::numbers::pi)) + 0.0225 * cell * cell;
}

// Quantile of the values that are not NaN; NaN if they are fewer than `least`.
double quantile(std::vector<double> values, double fraction, std::size_t least = 1) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.size() < least) {
    return unknown;
  }
  const auto index = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

// Only the points within the rectangle.
Raster points_within(const Raster& raster, const Rectangle& rectangle) {
  const auto along = [](double low, double high, double start, double cell, int count, int& first, int& number) {
    constexpr double rounding = 1e-9;
    first = std::max(0, static_cast<int>(std::ceil((low - start) / cell - rounding)));
    number = std::max(0, std::min(count, static_cast<int>(std::floor((high - start) / cell + rounding)) + 1) - first);
  };
  PointWindow window;
  along(rectangle.min_x, rectangle.max_x, raster.x, raster.cell_x, raster.columns, window.first_column, window.columns);
  along(rectangle.min_y, rectangle.max_y, raster.y, raster.cell_y, raster.rows, window.first_row, window.rows);
  return window.columns > 0 && window.rows > 0 ? part_of(raster, window) : Raster{};
}

struct Step {
  int column, row;
};
constexpr std::array<Step, 4> directions{Step{1, 0}, Step{0, 1}, Step{1, 1}, Step{1, -1}};

struct Tile {
  int first_column, end_column, first_row, end_row;

  // Median of |value_at(column, row)| over the points; NaN if fewer than 16 are known.
  template <class ValueAt>
  [[nodiscard]] double median_of(const ValueAt& value_at) const {
    std::vector<double> values;
    for (int row = first_row; row < end_row; ++row) {
      for (int column = first_column; column < end_column; ++column) {
        values.push_back(std::abs(value_at(column, row)));
      }
    }
    return quantile(std::move(values), 0.5, least_of_tile);
  }
};

double known_at(const Raster& raster, int column, int row) {
  const bool is_inside = column >= 0 && column < raster.columns && row >= 0 && row < raster.rows;
  return is_inside ? raster.at(column, row) : unknown;
}

// Noise in the directions in which it is smallest and second smallest; NaN if the tile has too few known points.
std::array<double, 2> noise_of_tile(const Raster& raster, const Tile& part) {
  std::array<double, directions.size()> found;
  std::ranges::transform(directions, found.begin(), [&](const Step& step) {
    return part.median_of([&](int column, int row) {
      // Computed relative to the centre's height, so that a high plane causes no round-off.
      const auto rise = [&](int k) {
        return known_at(raster, column + k * step.column, row + k * step.row) - raster.at(column, row);
      };
      double deviation = 0.0;
      for (int k = 1; k <= points_of_fit / 2; ++k) {
        deviation += deviation_weights[static_cast<std::size_t>(k)] * (rise(k) + rise(-k));
      }
      return deviation;
    });
  });
  const auto last = std::remove_if(found.begin(), found.end(), [](double median) { return std::isnan(median); });
  if (last - found.begin() < 2) {
    return {unknown, unknown};
  }
  std::sort(found.begin(), last);
  return {found[0] / (median_of_unit * rms_of_deviation), found[1] / (median_of_unit * rms_of_deviation)};
}

// Rms slope: geometric mean of the extremes of medians in four directions, the maximum limited to twice the minimum,
// because a thalweg, a crest or a cliff is not a bump.
double slope_of_tile(const Raster& raster, const Tile& part) {
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const Step& step : directions) {
    const double distance = std::hypot(step.column * raster.cell_x, step.row * raster.cell_y);
    const double rms = part.median_of([&](int column, int row) {
      return (known_at(raster, column + step.column, row + step.row) - raster.at(column, row)) / distance;
    }) / median_of_unit;
    if (std::isnan(rms)) {
      return unknown;
    }
    least = std::min(least, rms);
    largest = std::max(largest, rms);
  }
  constexpr double most_of_least = 2.0;
  return std::sqrt(2.0 * least * std::min(largest, most_of_least * least));  // of both components
}

// Values for the tiles of a raster.
template <class OfTile>
auto of_tiles(const Raster& raster, const OfTile& of_tile) {
  const int across = std::max(1, raster.columns / tile_size), along = std::max(1, raster.rows / tile_size);
  std::vector<decltype(of_tile(raster, Tile{}))> values(static_cast<std::size_t>(across) *
                                                        static_cast<std::size_t>(along));
  // Index at which the k-th of equal parts begins.
  const auto edge = [](int points, int k, int parts) {
    return static_cast<int>(static_cast<std::int64_t>(points) * k / parts);
  };
  parallel_for(values.size(), [&](std::size_t k) {
    const int i = static_cast<int>(k) % across, j = static_cast<int>(k) / across;
    values[k] = of_tile(raster, Tile{edge(raster.columns, i, across), edge(raster.columns, i + 1, across),
                                     edge(raster.rows, j, along), edge(raster.rows, j + 1, along)});
  });
  return values;
}

// Noise of the tiles in the direction in which it is smallest (0) or second smallest (1); 0 if none has enough points.
double noise_of_tiles(const std::vector<std::array<double, 2>>& tiles, std::size_t direction, double fraction) {
  std::vector<double> values;
  std::ranges::transform(tiles, std::back_inserter(values), [&](const auto& tile) { return tile[direction]; });
  const double noise = quantile(std::move(values), fraction);
  return std::isnan(noise) ? 0.0 : noise;
}

}  // namespace

double noise_rms(const Raster& raster, const Rectangle& rectangle) {
  const Raster within = points_within(raster, rectangle);
  const auto tiles = of_tiles(within, noise_of_tile);
  return std::max(noise_of_tiles(tiles, 0, rough_fraction), noise_of_tiles(tiles, 1, striped_fraction));
}

double noise_below_body(const Raster& raster, const Rectangle& rectangle) {
  const auto missing = [](double length, double cell) { return std::max(0.0, 0.5 * (tile_size * cell - length)); };
  const Rectangle wide = rectangle.widened(missing(rectangle.max_x - rectangle.min_x, raster.cell_x),
                                           missing(rectangle.max_y - rectangle.min_y, raster.cell_y));
  return noise_of_tiles(of_tiles(points_within(raster, wide), noise_of_tile), 0, 0.5);
}

double bump_length(double spacing, double cell) { return length_of_half * resolving(spacing, cell); }

Raster short_waves(const Raster& raster, const Rectangle& rectangle, double cell) {
  const double width = width_of_short_waves * resolving(spacing_of(raster), cell);
  const double reach = times_of_short_waves * smoothing_reach * width;
  Raster waves = points_within(raster, rectangle.widened(reach, reach));
  for (int k = 0; k < times_of_short_waves && !waves.values.empty(); ++k) {
    const Raster smooth = smoothed(waves, width);
    std::ranges::transform(waves.values, smooth.values, waves.values.begin(), std::minus<>());
  }
  return waves;
}

double bump_slope(const Raster& short_waves, const Rectangle& rectangle, double cell, double width) {
  if (short_waves.values.empty()) {
    return 0.0;
  }
  const double of_cell = std::sqrt(variance_of_cell(spacing_of(short_waves), cell));
  const Raster filtered = points_within(smoothed(short_waves, std::max(width, of_cell)), rectangle);
  const double slope = quantile(of_tiles(filtered, slope_of_tile), 0.75);
  return std::isnan(slope) ? 0.0 : slope;
}

double noise_slope(double rms, double spacing, double cell, double width) {
  const double variance = std::max(width * width, variance_of_cell(spacing, cell));
  return rms * spacing / (2.0 * std::sqrt(std::numbers::pi) * variance);
}

double apparent_friction(double slope) {
  static const Table measured({0.0, 0.03, 0.06, 0.11, 0.23, 0.28, 0.56, 10.0},
                              {0.0, 0.01, 0.025, 0.07, 0.20, 0.31, 0.76, 15.93});
  return measured.at(slope);
}

double fitting_width(double rms, double spacing, double cell) {
  if (noise_slope(rms, spacing, cell, 0.0) <= largest_slope) {
    return 0.0;
  }
  const double step = 0.1 * resolving(spacing, cell), widest = 2.0 * std::max(cell, spacing);
  const double fitting = std::sqrt(rms * spacing / (2.0 * std::sqrt(std::numbers::pi) * largest_slope));
  const double steps = std::ceil(std::max(0.0, fitting - 0.5 * spacing) / step - 1e-9);
  return std::min(widest, 0.5 * spacing + steps * step);
}

double narrow_valley(double width) { return 40.0 * width; }

config::Roughness roughness_of(const Raster& raster, const Rectangle& rectangle, double cell,
                               const config::NumberOrAuto& smooth, const std::vector<Rectangle>& bodies) {
  config::Roughness found;
  found.cell = cell;
  found.spacing = spacing_of(raster);
  found.noise = noise_rms(raster, rectangle);
  for (const Rectangle& body : bodies) {
    found.noise = std::max(found.noise, noise_below_body(raster, body));
  }
  const Raster waves = short_waves(raster, rectangle, cell);
  found.bump_length = bump_length(found.spacing, cell);
  found.bump_slope = bump_slope(waves, rectangle, cell, 0.0);
  // Bumps explained by noise count as noise: the two are measured differently, and a thalweg adds to the second.
  const auto remaining_slope = [&](double width) {
    constexpr double explained = 1.25;
    const double noise = noise_slope(found.noise, found.spacing, cell, width);
    const double bumps = bump_slope(waves, rectangle, cell, width);
    return bumps <= explained * noise ? noise : bumps;
  };
  found.width = smooth.number;
  if (smooth.is_auto) {
    // The smallest width, from the width against noise upwards, that leaves little of the bumps, or the maximum.
    constexpr int steps = 15;
    const double least = fitting_width(found.noise, found.spacing, cell);
    const auto width_at = [&](int k) { return std::max(least, (0.5 + 0.1 * k) * found.spacing); };
    const auto is_rough = [&](double width) { return remaining_slope(width) > largest_slope; };
    std::array<int, steps> all{};
    std::iota(all.begin(), all.end(), 0);
    const auto smooth_enough = std::ranges::partition_point(all, [&](int k) { return is_rough(width_at(k)); });
    found.width = !is_rough(least) ? least : width_at(static_cast<int>(smooth_enough - all.begin()));
  }
  found.remaining_slope = remaining_slope(found.width);
  found.apparent_friction = apparent_friction(found.remaining_slope);
  found.narrow_valley = narrow_valley(found.width);
  return found;
}

std::string roughness_warning(const config::Case& parameters, const config::Site& site) {
  constexpr double much_friction = 0.05;
  const config::Roughness& found = *site.roughness;
  const bool is_auto = parameters.terrain.smooth.is_auto;
  if (is_auto ? found.remaining_slope <= largest_slope : found.apparent_friction <= much_friction) {
    return "";
  }
  const std::string remedy = is_auto
                                 ? "That is the widest filter. Use larger cells (grid.cell), or a DEM with less noise."
                                 : "Set terrain.smooth = \"auto\".";
  return fmt::format(
      "terrain.smooth: noise and bumps shorter than {} m add about {:.2g} % to the friction, with a filter of {:g} m "
      "(rms slope {:.2g}; at most {:g} is intended). {}",
      rounded_text(found.bump_length, 2), 100.0 * found.apparent_friction, found.width, found.remaining_slope,
      largest_slope, remedy);
}

}  // namespace thawslide::gis
