// Slides on DEMs that are rotated and shifted relative to the grid, mirror-symmetric, or uniform across between smooth
// walls, where they move as in 2D.
#include "../support/slide_on_dem.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double cell = 2.5;
constexpr double seconds = 14.0;  // until a slide is at rest

const Sets debris{fmt::format("time.end={}; time.step=0.003; grid.cell={}; basal.friction_angle=18", seconds, cell),
                  "grid.min=[-50,-50,-120]; grid.max=[150,50,60]; mechanics.transfer=apic"};

// Mass-weighted position along a direction behind which 99.5 % of the mass of particles is located [m, absolute].
double front_along(const Simulation<3>& simulation, const Place& direction) {
  const auto& particles = simulation.particles();
  std::vector<MassOnPath> on_path;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Position position = particles.position.get<Position>(p) + simulation.model().origin;
    on_path.push_back({direction.dot(position.head<2>()), particles.mass(p)});
  }
  return front_of(on_path);
}

// A slope of 31 degrees with a bend from x = 30 m to a plain, level from 70 m on.
double slope(double x) {
  const double bent = std::clamp(x - 30.0, 0.0, 40.0);
  return -0.6 * (std::min(x, 70.0) - bent * bent / 80.0);
}

// A valley down the slope, with bumps without any symmetry.
double rough_valley(double x, double y) {
  return slope(x) + 0.012 * y * y + 1.2 * std::sin(0.19 * x + 0.11 * y) * std::cos(0.17 * y - 0.05 * x) +
         0.5 * std::sin(0.27 * x - 0.31 * y + 1.0);
}

double heap(double x, double y) { return std::hypot(x, y - 3.0) < 14.0 ? 6.0 : 0.0; }

// Positions in a valley rotated by quarter turns.
struct Turn {
  int quarters;
  [[nodiscard]] Place operator()(Place position) const {
    for (int k = 0; k < quarters; ++k) {
      position = Place(-position[1], position[0]);
    }
    return position;
  }
};

// Runs until the end, when the slide must be at rest; returns the position of its front along a direction [m].
double front_at_rest(Simulation<3>& simulation, const Place& direction) {
  run_until(simulation, 0.9 * seconds);
  const double before = front_along(simulation, direction);
  run_until(simulation, seconds);
  const double front = front_along(simulation, direction);
  EXPECT_NEAR(front, before, 0.05 * cell) << "the slide has come to rest";
  return front;
}

// Final state of the slide in the valley rotated by quarter turns, with a shifted grid [m]: the front along the valley.
double front_in_valley(int quarters, double shift) {
  const Turn turn{quarters}, back{(4 - quarters) % 4};
  const auto turned = [&](double (*value)(double, double)) -> Height {
    return [=](double x, double y) {
      const Place position = back(Place(x, y));
      return value(position[0], position[1]);
    };
  };
  const auto between = [&](const auto& make, Place a, Place b, double distance, const Height& value) {
    a = turn(a);
    b = turn(b);
    return make(Place(a.cwiseMin(b)), Place(a.cwiseMax(b)), distance, value);
  };
  const Raster ground = between(raster_between, Place(-60.0, -60.0), Place(160.0, 60.0), 4.0, turned(rough_valley));
  const Raster thickness = between(thickness_between, Place(-20.0, -20.0), Place(20.0, 20.0), 0.25, turned(heap));
  const Place a = turn(Place(-50.0, -50.0)), b = turn(Place(150.0, 50.0));
  const Place least = a.cwiseMin(b).array() + shift, greatest = a.cwiseMax(b).array() + shift;
  Simulation<3> simulation(
      case_on_dem(base_text("release"),
                  debris + fmt::format("grid.min=[{},{},{}]; grid.max=[{},{},{}]", least[0], least[1], -120.0 + shift,
                                       greatest[0], greatest[1], 60.0 + shift)),
      site_of(ground, thickness));
  return front_at_rest(simulation, turn(Place(1.0, 0.0)));
}

TEST(TurnedTerrain, SlideEndsAtTheSamePlace) {
  Record record(
      "A slide turned and shifted against the grid",
      "Debris slides from rest to rest down a rough valley of a DEM and onto a plain. The run is repeated with valley, "
      "release and domain rotated by 90 degrees, and with the grid shifted by half a cell of 2.5 m along each axis.",
      "the same front", "symmetry");
  const double front = front_in_valley(0, 0.0);
  EXPECT_GT(front, 60.0) << "the slide has gone far";
  record.expect_near("front in the turned valley, less that in the first [m]", front_in_valley(1, 0.0) - front, 0.0,
                     cell);
  record.expect_near("front on the shifted grid, less that on the first [m]", front_in_valley(0, 0.5 * cell) - front,
                     0.0, cell);
}

// A valley and a release that are mirror-symmetric about y = 0.
Simulation<3> mirrored(const Sets& sets) {
  const Raster ground = raster_between(Place(-60.0, -60.0), Place(160.0, 60.0), 4.0, [](double x, double y) {
    return slope(x) + 0.3 * std::abs(y) + 1.2 * std::sin(0.23 * x) * std::cos(0.4 * y);
  });
  const Raster thickness = thickness_between(Place(-15.0, -15.0), Place(15.0, 15.0), 0.25, [](double x, double y) {
    return std::max(0.0, 8.0 - 0.02 * (x * x + y * y));
  });
  return Simulation<3>(case_on_dem(base_text("release"), debris + sets), site_of(ground, thickness));
}

std::vector<Position> positions_by_id(const Simulation<3>& simulation) {
  std::vector<Position> positions(simulation.particles().size());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    positions[static_cast<std::size_t>(simulation.particles().id(p))] =
        simulation.particles().position.get<Position>(p) + simulation.model().origin;
  }
  return positions;
}

double distance_of_images(const Position& a, const Position& b) {
  return (b - a.cwiseProduct(Position(1.0, -1.0, 1.0))).norm();
}

// Pairs of particles, by id, that are initially mirror images.
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
Pairs mirror_pairs(const Simulation<3>& simulation) {
  Pairs pairs;
  const std::vector<Position> positions = positions_by_id(simulation);
  for (std::size_t p = 0; p < positions.size(); ++p) {
    for (std::size_t q = 0; q < positions.size(); ++q) {
      if (positions[p][1] > 0.0 && distance_of_images(positions[p], positions[q]) < 1e-6) {
        pairs.emplace_back(p, q);
      }
    }
  }
  return pairs;
}

// Maximum distance of a particle from the mirror image of its counterpart [m].
double largest_asymmetry(const Simulation<3>& simulation, const Pairs& pairs) {
  const std::vector<Position> positions = positions_by_id(simulation);
  double largest = 0.0;
  for (const auto& [left, right] : pairs) {
    largest = std::max(largest, distance_of_images(positions[left], positions[right]));
  }
  return largest;
}

TEST(MirroredTerrain, SlideStaysSymmetric) {
  Record record("A symmetric slide", "A heap runs down a valley and comes to rest; both are their own mirror image.",
                "the slide stays its own mirror image", "symmetry");
  auto elastic = mirrored("material.debris.law=elastic; material.debris.gaps_close_first=false");
  const auto pairs = mirror_pairs(elastic);
  EXPECT_EQ(2 * pairs.size(), elastic.particles().size());
  const double start = CentreOfMass(elastic).position[0];
  run_until(elastic, 1.0);
  const double displacement = CentreOfMass(elastic).position[0] - start;
  EXPECT_GT(displacement, 0.5);
  record.expect_near("elastic, 1 s: largest asymmetry over the displacement",
                     largest_asymmetry(elastic, pairs) / displacement, 0.0, 1e-9);
  auto yielding = mirrored({});
  EXPECT_GT(front_at_rest(yielding, Place(1.0, 0.0)), 60.0) << "the slide has gone far";
  record.expect_near("yielding, at the end: front to the left, less that to the right [m]",
                     front_along(yielding, Place(0.0, 1.0)) - front_along(yielding, Place(0.0, -1.0)), 0.0, cell);
  const auto half_front = [&, positions = positions_by_id(yielding)](double side) {
    double front = -HUGE_VAL;
    for (const Position& position : positions) {
      front = side * position[1] > 0.0 ? std::max(front, position[0]) : front;
    }
    return front;
  };
  record.expect_near("yielding, at the end: front of the left half, less that of the right [m]",
                     half_front(1.0) - half_front(-1.0), 0.0, cell);
}

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
