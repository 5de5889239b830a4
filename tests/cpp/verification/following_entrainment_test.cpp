// Entrainment on cells that follow the ground: blocks on a plane in closed form, and the rate on uneven ground.
#include "../support/following_plane.hpp"
#include "../support/slide_on_dem.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const Incline plane{25.0};
const double sine = std::sin(plane.angle()), cosine = std::cos(plane.angle());
constexpr double speed = 20.0, half_length = 20.0, cell = 5.0;  // [m/s], [m], [m]

const Sets bed{"bed.material=rock; bed.porosity=0.9; bed.strength=0; bed.depth_per_slip=1; bed.particles_per_axis=4"};

// Elastic block of 40 m on the plane, with vertical ends and a velocity down the plane.
Simulation<2> block_on_plane(double height, const Sets& sets) {
  const Vector<double, 2> rear = plane.place(-half_length, 0), front = plane.place(half_length, 0),
                          velocity = speed * plane.down(), up(0.0, height / cosine);
  return Simulation<2>(
      body_on_plane(plane, cell, {rear, front, front + up, rear + up},
                    Sets{"material.rock.law=elastic; material.rock.youngs_modulus=2e8; material.rock.friction_angle=",
                         "material.rock.cohesion=; material.rock.viscosity_time=0.01; mechanics.slope_shear=true",
                         fmt::format("body.block.velocity=[{},{}]", velocity[0], velocity[1])} +
                        bed + sets));
}

// State of the slide: mass and entrained mass [kg], velocity down the plane [m/s], x of the front [m].
struct State {
  double mass, entrained, velocity, front;
};

State state_of(const Simulation<2>& simulation) {
  const sim::HistoryRow row = sim::history_row(simulation);
  const double mass = value_of(row, "mass_kg");
  const Vector<double, 2> momentum(value_of(row, "momentum_x_N_s"), value_of(row, "momentum_y_N_s"));
  double front = -HUGE_VAL;
  const auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.body(p) == 0) {
      front = std::max(front, particles.position(p, 0) + simulation.model().origin[0] + 0.25 * cell);
    }
  }
  return {mass, value_of(row, "entrained_mass_kg"), momentum.dot(plane.down()) / mass, front};
}

// With the friction coefficient mu on a bed of mu_b, by the law of momentum: dv/dt = g (sin a - mu cos a), and v dm =
// (mu - mu_b) m g cos a dt.
TEST(FollowingEntrainment, RateOnAPlaneFollowsFromTheExcessShear) {
  constexpr double end = 3.0;
  const double mu = std::tan(20.0 * degree), mu_bed = std::tan(14.0 * degree);
  Simulation<2> simulation =
      block_on_plane(10.0, "bed.law=momentum; bed.depth=5; bed.friction_angle=14; basal.friction_angle=20");
  const double start = state_of(simulation).mass;
  run_until(simulation, end);
  const State now = state_of(simulation);
  const double acceleration = gravity * (sine - mu * cosine), velocity = speed + acceleration * end;
  const double taken = start * (std::pow(velocity / speed, (mu - mu_bed) * gravity * cosine / acceleration) - 1.0);
  EXPECT_NEAR(now.velocity / velocity, 1.0, 5e-3);
  EXPECT_NEAR(now.entrained / taken, 1.0, 2e-2);
}

// Without friction and strength, the block entrains the whole bed below its path. The depth d is along the vertical: m
// = m0 + rho_b d (x - x0), and (m v)^2 = (m0 v0)^2 + 2 g sin a (m^3 - m0^3)/(3 rho_b d cos a).
TEST(FollowingEntrainment, BlockOnAPlaneEntrainsALayer) {
  constexpr double depth = 2.0;
  const double front = plane.place(half_length, 0)[0];
  Simulation<2> simulation =
      block_on_plane(20.0, {"bed.law=strength; basal.friction_angle=0",
                            fmt::format("bed.depth={{ x = [{0}, {0}], value = [0.0, {1}] }}", front, depth)});
  const double start = state_of(simulation).mass, per_metre = simulation.model().bed_density * depth;
  run_until(simulation, 4.0);
  const State now = state_of(simulation);
  const double mass = start + per_metre * (now.front - front);
  const double momentum =
      std::sqrt(std::pow(start * speed, 2) +
                2.0 * gravity * sine * (std::pow(mass, 3) - std::pow(start, 3)) / (3.0 * per_metre * cosine));
  EXPECT_NEAR((start + now.entrained) / mass, 1.0, 5e-3);
  EXPECT_NEAR(now.velocity * mass / momentum, 1.0, 5e-3);
}

// On uneven ground, the strength law entrains rho_b e v per area of the ground below the slide.
TEST(FollowingEntrainment, TheRateOnUnevenGroundIsThatOfTheLaw) {
  const Place half(120.0, 120.0);
  const auto uneven = [](double x, double y) { return -0.4 * x + 1.5 * std::sin(0.08 * x) * std::cos(0.07 * y); };
  const auto slide = release_on_dem({5.0, 0.002, 5.0, {-120.0, -120.0, -120.0}, {120.0, 120.0, 150.0}},
                                    "material.debris.youngs_modulus=5e7; material.debris.viscosity_time=0.005", 20.0);
  const Raster thickness = thickness_between(
      -half, half, 1.25, [](double x, double y) { return std::abs(x) < 40.0 && std::abs(y) < 40.0 ? 15.0 : 0.0; });
  constexpr double depth_per_slip = 0.01;
  Simulation<3> simulation(
      case_on_dem(slide, {"time.stepping=adaptive; body.slide.velocity=[6,0,-2.4]",
                          "bed.law=strength; bed.material=debris; bed.porosity=0.9; bed.strength=0; bed.depth=3",
                          fmt::format("bed.depth_per_slip={}", depth_per_slip)}),
      site_of(raster_between(-half, half, 2.5, uneven), thickness));
  const auto& particles = simulation.particles();
  constexpr double spacing = 2.5;  // of particles [m]
  // Entrained mass per time, by the speed and the area of the ground of the lowest particles.
  const auto rate = [&] {
    double sum = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles.height_above_ground(p) < spacing) {
        const double area =
            spacing * spacing * std::hypot(1.0, particles.ground_slope(p, 0), particles.ground_slope(p, 1));
        sum += simulation.model().bed_density * depth_per_slip * area * particles.velocity.get<Position>(p).norm();
      }
    }
    return sum;
  };
  double expected = 0.0;
  while (simulation.time() < 0.25) {
    const double step = simulation.next_step(5.0);
    expected += step * rate();
    simulation.step(step);
  }
  EXPECT_NEAR(value_of(sim::history_row(simulation), "entrained_mass_kg") / expected, 1.0, 2e-2);
}

}  // namespace
}  // namespace thawslide::verification
