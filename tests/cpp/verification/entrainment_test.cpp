// A block that entrains the bed below it: momentum and energy in closed form, for both laws, in 2D and 3D. On cells
// that follow the ground, blocks on a plane, and the rate on uneven ground.
#include "../support/following_plane.hpp"
#include "../support/slide_on_dem.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double speed = 20.0, front = 40.0, width = 20.0;  // [m/s], [m]: x of the block's front, its width in 3D

// A frozen elastic block 40 m long on level ground, with a horizontal initial velocity and a basal friction angle
// [degrees].
template <int Dim>
config::Case thrown(double height, double end, double friction_angle, const Sets& bed = {}) {
  const auto at = [](double x, double y, double z) { return point_text(Dim, x, y, z); };
  const Sets block{fmt::format("case.dimension={0}; time.end={1}; time.step={1}; time.stepping=adaptive", Dim, end),
                   fmt::format("grid.min={}; grid.max={}", at(-20.0, -20.0, -10.0), at(260.0, 40.0, 40.0)),
                   fmt::format("body.block.min={}; body.block.max={}", at(0.0, 0.0, 0.0), at(front, width, height)),
                   fmt::format("body.block.velocity={}; basal.friction_angle={}", at(speed, 0.0, 0.0), friction_angle),
                   "material.rock.youngs_modulus=2e8; body.block.temperature=-10; body.block.porosity=0.375"};
  return published_case("block", block + bed);
}

// Erodible bed of the block's rock.
const Sets bed{"bed.depth_per_slip=1; bed.material=rock; bed.porosity=0.9"};

// State of the run. down: direction of the velocity.
struct State {
  double mass, velocity, kinetic, front, taken, residual;  // [kg], [m/s], [J], [m], [kg], fraction of the momentum
};

template <int Dim>
State state_of(const Simulation<Dim>& simulation, const Vector<double, 2>& down = {1.0, 0.0}) {
  const sim::HistoryRow row = sim::history_row(simulation);
  const auto value = [&](const std::string& name) { return value_of(row, name); };
  const auto& particles = simulation.particles();
  const double foremost = greatest_of(simulation, [&](std::size_t p) {
    return particles.body(p) == 0 ? particles.position(p, 0) + simulation.model().origin[0] + 1.25 : -HUGE_VAL;
  });
  const Vector<double, 2> momentum(value("momentum_x_N_s"), value("momentum_y_N_s"));
  return {value("mass_kg"),           momentum.dot(down) / value("mass_kg"),
          value("kinetic_J"),         foremost,
          value("entrained_mass_kg"), std::abs(value("momentum_residual_x_N_s")) / (value("mass_kg") * speed)};
}

// Entrainment without friction: m = m0 + rho_b d w (x - x0), m v = m0 v0, kinetic energy (m0 v0)^2/(2 m).
template <int Dim>
void sweep_up(const std::string& where) {
  constexpr double depth = 2.0;
  Record record("Entrainment: a block that sweeps up a layer, " + where,
                "A block slides without friction over level ground. From its front on, a bed 2 m deep without strength "
                "lies on the ground.",
                "m = m_0 + rho_b d w (x - x_0), m v = m_0 v_0, kinetic energy (m_0 v_0)^2/(2 m)",
                "inelastic collision with material at rest: momentum is kept");
  Simulation<Dim> simulation(thrown<Dim>(
      20.0, 8.0, 0.0, bed + "bed.law=strength; bed.strength=0; bed.depth={ x = [40.0, 40.0], value = [0.0, 2.0] }"));
  const double start = state_of(simulation).mass;
  const double per_metre = simulation.model().bed_density * depth * (Dim == 3 ? width : 1.0);
  Curve curve{"front x - x_0 [m]", "velocity [m/s]", {}, {}, {}};
  State now{};
  double most_residual = 0.0;
  for (int k = 1; k <= 8; ++k) {
    run_until(simulation, k);
    now = state_of(simulation);
    add_point(curve, now.front - front, now.velocity, start * speed / (start + per_metre * (now.front - front)));
    most_residual = std::max(most_residual, now.residual);
  }
  const double mass = start + per_metre * (now.front - front);
  record.explain("The entrained mass differs by the bed that remains in the foremost cells, a cell of 140 m");
  record.expect_near("mass over m(x)", (start + now.taken) / mass, 1.0, 1e-2);
  record.expect_near("velocity over m_0 v_0/m(x)", now.velocity / curve.exact.back(), 1.0, 1e-2);
  record.expect_near("kinetic energy over (m_0 v_0)^2/(2 m)",
                     now.kinetic / (0.5 * start * start * speed * speed / mass), 1.0, 1e-2);
  record.expect_near("momentum left over, as a share", most_residual, 0.0, 1e-13);
  record.draw(curve);
}

TEST(Entrainment, BlockEntrainsALayerInThePlane) { sweep_up<2>("2D"); }
TEST(Entrainment, BlockEntrainsALayerInSpace) { sweep_up<3>("3D"); }

// With Coulomb friction mu on a bed of mu_b, by the law of momentum: the drag on the slide is mu m g for any
// entrainment, and therefore v = v0 - mu g t, and dm v = (mu - mu_b) m g dt.
template <int Dim>
void entrain_by_friction(const std::string& where) {
  constexpr double angle = 17.0, bed_angle = 14.0;  // degrees
  const double mu = std::tan(angle * degree), mu_bed = std::tan(bed_angle * degree);
  Record record("Entrainment: a block whose friction exceeds that of the bed, " + where,
                "A block slides with friction over a bed of less friction, which is deep enough everywhere.",
                "v = v_0 - mu g t, m = m_0 (v/v_0)^-(1 - mu_b/mu)",
                "integral of v dm/dt = (mu - mu_b) m g, the law of momentum under the block's weight");
  const Sets weak{"bed.law=momentum; bed.strength=0; bed.particles_per_axis=4; bed.depth=5",
                  fmt::format("bed.friction_angle={}", bed_angle)};
  Simulation<Dim> simulation(thrown<Dim>(10.0, 3.0, angle, bed + weak));
  const double start = state_of(simulation).mass;
  run_until(simulation, 3.0);
  const State now = state_of(simulation);
  const double velocity = speed - mu * gravity * 3.0;
  const double taken = start * (std::pow(velocity / speed, -(1.0 - mu_bed / mu)) - 1.0);
  record.expect_near("velocity over the exact one", now.velocity / velocity, 1.0, 1e-2);
  record.expect_near("entrained mass over the exact one", now.taken / taken, 1.0, 3e-2);
  record.expect_near("momentum left over, as a share", now.residual, 0.0, 1e-13);
}

TEST(Entrainment, RateFollowsFromTheExcessShearInThePlane) { entrain_by_friction<2>("2D"); }
TEST(Entrainment, RateFollowsFromTheExcessShearInSpace) { entrain_by_friction<3>("3D"); }

// A bed stronger than the friction remains in place and has no effect on the slide.
TEST(Entrainment, BedThatResistsTheShearRemains) {
  for (const std::string law : {"strength", "momentum"}) {
    const auto on_bed = [&](double strength) {
      return thrown<2>(10.0, 1.0, 17.0, bed + fmt::format("bed.law={}; bed.strength={}; bed.depth=2", law, strength));
    };
    Simulation<2> strong(on_bed(1e7)), weak(on_bed(1e3)), same(on_bed(1e7)), without(thrown<2>(10.0, 1.0, 17.0));
    run_until(strong, 1.0);
    run_until(weak, 1.0);
    EXPECT_EQ(state_of(strong).taken, 0.0) << law;
    EXPECT_GT(state_of(weak).taken, 1e3) << law;
    for (int k = 0; k < 20; ++k) {
      without.step(1e-3);
      same.step(1e-3);
    }
    EXPECT_EQ(value_of(sim::history_row(same), "momentum_x_N_s"), value_of(sim::history_row(without), "momentum_x_N_s"))
        << law;
  }
}

const Incline plane{25.0};
const double sine = std::sin(plane.angle()), cosine = std::cos(plane.angle());
constexpr double half_length = 20.0, cell = 5.0;  // [m]

// Elastic block of 40 m on the plane, with vertical ends and a velocity down the plane.
Simulation<2> block_on_plane(double height, const Sets& sets) {
  const Vector<double, 2> rear = plane.place(-half_length, 0), front = plane.place(half_length, 0),
                          velocity = speed * plane.down(), up(0.0, height / cosine);
  return Simulation<2>(
      body_on_plane(plane, cell, {rear, front, front + up, rear + up},
                    Sets{"material.rock.law=elastic; material.rock.youngs_modulus=2e8; material.rock.friction_angle=",
                         "material.rock.cohesion=; material.rock.viscosity_time=0.01; mechanics.slope_shear=true",
                         fmt::format("body.block.velocity=[{},{}]", velocity[0], velocity[1])} +
                        bed + "bed.strength=0; bed.particles_per_axis=4" + sets));
}

// With the friction coefficient mu on a bed of mu_b, by the law of momentum: dv/dt = g (sin a - mu cos a), and v dm =
// (mu - mu_b) m g cos a dt.
TEST(FollowingEntrainment, RateOnAPlaneFollowsFromTheExcessShear) {
  constexpr double end = 3.0;
  const double mu = std::tan(20.0 * degree), mu_bed = std::tan(14.0 * degree);
  Simulation<2> simulation =
      block_on_plane(10.0, "bed.law=momentum; bed.depth=5; bed.friction_angle=14; basal.friction_angle=20");
  const double start = state_of(simulation, plane.down()).mass;
  run_until(simulation, end);
  const State now = state_of(simulation, plane.down());
  const double acceleration = gravity * (sine - mu * cosine), velocity = speed + acceleration * end;
  const double taken = start * (std::pow(velocity / speed, (mu - mu_bed) * gravity * cosine / acceleration) - 1.0);
  EXPECT_NEAR(now.velocity / velocity, 1.0, 5e-3);
  EXPECT_NEAR(now.taken / taken, 1.0, 2e-2);
}

// Without friction and strength, the block entrains the whole bed below its path. The depth d is along the vertical: m
// = m0 + rho_b d (x - x0), and (m v)^2 = (m0 v0)^2 + 2 g sin a (m^3 - m0^3)/(3 rho_b d cos a).
TEST(FollowingEntrainment, BlockOnAPlaneEntrainsALayer) {
  constexpr double depth = 2.0;
  const double front = plane.place(half_length, 0)[0];
  Simulation<2> simulation =
      block_on_plane(20.0, {"bed.law=strength; basal.friction_angle=0",
                            fmt::format("bed.depth={{ x = [{0}, {0}], value = [0.0, {1}] }}", front, depth)});
  const double start = state_of(simulation, plane.down()).mass, per_metre = simulation.model().bed_density * depth;
  run_until(simulation, 4.0);
  const State now = state_of(simulation, plane.down());
  const double mass = start + per_metre * (now.front - front);
  const double momentum =
      std::sqrt(std::pow(start * speed, 2) +
                2.0 * gravity * sine * (std::pow(mass, 3) - std::pow(start, 3)) / (3.0 * per_metre * cosine));
  EXPECT_NEAR((start + now.taken) / mass, 1.0, 5e-3);
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
