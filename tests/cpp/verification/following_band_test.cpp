// Cells that follow the ground: the scaled band has the same thickness along the normal on every slope.
#include <functional>

#include "../support/following_plane.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double length = 1200.0, thickness = 30.0;  // of the slab [m]

// A slab slides down a plane. Gravity is at an angle [degrees] to the normal of the plane. The cells have layers of 10
// m along the normal.
Simulation<2> slab_on(const Incline& plane, double gravity_angle, double velocity, const Sets& sets) {
  const double cell = 10.0 / std::cos(plane.angle());
  const auto cells = [&](double size) { return cell * std::ceil(size / cell); };
  const std::string vertices = list_of(
      {plane.place(0.0, 0.0), plane.place(length, 0.0), plane.place(length, thickness), plane.place(0.0, thickness)});
  const auto toe = plane.place(length, 0.0), initial = plane.place(velocity, 0.0);
  return Simulation<2>(published_case(
      "slab", Sets(fmt::format("time.step=; time.stepping=adaptive; grid.cell={}; grid.min=[{},{}]; "
                               "grid.max=[{},{}]; terrain.type=plane; terrain.elevation=0; terrain.slope={}; "
                               "body.slab.shape=polygon; body.slab.min=; body.slab.max=; body.slab.vertices={}; "
                               "body.slab.velocity=[{},{}]; case.gravity_tilt={}; material.rock.youngs_modulus=5e8; "
                               "mechanics.slope_shear=true",
                               cell, -10.0 * cell, -cells(100.0 - toe[1]), cells(toe[0] + 100.0), 10.0 * cell,
                               plane.degrees, vertices, initial[0], initial[1], gravity_angle - plane.degrees)) +
                  sets));
}

// Means over the band below the middle three fifths of the slab.
struct Band {
  double mass = 0.0, slip = 0.0, temperature = 0.0, saturation = 0.0, pressure = 0.0;

  Band(const Simulation<2>& simulation, const Incline& plane) {
    const auto& particles = simulation.particles();
    const double centre = mass_mean(simulation, [&](auto p) { return particles.position(p, 0); });
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles.in_band(p) != 0 && std::abs(particles.position(p, 0) - centre) < 0.3 * length * plane.down()[0]) {
        mass += particles.mass(p);
        slip += particles.mass(p) * particles.displacement.get<Vector<double, 2>>(p).dot(plane.down());
        temperature += particles.mass(p) * particles.temperature(p);
        saturation += particles.mass(p) * particles.liquid_saturation(p);
        pressure += particles.mass(p) * particles.pore_pressure(p);
      }
    }
    for (double* sum : {&slip, &temperature, &saturation, &pressure}) {
      *sum /= mass;
    }
  }
};

TEST(FollowingBand, IsEquallyThickOnEverySlope) {
  Record record(
      "Cells that follow the ground: scaled band on planes",
      "A slab of 1,200 m x 30 m slides on planes of 0, 30 and 48 degrees, with gravity at the same angle to the "
      "plane. The scaled band is 0.05 m thick. It is melted, adiabatic and undrained, or begins at -1 C, melts "
      "and drains.",
      "state of the band on the level plane", "the band does not depend on the direction of the vertical");
  const std::pair<const char*, std::function<Simulation<2>(const Incline&)>> slabs[] = {
      {"undrained",
       [](const Incline& plane) {
         return slab_on(plane, 11.3, 1.0,
                        "time.end=2; body.slab.temperature=1e-9; basal.friction=constant; "
                        "basal.friction_angle=11.30993247402; heat.conduction=false; heat.advection=false; "
                        "pressure.seepage=false");
       }},
      {"melting",
       [](const Incline& plane) { return slab_on(plane, 25.0, 2.0, "time.end=5; body.slab.temperature=-1"); }}};
  for (const auto& [kind, make] : slabs) {
    double start = 0.0;  // temperature [C]
    std::vector<Band> bands;
    for (const double degrees : {0.0, 30.0, 48.0}) {
      Simulation<2> simulation = make({degrees});
      start = simulation.particles().temperature(0);
      run_until(simulation, simulation.parameters().time.end);
      bands.emplace_back(simulation, Incline{degrees});
      const Band &level = bands.front(), &band = bands.back();
      const std::string where = fmt::format(", {} band, {} degrees over level", kind, degrees);
      if (degrees > 0.0) {
        record.expect_near("slip" + where, band.slip / level.slip, 1.0, 0.01);
        record.expect_near("rise of the temperature" + where, (band.temperature - start) / (level.temperature - start),
                           1.0, 0.01);
        record.expect_near("liquid saturation" + where, band.saturation / level.saturation, 1.0, 0.01);
        record.expect_near("pore pressure" + where, band.pressure / level.pressure, 1.0, 0.01);
      }
    }
    EXPECT_GT(bands.front().temperature, 0.3) << "the band must have melted";
  }
}

}  // namespace
}  // namespace thawslide::verification
