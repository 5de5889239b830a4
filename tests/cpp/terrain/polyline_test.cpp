// Heights of a polyline, and its means over columns of nodes.
#include "terrain/polyline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thawslide::terrain {
namespace {

const Polyline bent({0.0, 7.3, 11.1, 30.0}, {20.0, 14.6, 9.0, 8.5});

TEST(Polyline, IsExtrapolatedWithTheGradientOfItsEnds) {
  EXPECT_DOUBLE_EQ(bent.height(-7.3), 25.4);
  EXPECT_NEAR(bent.height(48.9), 8.0, 1e-12);
}

TEST(Polyline, MeansOfColumnsAreWeightedByTheHatFunction) {
  constexpr double cell = 5.0;
  constexpr int parts = 100000;
  for (const double at : {-2.0, 7.0, 10.5, 29.0}) {
    double height = 0.0, length = 0.0;
    for (int k = 0; k < parts; ++k) {
      const double from_column = cell * (2.0 * (k + 0.5) / parts - 1.0);
      const double hat = 2.0 * (1.0 - std::abs(from_column) / cell) / parts;
      height += hat * bent.height(at + from_column);
      length += hat * std::hypot(1.0, bent.gradient(at + from_column));
    }
    const Polyline::HatMeans means = bent.hat_means(at, cell);
    EXPECT_NEAR(means.height, height, 1e-5);
    EXPECT_NEAR(means.length, length, 1e-5);
  }
}

}  // namespace
}  // namespace thawslide::terrain
