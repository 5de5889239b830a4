// Resampled points, tapers and values between points. The Gaussian filter: planes, means, edges and holes, and the
// wedge effect of valleys.

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "gis/release.hpp"
#include "gis/roughness.hpp"
#include "gis/sampling.hpp"
#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

double plane(double x, double y) { return 2000.0 + 0.3 * x - 0.7 * y; }

TEST(ResamplingTest, PlanesStayPlanes) {
  Raster raster = raster_of(plane, 0.0, 0.0, 4.9977, 41, 37);
  for (const double distance : {2.0, 4.9977, 7.5, 20.0}) {
    const Raster layout = resampled_layout(raster, distance);
    const Raster made = resampled(raster, layout);
    ASSERT_GT(made.values.size(), 10U);
    EXPECT_GE(made.x, raster.x);
    EXPECT_LE(made.x_end(), raster.x_end() + 1e-9);
    EXPECT_GT(made.x_end(), raster.x_end() - 1.5 * distance);
    for_points(made, [&](int column, int row) {
      EXPECT_NEAR(made.at(column, row), plane(made.x_of(column), made.y_of(row)), 1e-9) << distance;
    });
  }
}

TEST(ResamplingTest, SameSpacingKeepsEveryBit) {
  const Raster raster = raster_of([](double x, double y) { return std::sin(x) * y; }, 3.0, 4.0, 5.0, 12, 9);
  EXPECT_EQ(resampled(raster, resampled_layout(raster, 5.0)).values, raster.values);
}

// Half the spacing: the mean of two and of four neighbours. Twice the spacing: weights 1/8, 3/8, 3/8, 1/8 along an axis
// about a position half-way between points.
TEST(ResamplingTest, WeightsAreThoseOfTheFormulas) {
  const Raster raster =
      raster_of([](double x, double y) { return x == 2.0 && y == 2.0 ? 64.0 : 0.0; }, 0.0, 0.0, 1.0, 6, 6);
  const Raster fine = resampled(raster, resampled_layout(raster, 0.5));
  EXPECT_EQ(fine.at(4, 4), 64.0);
  EXPECT_EQ(fine.at(5, 4), 32.0);
  EXPECT_EQ(fine.at(5, 5), 16.0);
  EXPECT_EQ(fine.at(6, 4), 0.0);
  const Raster layout = resampled_layout(raster, 2.0);
  EXPECT_EQ(layout.x, 1.0);
  const Raster coarse = resampled(raster, layout);
  EXPECT_EQ(coarse.columns, 2);
  // Points at 1 and 3: the mean over 0 .. 2 of the linear shape function at 2 is 1/4; so is that over 2 .. 4.
  EXPECT_NEAR(coarse.at(0, 0), 4.0, 1e-12);
  EXPECT_NEAR(coarse.at(1, 1), 4.0, 1e-12);
}

TEST(ResamplingTest, HolesRemainAndDoNotGrow) {
  Raster raster = raster_of(plane, 0.0, 0.0, 1.0, 9, 9);
  raster.values[raster.index(4, 4)] = missing;
  const Raster fine = resampled(raster, resampled_layout(raster, 0.5));
  EXPECT_TRUE(std::isnan(fine.at(8, 8)));
  EXPECT_TRUE(std::isnan(fine.at(7, 8)));
  EXPECT_FALSE(std::isnan(fine.at(6, 8)));
  const Raster coarse = resampled(raster, resampled_layout(raster, 4.0));
  EXPECT_FALSE(std::isnan(coarse.at(0, 0)));
}

TEST(ResamplingTest, TaperKeepsTheVolumeAndReachesHalfItsWidth) {
  const Raster thickness =
      raster_of([](double x, double y) { return std::abs(x) < 31.0 && std::abs(y) < 21.0 ? 10.0 : 0.0; }, -60.0, -60.0,
                2.0, 61, 61);
  const auto volume = [](const Raster& raster) {
    return std::accumulate(raster.values.begin(), raster.values.end(), 0.0);
  };
  const Raster soft = tapered(thickness, 12.0);
  EXPECT_NEAR(volume(soft), volume(thickness), 1e-12 * volume(thickness));
  EXPECT_NEAR(soft.at(30, 30), 10.0, 1e-12);
  // The last point with a thickness is at x = 30, the next at 32: the weights extend over two points on each side.
  EXPECT_EQ(taper_reach(12.0, 2.0), 2);
  EXPECT_GT(soft.at(47, 30), 0.0);
  EXPECT_EQ(soft.at(48, 30), 0.0);
  for (int column = 30; column < 48; ++column) {
    EXPECT_LE(soft.at(column + 1, 30), soft.at(column, 30) + 1e-12);
  }
  EXPECT_EQ(tapered(thickness, 0.0).values, thickness.values);
  EXPECT_EQ(tapered(thickness, 4.0).values, thickness.values);
}

TEST(ResamplingTest, GradientsAndThicknessAlongTheNormal) {
  Raster raster = raster_of(plane, 0.0, 0.0, 5.0, 5, 4);
  for (const auto& [column, row] : {std::pair{2, 2}, std::pair{0, 0}, std::pair{4, 3}}) {
    EXPECT_NEAR(gradient_at(raster, column, row).x, 0.3, 1e-12);
    EXPECT_NEAR(gradient_at(raster, column, row).y, -0.7, 1e-12);
  }
  raster.values[raster.index(3, 2)] = missing;
  EXPECT_NEAR(gradient_at(raster, 2, 2).x, 0.3, 1e-12);
  // A 3-4-5 triangle: a slope whose cosine is 0.8.
  EXPECT_NEAR(vertical_thickness(8.0, 0.75, 0.0), 10.0, 1e-12);
  EXPECT_NEAR(vertical_thickness(8.0, 0.45, -0.6), 10.0, 1e-12);
}

using namespace map_files;

// With holes of several shapes, a line of known points between two of them, and one isolated known point.
Raster plane_with_holes() {
  Raster raster = raster_of(plane, 0.0, 0.0, 2.0, 61, 47);
  for_points(raster, [&](int column, int row) {
    const bool corner = column + row < 15;
    const bool next_to_line = column > 40 && column < 60 && row > 20 && row < 30 && row != 25;
    const bool about_point = std::abs(column - 20) < 6 && std::abs(row - 30) < 6 && (column != 20 || row != 30);
    if (corner || next_to_line || about_point) {
      raster.values[raster.index(column, row)] = missing;
    }
  });
  return raster;
}

double mean(const Raster& raster) {
  return std::accumulate(raster.values.begin(), raster.values.end(), 0.0) / static_cast<double>(raster.values.size());
}

// The same, further than a margin from the edges.
Raster with_noise(const Raster& raster, double rms, unsigned seed, int margin) {
  Raster made = raster;
  const Raster noisy = map_files::with_noise(raster, rms, seed);
  for_points(raster, [&](int column, int row) {
    if (std::min({column, row, raster.columns - 1 - column, raster.rows - 1 - row}) >= margin) {
      made.values[raster.index(column, row)] = noisy.at(column, row);
    }
  });
  return made;
}

TEST(SmoothingTest, PlanesStayPlanesAtEveryEdgeOfTheKnownArea) {
  const Raster raster = plane_with_holes();
  for (const double width : {0.1, 1.0, 3.0, 10.0, 100.0, 1e12}) {
    const Raster smooth = smoothed(raster, width);
    for (std::size_t k = 0; k < raster.values.size(); ++k) {
      ASSERT_EQ(std::isnan(smooth.values[k]), std::isnan(raster.values[k])) << k << " at " << width;
      if (!std::isnan(raster.values[k])) {
        ASSERT_NEAR(smooth.values[k], raster.values[k], 1e-9) << k << " at " << width;
      }
    }
  }
  const Raster line = raster_of(plane, 0.0, 0.0, 2.0, 30, 1);
  const Raster smooth = smoothed(line, 5.0);
  for (int k = 0; k < line.columns; ++k) {
    EXPECT_NEAR(smooth.at(k, 0), line.at(k, 0), 1e-9) << k;
  }
}

// A wave of wavenumber k keeps exp(-k^2 s^2 / 2) of its height, along both axes and with different spacings along them.
TEST(SmoothingTest, WavesAreDampedByTheGaussianFactor) {
  Raster wave = raster_of([](double x, double) { return x; }, 0.0, 0.0, 0.5, 201, 121);
  wave.cell_y = 0.8;
  for_points(wave, [&](int column, int row) {
    wave.values[wave.index(column, row)] =
        std::cos(0.3 * (wave.x_of(column) - 50.0)) * std::cos(0.2 * (wave.y_of(row) - 48.0));
  });
  EXPECT_NEAR(smoothed(wave, 2.0).at(100, 60), std::exp(-0.5 * (0.09 + 0.04) * 4.0), 1e-4);
}

TEST(SmoothingTest, MeanHeightIsConserved) {
  const Raster slope = raster_of(plane, 0.0, 0.0, 1.0, 90, 80);
  for (const double width : {0.5, 1.0, 2.0}) {
    // Exact if the rough part is more than two filter widths from the edge.
    const Raster inside = with_noise(slope, 1.0, 7, 18);
    EXPECT_NEAR(mean(smoothed(inside, width)), mean(inside), 1e-9) << width;
    // Noise at the edges, too: its own mean varies by rms / sqrt(points) = 0.012; the filter changes it by less.
    const Raster everywhere = with_noise(slope, 1.0, 8, 0);
    EXPECT_NEAR(mean(smoothed(everywhere, width)), mean(everywhere), 0.01) << width;
  }
}

// White noise of rms r is reduced to r d / (2 sqrt(pi) s), and its slope to r d / (2 sqrt(pi) s^2).
TEST(SmoothingTest, NoiseIsReducedAccordingToTheFormula) {
  const Raster noise = with_noise(raster_of(plane, 0.0, 0.0, 1.0, 200, 200), 1.0, 3, 0);
  const double width = 2.0;
  const Raster smooth = smoothed(noise, width);
  double heights = 0.0, slopes = 0.0;
  int points = 0;
  for (int row = 10; row < 189; ++row) {
    for (int column = 10; column < 189; ++column, ++points) {
      const double along_x = smooth.at(column + 1, row) - smooth.at(column, row) - 0.3;
      const double along_y = smooth.at(column, row + 1) - smooth.at(column, row) + 0.7;
      heights += std::pow(smooth.at(column, row) - plane(column, row), 2);
      slopes += along_x * along_x + along_y * along_y;
    }
  }
  const double kept = 1.0 / (2.0 * std::sqrt(M_PI) * width);
  EXPECT_NEAR(std::sqrt(heights / points), kept, 0.05 * kept);
  EXPECT_NEAR(std::sqrt(slopes / points), kept / width, 0.05 * kept / width);
}

// Average load over the width of a fill with a level surface, whose walls carry p = rho g times the depth. The friction
// of a channel is mu times this factor.
double wedge_factor(const std::function<double(int)>& height, double step, double level) {
  double area = 0.0, width = 0.0;
  for (int k = -4000; k < 4000; ++k) {
    const double depth = std::max(0.0, level - 0.5 * (height(k) + height(k + 1)));
    area += depth * std::hypot(step, height(k + 1) - height(k));
    width += depth * step;
  }
  return area / width;
}

// Reduction of the wedge effect of V-shaped valleys by the filter, for a filled width in standard deviations.
double wedge_lost(double opening, double width) {
  const double wall = 1.0 / std::tan(0.5 * opening * M_PI / 180.0), step = width / 6000.0;
  const auto smooth = [&](int k) {
    const double x = k * step;
    return wall * (x * std::erf(x / std::sqrt(2.0)) + std::sqrt(2.0 / M_PI) * std::exp(-0.5 * x * x));
  };
  return 1.0 - wedge_factor(smooth, step, 0.5 * width * wall) * std::sin(0.5 * opening * M_PI / 180.0);
}

// docs/theory/roughness.md
TEST(FilteredValley, NarrowValleysLoseThreePercentOfTheirWedge) {
  EXPECT_NEAR(wedge_lost(90.0, narrow_valley(1.0)), 0.03, 0.0005);
}

TEST(FilteredValley, HasTheWedgeOfTheTable) {
  // Four points per standard deviation.
  const Raster valley = raster_of([](double x, double) { return std::abs(x); }, -25.0, 0.0, 0.25, 201, 41);
  const Raster smooth = smoothed(valley, 1.0);
  const auto height = [&](int k) { return std::abs(k) > 100 ? 25.0 : smooth.at(k + 100, 20); };
  for (const double width : {4.0, 8.0, 16.0}) {
    const double lost = 1.0 - wedge_factor(height, 0.25, 0.5 * width) / std::sqrt(2.0);
    EXPECT_NEAR(lost, wedge_lost(90.0, width), 0.003) << width;
  }
}

}  // namespace
}  // namespace thawslide::gis
