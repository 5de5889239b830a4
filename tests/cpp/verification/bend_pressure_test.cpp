// Pressure of a slide on curved ground: the additional pressure is the centripetal force.
#include <functional>

#include "physics/contact.hpp"
#include "sim/block/block.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double density = 0.625 * 2750.0 + 0.375 * 917.0;  // frozen, porosity 0.375
constexpr double radius = 300.0, thickness = 10.0;

// A circular arc with its lowest point at x = 0, continued by a slope of 40 degrees on the left and level ground on the
// right.
struct Ground {
  static constexpr double steepest = 40.0 * degree;

  [[nodiscard]] static double angle(double x) { return std::asin(std::clamp(-x / radius, 0.0, std::sin(steepest))); }
  [[nodiscard]] static double height(double x) {
    const double start = -radius * std::sin(steepest);
    return radius * (1.0 - std::cos(angle(x))) + (x < start ? (start - x) * std::tan(steepest) : 0.0);
  }
};

// Points every metre, and a body between two positions with ends normal to the ground.
config::Case case_of_profile(const std::function<double(double)>& ground, double from, double to,
                             const std::function<double(double)>& surface, const Sets& sets = {}) {
  std::vector<std::vector<double>> points;
  for (double x = -500.0; x < 500.5; x += 1.0) {
    points.push_back({x, ground(x), x > from && x < to ? surface(x) : ground(x)});
  }
  write_profile(points);
  const Sets bend{"time.end=60; time.history_interval=0.05; grid.min=[-450,-20]; grid.max=[450,430]",
                  "material.rock.law=mohr_coulomb; material.rock.friction_angle=35; material.rock.cohesion=1e3",
                  "material.rock.youngs_modulus=1e8; mechanisms.pressurization=false; heat.enabled=false",
                  "pressure.enabled=false"};
  return published_case("profile", bend + sets);
}

// A body of uniform thickness across the slope above the bend.
config::Case slide_into_bend(const Sets& sets = {}) {
  const auto surface = [](double x) { return Ground::height(x) + thickness / std::cos(Ground::steepest); };
  return case_of_profile(Ground::height, -400.0, -330.0, surface, sets);
}

double mean_cosine(double angle, double half) { return std::cos(angle) * std::sin(half) / half; }

TEST(BendPressure, BlockHasTheCentrifugalLoadOfAnArc) {
  Record record("Pressure in a bend, rigid block",
                "A slab 10 m thick slides down a slope of 40 degrees and through an arc of 300 m radius. The points of "
                "the profile are 1 m apart. The slab is a rigid block with block.bends.",
                "N = rho h (g cos + v^2/R)", "balance of momentum across the path");
  const auto rows = sim::run_block(slide_into_bend("block.bends=true"));
  const double length = 70.0 / std::cos(Ground::steepest), half = 0.5 * length / radius;
  const double middle_before_arc = (365.0 - radius * std::sin(Ground::steepest)) / std::cos(Ground::steepest);
  double largest = 0.0, largest_fraction = 0.0;
  Curve curve{"angle [degrees]", "normal pressure [kPa]", {}, {}, {}};
  for (const auto& row : rows) {
    const double angle = Ground::steepest - (value_of(row, "displacement_m") - middle_before_arc) / radius;
    if (angle + half > Ground::steepest - 0.03 || angle - half < 0.03) {
      continue;  // not completely within the arc, including the extent of a slice's curvature
    }
    const double speed = value_of(row, "velocity_m_s");
    const double weight = gravity * mean_cosine(angle, half), turning = speed * speed / radius;
    const double expected = density * thickness * (weight + turning);
    largest = std::max(largest, std::abs(value_of(row, "normal_pressure_Pa") / expected - 1.0));
    largest_fraction = std::max(largest_fraction, turning / weight);
    add_point(curve, angle / degree, value_of(row, "normal_pressure_Pa") / 1e3, expected / 1e3);
  }
  EXPECT_GT(curve.x.size(), 20U);
  EXPECT_GT(largest_fraction, 0.3) << "the bend is felt";
  record.expect_near("largest relative difference", largest, 0.0, 0.05);
  record.draw(curve);
}

TEST(BendPressure, BlockHasItOnlyWithTheKey) {
  const auto pressures = [](const Sets& sets) {
    return each_of(sim::run_block(slide_into_bend(sets)), [](const sim::HistoryRow& row) {
      return value_of(row, "normal_pressure_Pa") / (density * thickness * gravity);
    });
  };
  for (const double pressure : pressures({})) {
    EXPECT_GT(pressure, 0.7);
    EXPECT_LT(pressure, 1.02);
  }
  const std::vector<double> with_bends = pressures("block.bends=true");
  EXPECT_GT(*std::max_element(with_bends.begin(), with_bends.end()), 1.3);
}

// Over a crest, detached material exerts no pressure, and the pressure is never negative.
TEST(BendPressure, IsNeverNegative) {
  EXPECT_EQ(physics::load_in_bend(2.0, 9.0, 30.0, -1.0 / 100.0), 0.0);
  EXPECT_DOUBLE_EQ(physics::load_in_bend(2.0, 9.0, 30.0, -1.0 / 200.0), 9.0);
  EXPECT_DOUBLE_EQ(physics::load_in_bend(2.0, 9.0, 30.0, 1.0 / 200.0), 27.0);
  const auto crest = [](double x) { return 100.0 - x * x / 400.0; };
  const auto rows = sim::run_block(case_of_profile(
      crest, -120.0, -60.0, [&](double x) { return crest(x) + thickness; },
      "block.bends=true; body.slide.velocity=[60,20]; grid.min=[-450,-300]; time.end=2"));
  const std::vector<double> pressures =
      each_of(rows, [](const sim::HistoryRow& row) { return value_of(row, "normal_pressure_Pa"); });
  EXPECT_EQ(*std::min_element(pressures.begin(), pressures.end()), 0.0);
}

// Sum of the particles' weight normal to the ground and their centripetal force, with the ground of the arc below each.
double load_of_particles(const Simulation<2>& simulation) {
  const auto& particles = simulation.particles();
  double load = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vector<double, 2> from_centre(particles.position(p, 0) + simulation.model().origin[0],
                                        particles.position(p, 1) + simulation.model().origin[1] - radius);
    const double angle = std::clamp(std::atan2(-from_centre[0], -from_centre[1]), 0.0, Ground::steepest);
    const bool in_arc = angle > 0.0 && angle < Ground::steepest;
    const double speed = Vector<double, 2>(particles.velocity(p, 0), particles.velocity(p, 1)).norm();
    const double turning = in_arc ? speed * speed / from_centre.norm() : 0.0;
    load += particles.mass(p) * (gravity * std::cos(angle) + turning);
  }
  return load;
}

// N A of all nodes in the last step [N].
double load_of_nodes(const Simulation<2>& simulation) {
  const auto& base = simulation.nodes().base;
  double load = 0.0;
  for (std::size_t b = 0; b < simulation.grid().blocks().size(); ++b) {
    for (std::size_t k = 0; base.contains(b) && k < static_cast<std::size_t>(mpm::Tile<2>::nodes); ++k) {
      load += base(b, k)[mpm::BaseLoad::load] / simulation.last_step();
    }
  }
  return load;
}

TEST(BendPressure, SlideHasTheCentrifugalLoadOfAnArc) {
  if (!Simulation<2>(slide_into_bend()).device_name().empty()) {
    GTEST_SKIP() << "it looks at nodes, which a device keeps";
  }
  Record record("Pressure in a bend, deforming slide",
                "The same slab consists of broken rock (35 degrees, 1 kPa), in cells of 2.5 m. The force of the slide "
                "across the ground is summed over nodes and averaged over half a second.",
                "sum over particles of m (g cos + v^2/r)", "balance of momentum across the path");
  Simulation<2> simulation(slide_into_bend());
  double largest = 0.0, most = 0.0;
  Curve curve{"time [s]", "force across the ground over weight", {}, {}, {}};
  const double mass = simulation.sum_over_body().mass;
  double expected = 0.0, found = 0.0;
  int steps = 0;
  while (simulation.time() < 15.0) {
    simulation.step(simulation.next_step(60.0));
    expected += load_of_particles(simulation);
    found += load_of_nodes(simulation);
    if (++steps < 500) {
      continue;
    }
    add_point(curve, simulation.time(), found / steps / (mass * gravity), expected / steps / (mass * gravity));
    largest = std::max(largest, std::abs(found / expected - 1.0));
    most = std::max(most, curve.exact.back());
    expected = found = 0.0;
    steps = 0;
  }
  EXPECT_GT(most, 1.2) << "the bend is felt";
  record.expect_near("largest relative difference", largest, 0.0, 0.05);
  record.draw(curve);
}

}  // namespace
}  // namespace thawslide::verification
