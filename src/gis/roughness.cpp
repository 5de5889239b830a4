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

#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "gis/filters.hpp"
#include "gis/point_window.hpp"

namespace thawslide::gis {

namespace {

constexpr int tile_size = 16;              // points along each axis
constexpr double median_of_unit = 0.6745;  // of |x| for a normal distribution of variance 1
constexpr double rough_fraction = 0.86;    // quantile of the tiles: noise that a seventh of them exceeds
constexpr double striped_fraction = 0.25;  // the same for noise of whole rows or columns, which is due to the survey
constexpr std::size_t least_of_tile = 16;  // minimum number of deviations or slopes

// Deviation of the centre of nine points in a line from their best-fit parabola: weights of the centre and of the
// neighbours 1 to 4 points away (Savitzky and Golay 1964: 59, 54, 39, 14, -21 over 231 give the parabola's value
// there).
constexpr std::array<double, 5> deviation_weights{172.0 / 231.0, -54.0 / 231.0, -39.0 / 231.0, -14.0 / 231.0,
                                                  21.0 / 231.0};

// For white noise with rms 1: the fit at the centre has the weight 59/231, and a least-squares fit leaves 1 minus that
// of the variance.
const double rms_of_deviation = std::sqrt(deviation_weights[0]);

// Width of the Gaussian that separates short waves from long ones, relative to the distance that resolves them, and the
// number of times its result is subtracted. Waves of length L keep the fraction (1 - exp(-2 pi^2 s^2 / L^2))^3.
constexpr double width_of_short_waves = 2.2;
constexpr int times_of_short_waves = 3;
constexpr double length_of_half = 7.8;  // L relative to the same distance

double resolving(double spacing, double cell) { return std::max(spacing, 0.5 * cell); }

double spacing_of(const Raster& raster) { return std::sqrt(raster.cell_x * raster.cell_y); }

// Variance of a virtual filter that represents the effect of a cell on bumps without a filter. 1/(4 sqrt(pi)) makes the
// slope of the triangles between the points, 2 rms / spacing, equal to that of noise; 0.0225 follows from the friction
// measured with points half a cell apart.
double variance_of_cell(double spacing, double cell) {
  return spacing * spacing / (4.0 * std::sqrt(std::numbers::pi)) + 0.0225 * cell * cell;
}

double quantile(std::vector<double>& values, double fraction) {
  const auto index = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

// Only the points within the rectangle.
Raster points_within(const Raster& raster, const Rectangle& rectangle) {
  constexpr double rounding = 1e-9;
  const auto first = [](double low, double start, double cell) {
    return std::max(0, static_cast<int>(std::ceil((low - start) / cell - rounding)));
  };
  const auto end = [](double high, double start, double cell, int count) {
    return std::min(count, static_cast<int>(std::floor((high - start) / cell + rounding)) + 1);
  };
  PointWindow window;
  window.first_column = first(rectangle.min_x, raster.x, raster.cell_x);
  window.first_row = first(rectangle.min_y, raster.y, raster.cell_y);
  window.columns = std::max(0, end(rectangle.max_x, raster.x, raster.cell_x, raster.columns) - window.first_column);
  window.rows = std::max(0, end(rectangle.max_y, raster.y, raster.cell_y, raster.rows) - window.first_row);
  return window.columns > 0 && window.rows > 0 ? part_of(raster, window) : Raster{};
}

struct Step {
  int column, row;
};
constexpr std::array<Step, 4> directions{Step{1, 0}, Step{0, 1}, Step{1, 1}, Step{1, -1}};

// Adds the deviation if the line of points lies in the raster and is known.
void add_deviation(const Raster& raster, int column, int row, const Step& step, std::vector<double>& deviations) {
  constexpr int reach = points_of_fit / 2;
  const auto is_in = [&](int k) {
    return column + k * step.column >= 0 && column + k * step.column < raster.columns && row + k * step.row >= 0 &&
           row + k * step.row < raster.rows;
  };
  if (!is_in(-reach) || !is_in(reach)) {
    return;
  }
  const auto at = [&](int k) { return raster.at(column + k * step.column, row + k * step.row); };
  // Computed relative to the centre's height, so that a high plane causes no round-off.
  double deviation = 0.0;
  for (int k = 1; k <= reach; ++k) {
    deviation += deviation_weights[static_cast<std::size_t>(k)] * ((at(k) - at(0)) + (at(-k) - at(0)));
  }
  if (!std::isnan(deviation)) {
    deviations.push_back(std::abs(deviation));
  }
}

struct Tile {
  int first_column, end_column, first_row, end_row;
};

// Index at which the k-th of `parts` equal parts of `points` begins.
int edge(int points, int k, int parts) { return static_cast<int>(static_cast<std::int64_t>(points) * k / parts); }

// Noise in the directions in which it is smallest and second smallest; NaN if the tile has too few known points.
std::array<double, 2> noise_of_tile(const Raster& raster, const Tile& part) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> found;
  for (const Step step : directions) {
    std::vector<double> deviations;
    for (int row = part.first_row; row < part.end_row; ++row) {
      for (int column = part.first_column; column < part.end_column; ++column) {
        add_deviation(raster, column, row, step, deviations);
      }
    }
    if (deviations.size() >= least_of_tile) {
      found.push_back(quantile(deviations, 0.5) / (median_of_unit * rms_of_deviation));
    }
  }
  if (found.size() < 2) {
    return {unknown, unknown};
  }
  std::partial_sort(found.begin(), found.begin() + 2, found.end());
  return {found[0], found[1]};
}

// Rms slope, from the medians in four directions. The mean of the minimum and the maximum is their geometric one, with
// the maximum limited to twice the minimum. Features with little slope along themselves, such as a thalweg, a crest or
// a cliff, are not bumps.
double slope_of_tile(const Raster& raster, const Tile& part) {
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const Step step : directions) {
    std::vector<double> slopes;
    const double distance = std::hypot(step.column * raster.cell_x, step.row * raster.cell_y);
    for (int row = std::max(part.first_row, -step.row); row < std::min(part.end_row, raster.rows - step.row); ++row) {
      for (int column = part.first_column; column < std::min(part.end_column, raster.columns - step.column); ++column) {
        const double slope = (raster.at(column + step.column, row + step.row) - raster.at(column, row)) / distance;
        if (!std::isnan(slope)) {
          slopes.push_back(std::abs(slope));
        }
      }
    }
    if (slopes.size() < least_of_tile) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const double rms = quantile(slopes, 0.5) / median_of_unit;
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
  using Value = decltype(of_tile(raster, Tile{}));
  std::vector<Value> values(static_cast<std::size_t>(across) * static_cast<std::size_t>(along));
  parallel_for(values.size(), [&](std::size_t k) {
    const int i = static_cast<int>(k) % across, j = static_cast<int>(k) / across;
    values[k] = of_tile(raster, Tile{edge(raster.columns, i, across), edge(raster.columns, i + 1, across),
                                     edge(raster.rows, j, along), edge(raster.rows, j + 1, along)});
  });
  return values;
}

// Quantile of the finite values; 0 if there are none.
double quantile_of_known(std::vector<double> values, double fraction) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double value) { return std::isnan(value); }),
               values.end());
  return values.empty() ? 0.0 : quantile(values, fraction);
}

// Noise of the tiles in the direction in which it is smallest (0) or second smallest (1).
double noise_of_tiles(const std::vector<std::array<double, 2>>& tiles, std::size_t direction, double fraction) {
  std::vector<double> values;
  std::ranges::transform(tiles, std::back_inserter(values),
                         [&](const std::array<double, 2>& tile) { return tile[direction]; });
  return quantile_of_known(std::move(values), fraction);
}

// Slope due to noise and bumps. Bumps explained by noise count as noise, because the two are measured differently, and
// a thalweg slightly increases the second one.
double slope_of(double noise, double bumps) {
  constexpr double explained = 1.25;
  return bumps <= explained * noise ? noise : bumps;
}

// Noise and bumps of a rectangle, filtered.
struct Filtered {
  const Raster& waves;
  const Rectangle& rectangle;
  double noise, spacing, cell;

  [[nodiscard]] double slope(double width) const {
    return slope_of(noise_slope(noise, spacing, cell, width), bump_slope(waves, rectangle, cell, width));
  }
  // Smallest width, from the width against noise upwards, that leaves little of the bumps, or the maximum.
  [[nodiscard]] double fitting_width() const {
    const double width = gis::fitting_width(noise, spacing, cell);
    if (slope(width) <= largest_slope) {
      return width;
    }
    constexpr int steps = 15;
    const auto width_at = [&](int k) { return std::max(width, (0.5 + 0.1 * k) * spacing); };
    int low = 0, high = steps;
    while (low < high) {
      const int middle = (low + high) / 2;
      if (slope(width_at(middle)) <= largest_slope) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return width_at(low);
  }
};

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
  return quantile_of_known(of_tiles(filtered, slope_of_tile), 0.75);
}

double noise_slope(double rms, double spacing, double cell, double width) {
  const double variance = std::max(width * width, variance_of_cell(spacing, cell));
  return rms * spacing / (2.0 * std::sqrt(std::numbers::pi) * variance);
}

double apparent_friction(double slope) {
  struct Measured {
    double slope, friction;
  };
  constexpr std::array<Measured, 7> measured{
      {{0.0, 0.0}, {0.03, 0.01}, {0.06, 0.025}, {0.11, 0.07}, {0.23, 0.20}, {0.28, 0.31}, {0.56, 0.76}}};
  std::size_t k = 1;
  while (k + 1 < measured.size() && slope > measured[k].slope) {
    ++k;
  }
  const Measured &low = measured[k - 1], &high = measured[k];
  return low.friction + (high.friction - low.friction) * (slope - low.slope) / (high.slope - low.slope);
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
  const Filtered filtered{waves, rectangle, found.noise, found.spacing, cell};
  found.width = smooth.is_auto ? filtered.fitting_width() : smooth.number;
  found.remaining_slope = filtered.slope(found.width);
  found.apparent_friction = apparent_friction(found.remaining_slope);
  found.narrow_valley = narrow_valley(found.width);
  return found;
}

namespace {

// Cells that follow the terrain average it. On terrain with bumps and without a filter of their size, each cell has its
// own ground, unless cells are as small as the distance of the points.
std::string note_of_ground(const config::Roughness& found) {
  constexpr double slope_of_smooth_ground = 0.01;
  const double resolved = std::max(found.width, found.spacing);
  if (found.bump_slope < slope_of_smooth_ground || resolved >= found.cell * (1.0 - 1e-9)) {
    return "";
  }
  return fmt::format(
      "note: terrain.smooth is {:g} m and grid.cell {:g} m: cells larger than the filter smooth the ground further. To "
      "compare runs on several cells, set terrain.smooth to the largest of them in each run.",
      found.width, found.cell);
}

}  // namespace

std::string roughness_warning(const config::Case& parameters, const config::Site& site) {
  constexpr double much_friction = 0.05;
  const config::Roughness& found = *site.roughness;
  const bool is_auto = parameters.terrain.smooth.is_auto;
  if (is_auto ? found.remaining_slope <= largest_slope : found.apparent_friction <= much_friction) {
    return note_of_ground(found);
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
