// Effect of the DEM filter on the wedge effect of valleys.
#include <cmath>
#include <functional>

#include "gis/roughness.hpp"
#include "gis/smoothing.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

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

TEST(FilteredValley, NarrowValleysLoseThreePercentOfTheirWedge) {
  // Computed values, confirmed by runs with a standard deviation of one cell: docs/theory/contact.md.
  EXPECT_NEAR(wedge_lost(120.0, 8.0), 0.058, 0.001);
  EXPECT_NEAR(wedge_lost(90.0, 8.0), 0.123, 0.001);
  EXPECT_NEAR(wedge_lost(60.0, 8.0), 0.201, 0.001);
  EXPECT_NEAR(wedge_lost(120.0, 4.0), 0.09, 0.005);
  EXPECT_NEAR(wedge_lost(90.0, 4.0), 0.20, 0.005);
  EXPECT_NEAR(wedge_lost(60.0, 4.0), 0.32, 0.005);
  EXPECT_NEAR(wedge_lost(90.0, narrow_valley(1.0)), 0.03, 0.0005);
  // Entries of the table in that page with other ratios of width to standard deviation.
  EXPECT_NEAR(wedge_lost(90.0, 16.0), 0.069, 0.001);
  EXPECT_NEAR(wedge_lost(90.0, 32.0), 0.037, 0.001);
  EXPECT_NEAR(wedge_lost(60.0, 2.0), 0.457, 0.001);
  EXPECT_NEAR(wedge_lost(120.0, 16.0 / 1.5), 0.046, 0.001);
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
