// A block that entrains the bed below it: momentum and energy in closed form, for both laws, in 2D and 3D.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/case_from_text.hpp"
#include "../support/record.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;

constexpr double speed = 20.0, front = 40.0, width = 20.0;  // [m/s], [m]: x of the block's front, its width in 3D
constexpr double gravity = 9.81;

// A frozen elastic block 40 m long on level ground, with a horizontal initial velocity; [basal] and [bed] are added
// later.
template <int Dim>
std::string thrown(double height, double end) {
  const auto at = [](double x, double y, double z) {
    return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, y, z);
  };
  return fmt::format(R"(
[case]
dimension = {}
[time]
end = {}
stepping = "adaptive"
[grid]
cell = 5.0
min = {}
max = {}
[terrain]
type = "flat"
elevation = 0.0
[material.rock]
law = "elastic"
youngs_modulus = 2e8
poisson_ratio = 0.2
viscosity_time = 0.02
[body.block]
material = "rock"
shape = "box"
min = {}
max = {}
temperature = -10.0
porosity = 0.375
velocity = {}
[mechanisms]
pressurization = false
[heat]
enabled = false
[pressure]
enabled = false
)",
                     Dim, end, at(-20.0, -20.0, -10.0), at(260.0, 40.0, 40.0), at(0.0, 0.0, 0.0),
                     at(front, width, height), at(speed, 0.0, 0.0));
}

// State of the run.
struct State {
  double mass, velocity, kinetic, front, taken, residual;  // [kg], [m/s], [J], [m], [kg], fraction of the momentum
};

template <int Dim>
State state_of(const sim::Simulation<Dim>& simulation) {
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
  sim::Simulation<Dim> simulation(
      paper_case(thrown<Dim>(20.0, 8.0) +
                 "[basal]\nfriction = \"constant\"\nfriction_angle = 0.0\n[bed]\nlaw = \"strength\"\n"
                 "strength = 0.0\ndepth_per_slip = 1.0\nmaterial = \"rock\"\nporosity = 0.9\n"
                 "depth = { x = [40.0, 40.0], value = [0.0, 2.0] }\n"));
  const double start = state_of(simulation).mass;
  const double per_metre = simulation.model().bed_density * depth * (Dim == 3 ? width : 1.0);
  Curve curve{"front x - x_0 [m]", "velocity [m/s]", {}, {}, {}};
  State now{};
  double most_residual = 0.0;
  for (int k = 1; k <= 8; ++k) {
    run_until(simulation, k);
    now = state_of(simulation);
    curve.x.push_back(now.front - front);
    curve.computed.push_back(now.velocity);
    curve.exact.push_back(start * speed / (start + per_metre * (now.front - front)));
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

TEST(Entrainment, SweepsUpALayerInThePlane) { sweep_up<2>("2D"); }
TEST(Entrainment, SweepsUpALayerInSpace) { sweep_up<3>("3D"); }

// With Coulomb friction mu on a bed of mu_b, by the law of momentum: the drag on the slide is mu m g for any
// entrainment, and therefore v = v0 - mu g t, and dm v = (mu - mu_b) m g dt.
template <int Dim>
void entrain_by_friction(const std::string& where) {
  constexpr double angle = 17.0, bed_angle = 14.0;  // degrees
  const double mu = std::tan(angle * pi / 180.0), mu_bed = std::tan(bed_angle * pi / 180.0);
  Record record("Entrainment: a block whose friction exceeds that of the bed, " + where,
                "A block slides with friction over a bed of less friction, which is deep enough everywhere.",
                "v = v_0 - mu g t, m = m_0 (v/v_0)^-(1 - mu_b/mu)",
                "integral of v dm/dt = (mu - mu_b) m g, the law of momentum under the block's weight");
  sim::Simulation<Dim> simulation(paper_case(
      thrown<Dim>(10.0, 3.0) +
      fmt::format("[basal]\nfriction = \"constant\"\nfriction_angle = {}\n[bed]\nlaw = \"momentum\"\nstrength = 0.0\n"
                  "friction_angle = {}\ndepth_per_slip = 1.0\nmaterial = \"rock\"\nporosity = 0.9\n"
                  "particles_per_axis = 4\ndepth = 5.0\n",
                  angle, bed_angle)));
  const double start = state_of(simulation).mass;
  run_until(simulation, 3.0);
  const State now = state_of(simulation);
  const double velocity = speed - mu * gravity * 3.0;
  const double taken = start * (std::pow(velocity / speed, -(1.0 - mu_bed / mu)) - 1.0);
  record.expect_near("velocity over the exact one", now.velocity / velocity, 1.0, 1e-2);
  record.expect_near("entrained mass over the exact one", now.taken / taken, 1.0, 3e-2);
  record.expect_near("momentum left over, as a share", now.residual, 0.0, 1e-13);
}

TEST(Entrainment, FrictionTakesUpWhatItHasImpulseForInThePlane) { entrain_by_friction<2>("2D"); }
TEST(Entrainment, FrictionTakesUpWhatItHasImpulseForInSpace) { entrain_by_friction<3>("3D"); }

// A bed stronger than the friction remains in place and has no effect on the slide.
TEST(Entrainment, ABedThatWithstandsTheShearStays) {
  for (const std::string law : {"strength", "momentum"}) {
    const auto text = [&](double strength) {
      return thrown<2>(10.0, 1.0) +
             fmt::format(
                 "[basal]\nfriction = \"constant\"\nfriction_angle = 17.0\n[bed]\nlaw = \"{}\"\nstrength = {}\n"
                 "depth_per_slip = 1.0\nmaterial = \"rock\"\nporosity = 0.9\ndepth = 2.0\n",
                 law, strength);
    };
    sim::Simulation<2> strong(paper_case(text(1e7))), weak(paper_case(text(1e3)));
    run_until(strong, 1.0);
    run_until(weak, 1.0);
    EXPECT_EQ(state_of(strong).taken, 0.0) << law;
    EXPECT_GT(state_of(weak).taken, 1e3) << law;
    sim::Simulation<2> without(
        paper_case(thrown<2>(10.0, 1.0) + "[basal]\nfriction = \"constant\"\nfriction_angle = 17.0\n"));
    for (int k = 0; k < 20; ++k) {
      without.step(1e-3);
    }
    sim::Simulation<2> same(paper_case(text(1e7)));
    for (int k = 0; k < 20; ++k) {
      same.step(1e-3);
    }
    EXPECT_EQ(value_of(sim::history_row(same), "momentum_x_N_s"), value_of(sim::history_row(without), "momentum_x_N_s"))
        << law;
  }
}

}  // namespace
}  // namespace thawslide::verification
