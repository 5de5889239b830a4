// Results do not depend on the direction in which lines are given: mirrored and reversed cases.
#include "sim/direction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "../support/base_cases.hpp"
#include "../support/slide_on_dem.hpp"
#include "sim/block/block.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using config::Polyline2;

Polyline2 reversed(const Polyline2& line) { return {line.rbegin(), line.rend()}; }

// A release of 40 m by 40 m around a centre, on a ground of 401 x 401 m around the origin.
struct Slope {
  config::Case parameters;
  config::Site site;
};

Slope slope_with(const Height& height, const Place& centre) {
  Slope made;
  made.parameters.general.dimension = 3;
  made.parameters.grid.cell = 5.0;
  made.parameters.maps.path = "/somewhere/path.gpkg";
  made.parameters.bodies["slide"].shape = config::BodyShape::release;
  const Place half(200.0, 200.0), side(20.0, 20.0);
  made.site = site_of(raster_between(-half, half, 5.0, height),
                      raster_between(centre - side, centre + side, 5.0, [](double, double) { return 3.0; }));
  return made;
}

// Orients a path and its reverse. Returns whether the order of the path was kept.
bool keeps(const Slope& slope, const Polyline2& path) {
  Slope forward = slope, backward = slope;
  forward.site.path = path;
  backward.site.path = reversed(path);
  const std::string warning = orient_lines(forward.parameters, forward.site);
  const std::string other = orient_lines(backward.parameters, backward.site);
  EXPECT_EQ(forward.site.path, backward.site.path);
  EXPECT_EQ(forward.site.path == path, warning.empty());
  EXPECT_EQ(forward.site.path == path ? other : warning,
            "maps.path: path.gpkg was drawn against the direction of the slide; distances count from its last corner");
  return forward.site.path == path;
}

TEST(Direction, OfAPathDownASlopeIsDownhillAtTheRelease) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> turn(0.0, 6.283), place(-190.0, 190.0);
  int kept = 0;
  for (int k = 0; k < 200; ++k) {
    const double azimuth = turn(random), x = std::cos(azimuth), y = std::sin(azimuth);
    const Slope slope =
        slope_with([&](double east, double north) { return -0.4 * (x * east + y * north); }, {-80.0 * x, -80.0 * y});
    const Polyline2 straight{{place(random), place(random)}, {place(random), place(random)}};
    const double falls = x * (straight[1][0] - straight[0][0]) + y * (straight[1][1] - straight[0][1]);
    if (std::abs(falls) > 5.0) {
      EXPECT_EQ(keeps(slope, straight), falls > 0.0) << "azimuth " << azimuth;
      kept += falls > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(kept, 50);
}

// Down a slope of 200 m and up the opposite one beyond the initial height; and a path that begins beyond the release.
TEST(Direction, OfAPathUpTheOppositeSlopeIsThatOfTheLeavingRelease) {
  const Height valley = [](double x, double) { return x < 0.0 ? -0.5 * x : 0.9 * x; };
  const Slope slope = slope_with(valley, {-120.0, 0.0});
  EXPECT_TRUE(keeps(slope, {{-180.0, 0.0}, {180.0, 0.0}}));
  EXPECT_TRUE(keeps(slope, {{-60.0, 0.0}, {180.0, 0.0}}));
  EXPECT_TRUE(keeps(slope, {{-180.0, 100.0}, {180.0, 150.0}}));
  EXPECT_FALSE(keeps(slope_with(valley, {120.0, 0.0}), {{-180.0, 0.0}, {180.0, 0.0}}));
}

TEST(Direction, OfAFastBodyIsThatOfItsVelocityAndOnLevelGroundStartsAtTheNearEnd) {
  Slope slope = slope_with([](double x, double) { return -0.5 * x; }, {-100.0, 0.0});
  const Polyline2 path{{-180.0, 0.0}, {180.0, 0.0}};
  // The release is 45 m long, including the cells around its points: 0.5 g cos 45 m = 197 m2/s2.
  for (const double velocity : {-3.0, -13.9}) {
    slope.parameters.bodies.at("slide").velocity = {velocity, 0.0, 0.0};
    EXPECT_TRUE(keeps(slope, path)) << "it returns soon";
  }
  for (const double velocity : {-14.2, -40.0}) {
    slope.parameters.bodies.at("slide").velocity = {velocity, 0.0, 0.0};
    EXPECT_FALSE(keeps(slope, path));
  }
  const Height level = [](double, double) { return 7.0; };
  EXPECT_TRUE(keeps(slope_with(level, {-100.0, 0.0}), path));
  EXPECT_FALSE(keeps(slope_with(level, {100.0, 0.0}), path));
  Slope tilted = slope_with(level, {-100.0, 0.0});
  tilted.parameters.general.gravity_tilt = -10.0;
  EXPECT_FALSE(keeps(tilted, path));
  Slope bare = slope_with([](double x, double) { return -0.5 * x; }, {-100.0, 0.0});
  bare.parameters.bodies.clear();
  bare.site.releases.clear();
  EXPECT_TRUE(keeps(bare, path));
}

// Discharge to the right of the line is positive.
double right_of(const Polyline2& line, double x, double y) {
  return x * (line[1][1] - line[0][1]) - y * (line[1][0] - line[0][0]);
}

TEST(Direction, OfACrossSectionIsAlongThePathOrAwayFromTheRelease) {
  const Height height = [](double x, double) { return -0.5 * x; };
  for (const bool is_reversed : {false, true}) {
    Slope slope = slope_with(height, {-120.0, 0.0});
    const Polyline2 across{{50.0, -90.0}, {40.0, 90.0}};
    slope.site.probes["across"] = is_reversed ? reversed(across) : across;
    slope.site.probes["point"] = {{10.0, 10.0}};
    Slope with_path = slope;
    static_cast<void>(orient_lines(slope.parameters, slope.site));
    EXPECT_GT(right_of(slope.site.probes.at("across"), 1.0, 0.0), 0.0) << "away from the release";
    EXPECT_EQ(slope.site.probes.at("point").size(), 1U);
    // A path that turns back and crosses the line towards the release.
    with_path.site.path = {{-180.0, 0.0}, {-100.0, 0.0}, {0.0, 150.0}, {150.0, 150.0}, {150.0, 20.0}, {-10.0, 20.0}};
    static_cast<void>(orient_lines(with_path.parameters, with_path.site));
    EXPECT_LT(right_of(with_path.site.probes.at("across"), 1.0, 0.0), 0.0);
  }
}

// On a plane that falls towards +x or, mirrored, towards -x; or on flat ground with tilted gravity.
constexpr double length = 400.0;

Variant sliding(bool is_mirrored, bool by_tilt, double velocity) {
  const double sign = is_mirrored ? -1.0 : 1.0, fall = by_tilt ? 0.0 : std::tan(30.0 * 3.14159265358979323846 / 180.0);
  const double at_zero = is_mirrored ? 300.0 - fall * length : 300.0;  // elevation of the ground
  std::string vertices;
  for (const auto& [along, height] :
       std::vector<std::array<double, 2>>{{100.0, 0.0}, {140.0, 0.0}, {140.0, 30.0}, {100.0, 30.0}}) {
    vertices +=
        fmt::format("[{:.17g}, {:.17g}], ", is_mirrored ? length - along : along, 300.0 - fall * along + height);
  }
  return {"block",
          "time.end=2; time.step=0.002; time.history_interval=0.5; grid.min=[0,0]; material.rock.youngs_modulus=1e8; "
          "body.block.shape=polygon; basal.friction_angle=10; mechanisms.pressurization=true; " +
              fmt::format("case.gravity_tilt={}; grid.max=[{}, 400.0]; terrain.type={}; "
                          "terrain.elevation={:.17g}; body.block.vertices=[{}]; body.block.velocity=[{}, 0.0]",
                          by_tilt ? 30.0 * sign : 0.0, length,
                          by_tilt ? "flat" : fmt::format("plane; terrain.slope={}", 30.0 * sign), at_zero, vertices,
                          sign * velocity)};
}

struct Rows {
  HistoryRow first, last;
};

Rows rows_of(const Variant& variant) {
  const config::Case parameters = paper_case(variant);
  Simulation<2> simulation(parameters);
  Rows rows{history_row(simulation), {}};
  run_until(simulation, parameters.time.end);
  rows.last = history_row(simulation);
  return rows;
}

void expect_mirrored(const HistoryRow& row, const HistoryRow& mirrored) {
  ASSERT_EQ(row.size(), mirrored.size());
  for (const char* name :
       {"mean_velocity_m_s", "velocity_m_s", "displacement_m", "mean_displacement_m", "runout_m", "travel_distance_m",
        "drop_height_m", "sliding_strength_Pa", "driving_traction_Pa", "friction_work_J", "friction_work_J_m2"}) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (row[k].first == name) {
        EXPECT_NEAR(mirrored[k].second, row[k].second, 1e-6 * (1e-3 + std::abs(row[k].second))) << name;
      }
    }
  }
  EXPECT_NEAR(value_of(mirrored, "front_position_m"), length - value_of(row, "front_position_m"), 1e-6);
}

TEST(Direction, MirroredSlideHasTheSameRunout) {
  for (const bool by_tilt : {false, true}) {
    for (const double velocity : {0.0, 4.0}) {
      SCOPED_TRACE(fmt::format("tilt {}, velocity {}", by_tilt, velocity));
      const Rows right = rows_of(sliding(false, by_tilt, velocity)), left = rows_of(sliding(true, by_tilt, velocity));
      EXPECT_GT(value_of(right.last, "runout_m"), value_of(right.first, "runout_m") + 4.0);
      expect_mirrored(right.first, left.first);
      expect_mirrored(right.last, left.last);
    }
  }
}

TEST(Direction, MirroredBlockHasTheSameRunout) {
  for (const bool by_tilt : {false, true}) {
    for (const double velocity : {0.0, 4.0}) {
      SCOPED_TRACE(fmt::format("tilt {}, velocity {}", by_tilt, velocity));
      const auto right = run_block(paper_case(sliding(false, by_tilt, velocity)));
      const auto left = run_block(paper_case(sliding(true, by_tilt, velocity)));
      ASSERT_EQ(right.size(), left.size());
      EXPECT_GT(value_of(right.front(), "driving_traction_Pa"), 0.0);
      EXPECT_GT(value_of(right.back(), "displacement_m"), 4.0);
      expect_mirrored(right.front(), left.front());
      expect_mirrored(right.back(), left.back());
    }
  }
}

// With a velocity of 1 m/s uphill it returns after 0.6 s; with v^2 = 484 m2/s2 it moves by more than half of its 40 m.
TEST(Direction, IsKeptForASlideWithASmallUphillVelocity) {
  for (const bool is_mirrored : {false, true}) {
    for (const bool by_tilt : {false, true}) {
      SCOPED_TRACE(fmt::format("mirrored {}, tilt {}", is_mirrored, by_tilt));
      Simulation<2> simulation(paper_case(sliding(is_mirrored, by_tilt, -1.0)));
      const double downhill = is_mirrored ? -1.0 : 1.0;
      double runout = value_of(history_row(simulation), "runout_m");
      EXPECT_GT(runout, 35.0);
      for (int k = 0; k < 8; ++k) {
        run_until(simulation, 0.25 * (k + 1));
        EXPECT_EQ(front_along_x(simulation).direction, downhill);
        const double now = value_of(history_row(simulation), "runout_m");
        EXPECT_NEAR(now, runout, 3.0) << simulation.time();
        runout = now;
      }
      EXPECT_GT(runout, 43.0);
      const Simulation<2> fast(paper_case(sliding(is_mirrored, by_tilt, -22.0)));
      EXPECT_EQ(front_along_x(fast).direction, -downhill);
    }
  }
}

}  // namespace
}  // namespace thawslide::sim
