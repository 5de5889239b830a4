// Collapse of cylindrical granular columns on a flat DEM, and in a section.
#pragma once

#include "../support/slide_on_dem.hpp"
#include "verification.hpp"

namespace thawslide::verification::cylinder_column {

inline constexpr double radius = 10.0;  // of the column [m]

inline const Sets column{"grid.boundary.x_min=roller; grid.boundary.y_min=roller; grid.min=[0,0,-2.5]",
                         "grid.max=[50,50,30]; material.debris.youngs_modulus=1e7",
                         "material.debris.friction_angle=36.93; basal.friction_angle=31"};

// (r_inf - r_0)/r_0 of experiments with dry sand and other grains: Lube, Huppert, Sparks and Hallworth 2004,
// Axisymmetric collapses of granular columns, J. Fluid Mech. 508, 175-199.
inline double runout_of_lube(double aspect) { return aspect < 1.7 ? 1.24 * aspect : 1.6 * std::sqrt(aspect); }

// (r_inf - r_0)/r_0, with r_inf the radius that contains 99.5 % of the mass.
template <int Dim>
double runout(const Simulation<Dim>& simulation) {
  const auto& particles = simulation.particles();
  std::vector<MassOnPath> by_radius;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vector<double, Dim> at = particles.position.template get<Vector<double, Dim>>(p) + simulation.model().origin;
    by_radius.push_back({at.template head<Dim - 1>().norm(), particles.mass(p)});
  }
  return front_of(by_radius) / radius - 1.0;
}

// Final runout of a quarter of the column, between smooth walls. aspect: height over radius; cell [m].
inline double collapse(double aspect, double cell = 0.625, const std::string& transfer = "flip") {
  const double end = aspect < 1.0 ? 4.0 : 5.0 * std::sqrt(aspect);
  // Points so close that no column of particles is beyond the walls.
  const Raster thickness =
      thickness_between(Place::Zero(), Place::Constant(radius + 1.0), 0.01,
                        [&](double x, double y) { return std::hypot(x, y) < radius ? aspect * radius : 0.0; });
  const Raster ground =
      raster_between(Place::Constant(-20.0), Place::Constant(60.0), 10.0, [](double, double) { return 0.0; });
  Simulation<3> simulation(
      case_on_dem(base_text("release"),
                  column + Sets(fmt::format("time.end={}; grid.cell={}; time.step={}; mechanics.transfer={}", end, cell,
                                            0.0056 * cell, transfer))),
      site_of(ground, thickness));
  run_until(simulation, 0.8 * end);
  const double before = runout(simulation);
  run_until(simulation, end);
  const double last = runout(simulation);
  EXPECT_NEAR(last, before, 0.02 * last) << "the front has come to rest";
  return last;
}

inline void expect_runout(Record& record, double aspect) {
  const double expected = runout_of_lube(aspect);
  record.expect_near(fmt::format("runout over radius, aspect ratio {}", aspect), collapse(aspect), expected,
                     0.2 * expected);
}

inline Record make_record(const std::string& title) {
  return Record(
      title,
      "Columns of sand, 10 m in radius and of aspect ratio 0.5 to 2, collapse on a flat DEM. The friction angle is 31 "
      "degrees along the ground and 36.9 inside, as for the columns in two dimensions. The runout is that of the "
      "radius within which 99.5 % of the mass lies, which for a cone is 4 % less than its own. The front "
      "is thinner than a cell, which shortens the runout: docs/laboratory.md shows how it approaches the experiments "
      "on finer cells.",
      "runout over radius 1.24 a, above a = 1.7 1.6 a^(1/2)", "fits to experiments, Lube et al. 2004");
}

// The same in a section of width b = x. Its equations are those of axial symmetry (docs/theory/width.md).
// (r - r_0)/r_0 of a column of aspect ratio 1 after 5 s, with r the radius that contains 99.5 % of the mass.
inline double runout_of_section(int cells, const std::string& transfer) {  // across the radius
  const double cell = radius / cells;
  const Sets section{"case.width={ x = [0.0, 50.0], value = [0.02, 50.02] }; time.end=5; grid.max=[50,20]",
                     "material.sand.youngs_modulus=1e7",
                     fmt::format("grid.cell={}; time.step={}; mechanics.transfer={}", cell, 0.0056 * cell, transfer)};
  Simulation<2> simulation(published_case("sand", section));
  run_until(simulation, 5.0);
  return runout(simulation);
}

inline Record make_section_record(const std::string& title) {
  return Record(title,
                "A column of sand of aspect ratio 1 in a section whose width is the distance from the axis (APIC). The "
                "outer part of the deposit is thinner than a cell and does not spread as it should: on finer cells the "
                "runout approaches that of the experiments.",
                "runout over radius 1.24 a", "fit to experiments, Lube et al. 2004");
}

// Compares runouts with the experiments, for numbers of cells across the radius and an allowed deviation for each.
inline void expect_approach(Record& record, const std::vector<int>& cells, const std::vector<double>& allowed) {
  Curve curve{"cells across the radius", "runout over radius", {}, {}, {}, "fit to experiments"};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double found = runout_of_section(cells[k], "apic");
    record.expect_near(fmt::format("runout over radius, {} cells across it", cells[k]), found, runout_of_lube(1.0),
                       allowed[k]);
    add_point(curve, cells[k], found, runout_of_lube(1.0));
  }
  EXPECT_TRUE(std::is_sorted(curve.computed.begin(), curve.computed.end()));
  record.draw(curve);
}

}  // namespace thawslide::verification::cylinder_column
