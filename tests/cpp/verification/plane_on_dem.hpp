// A block on a planar DEM: shared by the short and the complete tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "../support/record.hpp"
#include "../support/slide_on_dem.hpp"
#include "base/portability.hpp"
#include "sim/history.hpp"

namespace thawslide::verification {

namespace plane_on_dem {

using namespace testing_support;

inline constexpr double degree = pi / 180.0;
inline constexpr double gravity = 9.81;
inline constexpr double width = 40.0;   // of the block, square in the map [m]
inline constexpr double height = 20.0;  // vertical [m]

inline const Variant block =
    release_on_dem({1.0, 0.001, 5.0, {-100.0, -100.0, -120.0}, {100.0, 100.0, 120.0}}, elastic_rock(0.02), 10.0);

struct Plane {
  double slope;          // [degrees]
  double azimuth = 0.0;  // of the fall line, from +x towards +y [degrees]

  [[nodiscard]] std::string text() const { return fmt::format("{} degrees towards {}", slope, azimuth); }
  [[nodiscard]] Position down() const {
    return {std::cos(slope * degree) * std::cos(azimuth * degree),
            std::cos(slope * degree) * std::sin(azimuth * degree), -std::sin(slope * degree)};
  }
  [[nodiscard]] double base_area() const { return width * width / std::cos(slope * degree); }  // of the block [m2]
};

// Motion of the block in the second half of the run, after the initial adjustment of its stress.
struct Slide {
  double acceleration, aside;     // down the plane [m/s2]; speed across the fall line at the end [m/s]
  double displacement, velocity;  // [m]; at the end [m/s]
  double work, heat, mass;
  double area;  // of contact, mean [m2]
};

// The points of the DEM, 7 m apart, are not aligned with the grid. There are 16 points of the thickness per particle
// spacing, which resolve the ends of the block.
inline Slide slide(const Plane& plane, const std::vector<std::string>& sets) {
  const Position down = plane.down();
  const Raster ground = raster_between(Place(-105.0, -105.0), Place(105.0, 105.0), 7.0, [&](double x, double y) {
    return down[2] * (x * down[0] + y * down[1]) / (1.0 - down[2] * down[2]);
  });
  const Place corner = Place::Constant(0.5 * width);
  const Raster thickness = thickness_between(-corner, corner, 2.5 / 16.0, [](double, double) { return height; });
  sim::Simulation<3> simulation(case_on_dem(block, sets), site_of(ground, thickness));
  const double end = simulation.parameters().time.end;
  run_until(simulation, 0.5 * end);
  const CentreOfMass middle(simulation);
  const auto before = history_row(simulation);
  double area = 0.0;
  int steps = 0;
  for (; simulation.time() < end * (1.0 - 1e-12); ++steps) {
    simulation.step(simulation.next_step(end));
    area += simulation.contact().area;
  }
  const CentreOfMass last(simulation);
  const auto after = history_row(simulation);
  const auto gain = [&](const char* column) { return value_of(after, column) - value_of(before, column); };
  return {.acceleration = (last.velocity - middle.velocity).dot(down) / (0.5 * end),
          .aside = (last.velocity - last.velocity.dot(down) * down).norm(),
          .displacement = (last.position - middle.position).dot(down),
          .velocity = last.velocity.norm(),
          .work = gain("friction_work_J"),
          .heat = gain("friction_heat_J"),
          .mass = last.mass,
          .area = area / steps};
}

inline std::vector<std::string> rubbing(double friction_angle, double cohesion = 0.0) {
  return {fmt::format("basal.friction_angle={}", friction_angle), "basal.cohesion_law=constant",
          fmt::format("basal.cohesion={}", cohesion), "heat.enabled=true"};
}

// Nodes divide the base by the load that they carry. On slopes their sum is several hundredths too large, which affects
// cohesion and not friction.
inline double allowed_of_area(const Plane& plane) { return 0.005 + 0.0015 * plane.slope; }

// a = g (sin - mu cos) - c A/m; work = mu m g cos times the displacement, plus that of the cohesion.
inline Slide expect_slide(Record& record, const Plane& plane, double friction_angle, double cohesion = 0.0,
                          const std::vector<std::string>& sets = {}) {
  std::vector<std::string> all = rubbing(friction_angle, cohesion);
  all.insert(all.end(), sets.begin(), sets.end());
  const Slide seen = slide(plane, all);
  const double friction = std::tan(friction_angle * degree);
  const double resistance =
      friction * seen.mass * gravity * std::cos(plane.slope * degree) + cohesion * plane.base_area();
  const double acceleration = gravity * std::sin(plane.slope * degree) - resistance / seen.mass;
  record.expect_near("acceleration over exact, " + plane.text(), seen.acceleration / acceleration, 1.0,
                     cohesion > 0.0 ? 0.02 : 2e-3);
  record.expect_near("heat over exact, " + plane.text(), seen.heat / (resistance * seen.displacement), 1.0,
                     cohesion > 0.0 ? 0.02 : 2e-3);
  record.expect_near("heat over work of friction, " + plane.text(), seen.heat / seen.work, 1.0, 1e-12);
  record.expect_near("speed across the fall line [m/s], " + plane.text(), seen.aside, 0.0, 5e-3);
  record.expect_near("area of contact over exact, " + plane.text(), seen.area / plane.base_area(), 1.0,
                     allowed_of_area(plane));
  return seen;
}

inline void expect_rest(Record& record, const Plane& plane, double friction_angle) {
  const Slide seen = slide(plane, rubbing(friction_angle));
  record.expect_near("speed below the friction angle [m/s], " + plane.text(), seen.velocity, 0.0, 2e-3);
  record.expect_near("creep below the friction angle [m], " + plane.text(), seen.displacement, 0.0, 2e-3);
  record.expect_near("area of contact over exact, " + plane.text(), seen.area / plane.base_area(), 1.0,
                     allowed_of_area(plane));
}

inline Record make_record(const std::string& title) {
  return Record(title,
                "An elastic block, 40 m square in the map and 20 m high, on a planar DEM that falls in any direction "
                "to the grid.",
                "a = g (sin - mu cos) - c A/m; heat = work of friction = (mu m g cos + c A) times the path; at rest "
                "below the friction angle. A is the area in the map over the cosine",
                "Coulomb friction with cohesion");
}

}  // namespace plane_on_dem

}  // namespace thawslide::verification
