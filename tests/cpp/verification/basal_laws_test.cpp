// A block that slides on basal laws with an exact solution: with the material point method, and as a rigid block.
#include <map>

#include "sim/block/block.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double length = 40.0, height = 20.0;  // [m]

// A frozen block of 40 m x 20 m on level ground, with a horizontal initial velocity.
const Sets thrown{"time.end=4; freezing.curve=linear; body.block.temperature=-10; body.block.velocity=[10,0]"};

// Last rows of the history of the material point method and of the rigid block.
struct Last {
  std::map<std::string, double> mpm, block;
};

Last run_to_end(const Sets& sets) {
  const config::Case parameters = published_case("block", thrown + sets);
  Simulation<2> simulation(parameters);
  run_until(simulation, parameters.time.end);
  const auto row = history_row(simulation), of_block = sim::run_block(parameters).back();
  return {{row.begin(), row.end()}, {of_block.begin(), of_block.end()}};
}

TEST(Bonds, DissipateTheirEnergyOnce) {
  constexpr double initial = 1e5, distance = 4.0;
  Record record(
      "Bonds of ice: energy of breaking",
      "A frozen block is thrown along level ground. Only bonds of 0.1 MPa hold it, which slip breaks over 4 m.",
      "energy lost per area = c_0 d_c, at any speed", "integral of c_0 exp(-s/d_c) over the slip");
  const Last found = run_to_end(
      fmt::format("basal.friction_angle=0; basal.cohesion={}; basal.cohesion_law=bonds; basal.slip_distance={}",
                  initial, distance));
  record.explain("the material point method: nodes at the ends of the block share its base to half a per cent");
  record.expect_near("energy over c_0 d_c", found.mpm.at("friction_work_J") / (length * initial * distance), 1.0, 1e-2);
  record.expect_near("the same of the rigid block", found.block.at("friction_work_J_m2") / (initial * distance), 1.0,
                     2e-3);
}

// From rock onto a glacier: while a rigid block crosses the border, friction decreases in proportion to the part that
// has crossed. Friction acts at its base, below its centre of mass. Its load is therefore shifted forward, by mu h/2 on
// average (from the balance of moments), and reaches the border earlier by the same distance.
TEST(Substrates, TravelDistanceOverTwoIsExact) {
  constexpr double on_rock = 0.3, on_ice = 0.15, start = 20.0, border = 52.5;
  const double to_border = border - length, mean = 0.5 * (on_rock + on_ice);
  const double rest = start * start / (2.0 * gravity) - on_rock * to_border - mean * length;  // m, of v^2/2g
  const double of_block = to_border + length + rest / on_ice;
  const double of_body = of_block + (on_rock / on_ice - 1.0) * mean * 0.5 * height;
  Record record("Sliding distance over two substrates",
                "A block of 40 m x 20 m is thrown along level ground, at first on rock with friction 0.3. A glacier "
                "with friction 0.15 begins 12.5 m before its front. The block comes to rest on the glacier.",
                "v^2/(2 g) = mu_1 b + (mu_1 + mu_2) L/2 + mu_2 (d - b - L). If the load is shifted forward by mu h/2, "
                "d is longer by (mu_1/mu_2 - 1) (mu_1 + mu_2) h/4",
                "energy of a rigid block, balance of its moments");
  const Last found = run_to_end(
      fmt::format("basal.friction_angle={:.15g}; substrate.glacier.x_min={}; substrate.glacier.friction=coefficient; "
                  "substrate.glacier.friction_coefficient={}; body.block.velocity=[20,0]; time.end=12",
                  std::atan(on_rock) / degree, border, on_ice));
  EXPECT_LT(found.mpm.at("mean_velocity_m_s"), 1e-2) << "it still slides";
  EXPECT_LT(found.block.at("velocity_m_s"), 1e-9) << "it still slides";
  record.expect_near("distance over exact", found.mpm.at("mean_displacement_m") / of_body, 1.0, 5e-3);
  record.expect_near("of the rigid block, whose load does not lean", found.block.at("displacement_m") / of_block, 1.0,
                     1e-3);
}

// Voellmy friction, from rest down a slope and to rest on level ground. With h the thickness along the normal, since
// rho h carries the block's mass:
//   dv/dt = a - g v^2/(xi h),  a = g (sin(theta) - mu cos(theta))
constexpr double voellmy_height = 10.0;

// A frozen block, on ground that is level or tilted with gravity.
config::Case voellmy_block(int dimension, const Sets& sets) {
  const auto at = [&](double x, double y, double z) { return point_text(dimension, x, y, z); };
  const Sets frozen{
      fmt::format("case.dimension={}; time.end=6; time.step=0.002; freezing.curve=linear", dimension),
      fmt::format("grid.min={}; grid.max={}", at(-20.0, -10.0, -10.0), at(300.0, 20.0, 30.0)),
      fmt::format("body.block.min={}; body.block.max={}", at(0.0, 0.0, 0.0), at(length, 10.0, voellmy_height)),
      "material.rock.youngs_modulus=2e8; body.block.temperature=-10; basal.friction=voellmy"};
  return published_case("block", frozen + sets);
}

struct Motion {
  double velocity, displacement, friction_work;  // [m/s], [m], [J per m2 of base]
};

template <int Dim>
Motion in_mpm(const Sets& sets) {
  Simulation<Dim> simulation(voellmy_block(Dim, sets));
  run_until(simulation, simulation.parameters().time.end);
  return {history_value(simulation, "mean_velocity_m_s"), history_value(simulation, "mean_displacement_m"),
          history_value(simulation, "friction_work_J") / (length * (Dim == 3 ? 10.0 : 1.0))};
}

Motion of_rigid_block(const Sets& sets) {
  const auto last = sim::run_block(voellmy_block(2, sets)).back();
  return {value_of(last, "velocity_m_s"), value_of(last, "displacement_m"), value_of(last, "friction_work_J_m2")};
}

// Down a slope from rest: v = v_t tanh(a t/v_t), s = v_t^2/a log cosh(a t/v_t), v_t^2 = xi h a/g.
struct FromRest {
  double slope = 20.0, mu = 0.1, turbulence = 50.0, time = 8.0;

  [[nodiscard]] Sets sets() const {
    return fmt::format("case.gravity_tilt={}; basal.friction_coefficient={}; basal.turbulent_friction={}; time.end={}",
                       slope, mu, turbulence, time);
  }
  [[nodiscard]] double drive() const { return gravity * (std::sin(slope * degree) - mu * std::cos(slope * degree)); }
  [[nodiscard]] double terminal() const { return std::sqrt(turbulence * voellmy_height * drive() / gravity); }
  [[nodiscard]] Motion exact() const {
    const double at = drive() * time / terminal();
    return {terminal() * std::tanh(at), terminal() * terminal() / drive() * std::log(std::cosh(at)), 0.0};
  }
};

TEST(Voellmy, BlockOnASlopeApproachesItsTerminalVelocity) {
  const FromRest slide;
  const Motion exact = slide.exact();
  Record record(
      "Voellmy friction down a slope",
      "A frozen block of 40 m x 10 m starts from rest on a slope of 20 degrees; mu = 0.1, xi = 50 m/s2. After "
      "8 s it has 94 % of its terminal velocity.",
      "v = v_t tanh(a t/v_t), s = v_t^2/a log cosh(a t/v_t), a = g (sin(theta) - mu cos(theta)), "
      "v_t^2 = xi h a/g",
      "dv/dt = a - g v^2/(xi h), from rest");
  const Motion plane = in_mpm<2>(slide.sets()), space = in_mpm<3>(slide.sets()), rigid = of_rigid_block(slide.sets());
  record.expect_near("velocity over exact, in the plane", plane.velocity / exact.velocity, 1.0, 2e-3);
  record.expect_near("distance over exact, in the plane", plane.displacement / exact.displacement, 1.0, 2e-3);
  record.expect_near("velocity over exact, in space", space.velocity / exact.velocity, 1.0, 2e-3);
  record.expect_near("velocity over exact, of the rigid block", rigid.velocity / exact.velocity, 1.0, 1e-3);
  record.expect_near("distance over exact, of the rigid block", rigid.displacement / exact.displacement, 1.0, 1e-3);
}

TEST(Voellmy, RigidBlockConvergesInFirstOrderOfTheStep) {
  const FromRest slide;
  Record record("Voellmy friction, over the time step", "The rigid block of the slope above.",
                "v = v_t tanh(a t/v_t) after 8 s", "dv/dt = a - g v^2/(xi h), from rest");
  std::vector<double> steps, errors;
  for (const double step : {0.08, 0.04, 0.02, 0.01}) {
    const Sets soft{"material.rock.youngs_modulus=1e5; material.rock.viscosity_time=0",
                    fmt::format("time.step={}", step)};
    steps.push_back(step);
    errors.push_back(std::abs(of_rigid_block(slide.sets() + soft).velocity / slide.exact().velocity - 1.0));
  }
  record.expect_order("time step (s)", steps, "error of the velocity", errors, 1.0, 0.1);
}

// On level ground: v^2/v_c^2 falls with the distance, v_c^2 = mu xi h; to rest after xi h/(2 g) log(1 + v_0^2/v_c^2).
TEST(Voellmy, ThrownBlockComesToRest) {
  constexpr double mu = 0.2, turbulence = 400.0, start = 25.0;
  const double exact =
      turbulence * voellmy_height / (2.0 * gravity) * std::log1p(start * start / (mu * turbulence * voellmy_height));
  Record record("Voellmy friction to rest",
                "A frozen block of 40 m x 10 m is thrown along level ground at 25 m/s; mu = 0.2, xi = 400 m/s2.",
                "s = xi h/(2 g) log(1 + v_0^2/(mu xi h)); friction dissipates rho h v_0^2/2 per m2",
                "dv/dt = -mu g - g v^2/(xi h)");
  const Sets sets{"basal.friction_coefficient=0.2; basal.turbulent_friction=400; body.block.velocity=[25,0]",
                  "time.end=12"};
  const Motion plane = in_mpm<2>(sets), rigid = of_rigid_block(sets);
  EXPECT_LT(plane.velocity, 1e-2) << "it still slides";
  EXPECT_EQ(rigid.velocity, 0.0) << "it still slides";
  record.expect_near("distance over exact, in the plane", plane.displacement / exact, 1.0, 2e-3);
  record.expect_near("distance over exact, of the rigid block", rigid.displacement / exact, 1.0, 1e-3);
  record.expect_near("work of friction in the plane, over that of the rigid block",
                     plane.friction_work / rigid.friction_work, 1.0, 2e-3);
}

// At 60 m/s with xi = 1 m/s2, a step of the drag would remove more than the momentum of a node.
TEST(Voellmy, StrongDragStopsTheBaseAndReversesNothing) {
  Simulation<2> simulation(voellmy_block(
      2, {"basal.friction_coefficient=0.1; basal.turbulent_friction=1; time.end=1", "body.block.velocity=[60,0]"}));
  double former = 60.0 * (1.0 + 1e-12);
  while (simulation.time() < 0.2) {
    simulation.step(simulation.next_step(0.2));
    const double velocity = value_of(sim::history_row(simulation), "mean_velocity_m_s");
    EXPECT_GE(velocity, 0.0);
    EXPECT_LE(velocity, former);
    former = velocity * (1.0 + 1e-12);
  }
  EXPECT_LT(former, 30.0);
}

}  // namespace
}  // namespace thawslide::verification
