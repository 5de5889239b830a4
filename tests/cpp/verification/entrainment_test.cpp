// A block that entrains the bed below it: momentum and energy in closed form, for both laws, in 2D and 3D.
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double speed = 20.0, front = 40.0, width = 20.0;  // [m/s], [m]: x of the block's front, its width in 3D

// A frozen elastic block 40 m long on level ground, with a horizontal initial velocity and a basal friction angle
// [degrees].
template <int Dim>
config::Case thrown(double height, double end, double friction_angle, const Sets& bed = {}) {
  const auto at = [](double x, double y, double z) {
    return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, y, z);
  };
  const Sets block{fmt::format("case.dimension={0}; time.end={1}; time.step={1}; time.stepping=adaptive", Dim, end),
                   fmt::format("grid.min={}; grid.max={}", at(-20.0, -20.0, -10.0), at(260.0, 40.0, 40.0)),
                   fmt::format("body.block.min={}; body.block.max={}", at(0.0, 0.0, 0.0), at(front, width, height)),
                   fmt::format("body.block.velocity={}; basal.friction_angle={}", at(speed, 0.0, 0.0), friction_angle),
                   "material.rock.youngs_modulus=2e8; body.block.temperature=-10; body.block.porosity=0.375"};
  return published_case("block", block + bed);
}

// Erodible bed of the block's rock.
const Sets bed{"bed.depth_per_slip=1; bed.material=rock; bed.porosity=0.9"};

// State of the run.
struct State {
  double mass, velocity, kinetic, front, taken, residual;  // [kg], [m/s], [J], [m], [kg], fraction of the momentum
};

template <int Dim>
State state_of(const Simulation<Dim>& simulation) {
  const sim::HistoryRow row = sim::history_row(simulation);
  const auto value = [&](const std::string& name) { return value_of(row, name); };
  const auto& particles = simulation.particles();
  double foremost = -HUGE_VAL;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.body(p) == 0) {
      foremost = std::max(foremost, particles.position(p, 0) + simulation.model().origin[0] + 1.25);
    }
  }
  return {value("mass_kg"),           value("momentum_x_N_s") / value("mass_kg"),
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

}  // namespace
}  // namespace thawslide::verification
