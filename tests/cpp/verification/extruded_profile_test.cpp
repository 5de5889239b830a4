// A profile as a DEM that is uniform across, between smooth walls: a slide moves on it as in 2D.
#include "../support/slide_on_dem.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

// A level shelf followed by a slope of 35 degrees and a plain. Points every 2.5 m.
double elevation(double x) {
  const auto bend = [](double from, double to, double x) {  // integral of a slope that rises from 0 to 1
    const double length = to - from, t = std::clamp((x - from) / length, 0.0, 1.0);
    return 0.5 * t * t * length + std::max(0.0, x - to);
  };
  return -0.7 * (bend(20.0, 100.0, x) - bend(120.0, 200.0, x));
}

constexpr double first_point = -30.0, last_point = 300.0, spacing = 2.5;

// The body is on the shelf, where both cases fill the same lattice. It starts with an initial velocity.
Sets sets_of(int dimension) {
  const bool flat = dimension == 2;
  const auto corner = [&](double x, double y, double z) { return point_text(dimension, x, y, z); };
  return {fmt::format("case.dimension={}; time.end=7; time.step=0.0015; grid.cell=1.25", dimension),
          fmt::format("grid.min={}; grid.max={}", corner(-25.0, 0.0, -90.0), corner(295.0, 2.5, 40.0)),
          fmt::format("body.column.min={}; body.column.max={}", corner(-20.0, 0.0, 0.0), corner(20.0, 2.5, 7.5)),
          fmt::format("body.column.velocity={}", corner(14.0, 0.0, 0.0)),
          "material.sand.friction_angle=30",
          "basal.friction_angle=12; grid.boundary.x_min=open",
          flat ? "" : "grid.boundary.y_min=roller; grid.boundary.y_max=roller",
          fmt::format("terrain.type={}; terrain.file={}", flat ? "profile" : "dem",
                      (folder_of_this_test() / (flat ? "profile.csv" : "dem.tif")).string())};
}

Simulation<2> in_profile() {
  std::vector<std::vector<double>> points;
  for (double x = first_point; x <= last_point; x += spacing) {
    points.push_back({x, elevation(x)});
  }
  write_profile(points);
  return Simulation<2>(published_case("sand", sets_of(2)));
}

Simulation<3> in_space() {
  config::Site site;
  site.ground = std::make_shared<const Raster>(raster_between(Place(first_point, -10.0), Place(last_point, 15.0),
                                                              spacing, [](double x, double) { return elevation(x); }));
  return Simulation<3>(case_on_dem(base_text("sand"), sets_of(3)), site);
}

TEST(ExtrudedProfile, MotionIsThatInTwoDimensions) {
  Record record(
      "A profile extruded to a DEM",
      "Debris, 40 m long and 7.5 m thick, is pushed over the edge of a shelf, down a slope of 35 degrees and onto a "
      "plain. It moves along a profile in 2D, and in 3D on a DEM of it, 2.5 m wide between smooth walls.",
      "mean velocity of the 2D run", "symmetry");
  auto profile = in_profile();
  auto space = in_space();
  Curve curve{"time [s]", "mean velocity [m/s]", {}, {}, {}};
  double largest = 0.0;
  for (double time = 0.5; time < 7.1; time += 0.5) {
    run_until(profile, time);
    run_until(space, time);
    add_point(curve, time, history_value(space, "mean_velocity_m_s"), history_value(profile, "mean_velocity_m_s"));
    largest = std::max(largest, std::abs(curve.computed.back() / curve.exact.back() - 1.0));
  }
  record.expect_near("largest difference of the mean velocities, over that in 2D", largest, 0.0, 0.02);
  record.draw(curve);
}

}  // namespace
}  // namespace thawslide::verification
