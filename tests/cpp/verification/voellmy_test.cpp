// A block that slides with Voellmy friction, from rest down a slope and to rest on level ground: with the material
// point method, and as a rigid block. With h the thickness along the normal, since rho h carries the block's mass:
//   dv/dt = a - g v^2/(xi h),  a = g (sin(theta) - mu cos(theta))
#include <map>

#include "sim/block/block.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double length = 40.0, height = 10.0;  // [m]

// A frozen block, on ground that is level or tilted with gravity.
config::Case block(int dimension, const Sets& sets) {
  const auto point = [&](double x, double across, double z) {
    return dimension == 3 ? fmt::format("[{}, {}, {}]", x, across, z) : fmt::format("[{}, {}]", x, z);
  };
  const Sets frozen{
      fmt::format("case.dimension={}; time.end=6; time.step=0.002; freezing.curve=linear", dimension),
      fmt::format("grid.min={}; grid.max={}", point(-20.0, -10.0, -10.0), point(300.0, 20.0, 30.0)),
      fmt::format("body.block.min={}; body.block.max={}", point(0.0, 0.0, 0.0), point(length, 10.0, height)),
      "material.rock.youngs_modulus=2e8; body.block.temperature=-10; basal.friction=voellmy"};
  return published_case("block", frozen + sets);
}

struct Motion {
  double velocity, displacement, friction_work;  // [m/s], [m], [J per m2 of base]
};

template <int Dim>
Motion in_mpm(const Sets& sets) {
  Simulation<Dim> simulation(block(Dim, sets));
  run_until(simulation, simulation.parameters().time.end);
  const auto row = sim::history_row(simulation);
  const double base = length * (Dim == 3 ? 10.0 : 1.0);
  return {value_of(row, "mean_velocity_m_s"), value_of(row, "mean_displacement_m"),
          value_of(row, "friction_work_J") / base};
}

Motion of_rigid_block(const Sets& sets) {
  const auto rows = sim::run_block(block(2, sets));
  const std::map<std::string, double> last(rows.back().begin(), rows.back().end());
  return {last.at("velocity_m_s"), last.at("displacement_m"), last.at("friction_work_J_m2")};
}

// Down a slope from rest: v = v_t tanh(a t/v_t), s = v_t^2/a log cosh(a t/v_t), v_t^2 = xi h a/g.
struct FromRest {
  double slope = 20.0, mu = 0.1, turbulence = 50.0, time = 8.0;

  [[nodiscard]] Sets sets() const {
    return fmt::format("case.gravity_tilt={}; basal.friction_coefficient={}; basal.turbulent_friction={}; time.end={}",
                       slope, mu, turbulence, time);
  }
  [[nodiscard]] double drive() const { return gravity * (std::sin(slope * degree) - mu * std::cos(slope * degree)); }
  [[nodiscard]] double terminal() const { return std::sqrt(turbulence * height * drive() / gravity); }
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
  const double exact = turbulence * height / (2.0 * gravity) * std::log1p(start * start / (mu * turbulence * height));
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
  Simulation<2> simulation(block(
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
