// The Gaussian filter: planes, means, edges and holes.
#include "gis/smoothing.hpp"

#include <numeric>
#include <random>

#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

double plane(double x, double y) { return 2000.0 + 0.3 * x - 0.7 * y; }

// With holes of several shapes, a line of known points between two of them, and one isolated known point.
Raster plane_with_holes() {
  Raster raster = raster_of(plane, 0.0, 0.0, 2.0, 61, 47);
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const bool corner = column + row < 15;
      const bool next_to_line = column > 40 && column < 60 && row > 20 && row < 30 && row != 25;
      const bool about_point = std::abs(column - 20) < 6 && std::abs(row - 30) < 6 && (column != 20 || row != 30);
      if (corner || next_to_line || about_point) {
        raster.values[raster.index(column, row)] = missing;
      }
    }
  }
  return raster;
}

double mean(const Raster& raster) {
  return std::accumulate(raster.values.begin(), raster.values.end(), 0.0) / static_cast<double>(raster.values.size());
}

Raster with_noise(Raster raster, double rms, unsigned seed, int margin) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, rms);
  for (int row = margin; row < raster.rows - margin; ++row) {
    for (int column = margin; column < raster.columns - margin; ++column) {
      raster.values[raster.index(column, row)] += normal(random);
    }
  }
  return raster;
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
  for (int row = 0; row < wave.rows; ++row) {
    for (int column = 0; column < wave.columns; ++column) {
      wave.values[wave.index(column, row)] =
          std::cos(0.3 * (wave.x_of(column) - 50.0)) * std::cos(0.2 * (wave.y_of(row) - 48.0));
    }
  }
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

}  // namespace
}  // namespace thawslide::gis
