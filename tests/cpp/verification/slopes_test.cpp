// Slopes oblique to the grid, straight and curved; a small block on curved DEMs: a bowl, and a channel along a helix.
#include "../exact/motion.hpp"
#include "../support/point_on_surface.hpp"
#include "../support/slide_on_dem.hpp"
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

const auto block =
    release_on_dem({100.0, 0.0018, 2.5, {-350.0, -350.0, -250.0}, {350.0, 350.0, 450.0}}, elastic_rock(0.01), 10.0) +
    // The sides of channels and bowls are steeper than the default limit where no block gets.
    "grid.steepest=85; time.stepping=adaptive";

// A block 10 m square in the map around a position, and 5 m high.
Raster small_block(const Place& centre) {
  const Place half = Place::Constant(5.0);
  return thickness_between(centre - half, centre + half, 1.25 / 16.0, [](double, double) { return 5.0; });
}

// Verifies the point mass used as reference with a closed form.
TEST(PointOnSurface, OscillatesInTheBowl) {
  constexpr double radius = 100.0, friction = 0.2;
  const auto bowl = [](double x, double y) { return radius - std::sqrt(radius * radius - x * x - y * y); };
  const double start = 50.0 * degree;
  PointOnSurface point(bowl, Place(radius * std::sin(start), 0.0), friction, gravity);
  const physics::exact::ArcSlide exact{radius, radius, radius * radius, friction, gravity};
  while (point.place()[0] > 0.0) {
    point.step(0.01);
    const double angle = std::asin(point.place()[0] / radius);
    EXPECT_NEAR(point.velocity().norm(), radius * exact.angular_speed(angle, start), 1e-5);
    EXPECT_EQ(point.place()[1], 0.0);
  }
}

// The block has an extent: it is compared with a point at the same distance from the centre of the sphere as its centre
// of mass. With phi from the lowest point, the point is pressed to its circle with N = m (g cos phi + v^2/r), so that
//   d(v^2)/dphi = -2 r g sin phi + 2 mu (r g cos phi + v^2)
TEST(Bowl, BlockOscillatesLikeAPointMassWithFriction) {
  constexpr double radius = 200.0, start = 40.0 * degree, azimuth = 205.0 * degree;
  Record record("A small block in a bowl",
                "A block, 10 m square and 5 m high, slides from rest at 40 degrees down a spherical bowl of 200 m "
                "radius. The bowl is a DEM with points 2.5 m apart; the friction angle is 10 degrees.",
                "d(v^2)/dphi = -2 r g sin phi + 2 mu (r g cos phi + v^2), r that of the block's centre of mass",
                "point on a circle with Coulomb friction");
  const Raster ground = raster_between(Place(-190.0, -190.0), Place(190.0, 190.0), 2.5, [](double x, double y) {
    const double squared = radius * radius - x * x - y * y;
    return radius - std::sqrt(std::max(squared, 0.01 * radius * radius));
  });
  const Place along(std::cos(azimuth), std::sin(azimuth));
  Simulation<3> simulation(case_on_dem(block), site_of(ground, small_block(radius * std::sin(start) * along)));
  const auto from_centre = [&](const CentreOfMass& body) {
    return Position(body.position - Position(0.0, 0.0, radius));
  };
  const auto angle = [&](const CentreOfMass& body) {
    const Position arm = from_centre(body);
    return std::atan2(along.dot(arm.head<2>()), -arm[2]);
  };
  CentreOfMass now(simulation);
  const double first = angle(now);
  Curve curve{"angle [degrees]", "speed [m/s]", {}, {}, {}};
  double largest_aside = 0.0;
  while (angle(now) > 0.0 && simulation.time() < 30.0) {
    take_steps(simulation, 25, 30.0);
    now = CentreOfMass(simulation);
    const double r = from_centre(now).norm();
    const physics::exact::ArcSlide exact{r, r, r * r, std::tan(10.0 * degree), gravity};
    add_point(curve, angle(now) / degree, now.velocity.norm(), r * exact.angular_speed(angle(now), first));
    largest_aside = std::max(largest_aside, std::abs(along[0] * now.position[1] - along[1] * now.position[0]));
  }
  record.expect_near("speed at the lowest point over exact", curve.computed.back() / curve.exact.back(), 1.0, 0.02);
  record.expect_near("lateral displacement [m]", largest_aside, 0.0, 0.25);
  record.draw(curve);
}

// Circles of radius `section` about a helix that falls by `pitch` per turn from x > 0 on; their steep parts are
// replaced by planes.
struct Helix {
  double radius = 150.0, pitch = 160.0, section = 60.0;  // m

  // Height of the ground, or of the surface `above` it.
  [[nodiscard]] double height(double x, double y, double above = 0.0) const {
    const double r = section - above, steep = 0.9 * r;
    const double across = std::abs(std::hypot(x, y) - radius);
    const double wall = across < steep ? -std::sqrt(r * r - across * across)
                                       : -std::sqrt(r * r - steep * steep) +
                                             (across - steep) * steep / std::sqrt(r * r - steep * steep);
    return section + wall - pitch * turns(x, y);
  }
  [[nodiscard]] static double turns(double x, double y) {
    const double angle = std::atan2(y, x) / (2.0 * pi);
    return angle < 0.0 ? angle + 1.0 : angle;
  }
  // Distance of a position from the line of the circles' centres.
  [[nodiscard]] double off_centres(const Position& position) const {
    return std::hypot(std::hypot(position[0], position[1]) - radius,
                      position[2] - section + pitch * turns(position[0], position[1]));
  }
};

// Ratio of the distance of a block along the channel to that of the point from the equation of motion, at each quarter
// of a turn.
std::vector<double> run_along(double turns, Curve& curve) {
  const Helix helix;
  const Raster ground = raster_between(Place(-230.0, -230.0), Place(230.0, 230.0), 2.5,
                                       [&](double x, double y) { return helix.height(x, y); });
  const double start = 15.0 * degree;
  Simulation<3> simulation(case_on_dem(block, Sets("basal.friction_angle=6.0")),
                           site_of(ground, small_block(helix.radius * Place(std::cos(start), std::sin(start)))));
  CentreOfMass now(simulation);
  const double above = helix.section - helix.off_centres(now.position);
  PointOnSurface exact([&](double x, double y) { return helix.height(x, y, above); }, now.position.head<2>(),
                       std::tan(6.0 * degree), gravity);
  const double first = helix.turns(now.position[0], now.position[1]);
  const auto progress = [&](const Place& place) { return helix.turns(place[0], place[1]) - first; };
  std::vector<double> ratios;
  curve = {"time [s]", "turns", {}, {}, {}};
  double next = 0.25;
  while (first + progress(now.position.head<2>()) < turns && simulation.time() < 100.0) {
    for (int k = 0; k < 25; ++k) {
      const double dt = simulation.next_step(100.0);
      simulation.step(dt);
      exact.step(dt);
    }
    now = CentreOfMass(simulation);
    add_point(curve, simulation.time(), progress(now.position.head<2>()), progress(exact.place()));
    if (curve.exact.back() > next) {
      ratios.push_back(curve.computed.back() / curve.exact.back());
      next += 0.25;
    }
  }
  ratios.push_back(curve.computed.back() / curve.exact.back());
  return ratios;
}

TEST(HelicalChannel, BlockMovesLikeAPointMassOnTheSurface) {
  Record record(
      "A small block in a channel along a helix",
      "A block, 10 m square and 5 m high, slides down one turn of a channel of circular section (60 m radius). The "
      "channel follows a helix (150 m radius, 160 m pitch). The friction angle is 6 degrees; points of the DEM and "
      "nodes are 2.5 m apart.",
      "a = g + N (n - mu v/|v|), N = II(v, v) + g n_z, by Runge-Kutta, on the parallel surface that the "
      "block's centre of mass starts on",
      "point on a surface with Coulomb friction");
  Curve curve;
  const std::vector<double> whole = run_along(345.0 / 360.0, curve);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    record.expect_near(fmt::format("place along the channel over exact, after {:.2f} turns",
                                   k + 1 < whole.size() ? 0.25 * static_cast<double>(k + 1) : curve.exact.back()),
                       whole[k], 1.0, 0.01);
  }
  record.draw(curve);
}

}  // namespace
}  // namespace thawslide::verification
