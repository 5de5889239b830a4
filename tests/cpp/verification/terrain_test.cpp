// Slopes oblique to the grid, straight and curved.
#include "../exact/motion.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

// A slab 60 m long and 20 m thick on a plane of 35 degrees; the grid is rotated relative to it, and gravity with the
// grid.
config::Case slab_on_plane(double ground) {
  const double c = std::cos(ground * degree), s = std::sin(ground * degree);
  const auto corner = [&](double along, double up) {
    return Vector<double, 2>(along * c + up * s, -along * s + up * c);
  };
  return published_case(
      "block",
      {fmt::format("case.gravity_tilt={}; terrain.type=plane; terrain.slope={}", 35.0 - ground, ground),
       "time.end=2; time.step=; time.stepping=adaptive; grid.cell=2.5; grid.min=[-20,-100]; grid.max=[150,50]",
       "material.rock.viscosity_time=0.01; body.block.shape=polygon; mechanics.slope_shear=true",
       "body.block.vertices=" + list_of({corner(0.0, 0.0), corner(60.0, 0.0), corner(60.0, 20.0), corner(0.0, 20.0)}),
       "heat.enabled=true; pressure.enabled=true"});
}

TEST(TiltedTerrain, MotionIsIndependentOfTheAngleToTheGrid) {
  Record record("One incline at four angles to the grid",
                "A slab slides down 35 degrees with a friction angle of 20 degrees; the grid lies along the slope or "
                "cuts through it.",
                "v = g (sin - mu cos) t, heat = mu m g cos times the displacement", "Coulomb friction");
  const double friction = std::tan(20.0 * degree);
  const double acceleration = physics::exact::acceleration_on_plane(35.0 * degree, friction, 9.81);
  for (const double ground : {0.0, 10.0, 26.565051177, 45.0}) {
    Simulation<2> simulation(slab_on_plane(ground));
    run_until(simulation, 2.0);
    const auto row = history_row(simulation);
    const double velocity = 2.0 * acceleration;
    const double heat = friction * value_of(row, "mass_kg") * 9.81 * std::cos(35.0 * degree) * 0.5 * acceleration * 4.0;
    record.expect_near(fmt::format("velocity over exact, {:.1f} degrees", ground),
                       value_of(row, "mean_velocity_m_s") / velocity, 1.0, 0.01);
    record.expect_near(fmt::format("heat over exact, {:.1f} degrees", ground), value_of(row, "friction_heat_J") / heat,
                       1.0, 0.03);
  }
}

constexpr double radius = 400.0;

// Writes a circular arc with its lowest point at x = 0 and a body 10 m thick on it between two angles.
void write_arc() {
  std::vector<std::vector<double>> points;
  for (double angle = -60.0; angle < 30.01; angle += 0.25) {
    const double x = radius * std::sin(angle * degree), y = radius * (1.0 - std::cos(angle * degree));
    const bool body = angle > -43.1 && angle < -36.9;
    const double inner = radius - 10.0;
    points.push_back({x, y, body ? radius - std::sqrt(inner * inner - x * x) : y});
  }
  write_profile(points);
}

// Mass, position and motion of the slide about the centre of the arc.
struct Turning {
  double mass = 0.0, inertia = 0.0, speed = 0.0;
  Vector<double, 2> centre = Vector<double, 2>::Zero();  // of mass, from the arc's centre

  explicit Turning(const Simulation<2>& simulation) {
    const auto& particles = simulation.particles();
    Vector<double, 2> momentum = Vector<double, 2>::Zero();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vector<double, 2> position(particles.position(p, 0) + simulation.model().origin[0],
                                       particles.position(p, 1) + simulation.model().origin[1] - radius);
      mass += particles.mass(p);
      centre += particles.mass(p) * position;
      inertia += particles.mass(p) * position.squaredNorm();
      momentum += particles.mass(p) * Vector<double, 2>(particles.velocity(p, 0), particles.velocity(p, 1));
    }
    centre /= mass;
    inertia /= mass;
    speed = momentum.norm() / mass;
  }
  [[nodiscard]] double angle() const { return std::atan2(-centre[0], -centre[1]); }
};

TEST(CurvedTerrain, OscillatesLikeAPendulumWithFriction) {
  Record record("A slide in a circular arc",
                "A body 10 m thick and 43 m long slides from rest at 40 degrees down an arc of 400 m radius. The arc "
                "is a polyline; the friction angle is 10 degrees.",
                "w^2 = A sin phi + B cos phi + K exp(a phi)", "pendulum with Coulomb friction");
  for (const double cell : {5.0, 2.5}) {
    write_arc();
    const Sets sets{fmt::format("grid.cell={}; time.step=; time.stepping=adaptive", cell),
                    "mechanisms.pressurization=false; heat.enabled=false"};
    Simulation<2> simulation(published_case("profile", sets));
    const Turning start(simulation);
    const physics::exact::ArcSlide exact{radius, start.centre.norm(), start.inertia, std::tan(10.0 * degree), 9.81};
    Curve curve{"angle [degrees]", "speed [m/s]", {}, {}, {}};
    Turning now = start;
    while (now.angle() > 0.0 && simulation.time() < 30.0) {
      take_steps(simulation, 25, 30.0);
      now = Turning(simulation);
      add_point(curve, now.angle() / degree, now.speed,
                exact.angular_speed(now.angle(), start.angle()) * now.centre.norm());
    }
    record.expect_near(fmt::format("speed at the lowest point over exact, cells of {} m", cell),
                       curve.computed.back() / curve.exact.back(), 1.0, 0.02);
    if (cell == 2.5) {
      record.draw(curve);
    }
  }
}

}  // namespace
}  // namespace thawslide::verification
