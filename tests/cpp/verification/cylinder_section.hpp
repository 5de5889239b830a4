// Collapse of a cylindrical granular column in a section of width b = x. Its equations are those of axial symmetry
// (docs/theory/width.md).
#pragma once

#include "cylinder_column.hpp"

namespace thawslide::verification::cylinder_column {

inline const std::string section = dry_sand(1e7) + R"(
[case]
dimension = 2
width = { x = [0.0, 50.0], value = [0.02, 50.02] }
[time]
end = 5.0
step = 0.0035
[grid]
cell = 0.625
min = [0.0, -2.5]
max = [50.0, 20.0]
[grid.boundary]
x_min = "roller"
[terrain]
type = "flat"
elevation = 0.0
[body.column]
material = "sand"
min = [0.0, 0.0]
max = [10.0, 10.0]
)";

// (r - r_0)/r_0 of a column of aspect ratio 1 after 5 s, with r the radius that contains 99.5 % of the mass.
inline double runout_of_section(int cells, const std::string& transfer) {  // across the radius
  const double cell = radius / cells;
  sim::Simulation<2> simulation(
      paper_case(section, {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 0.0056 * cell),
                           "mechanics.transfer=" + transfer}));
  run_until(simulation, 5.0);
  const auto& particles = simulation.particles();
  std::vector<sim::MassOnPath> by_radius;
  double mass = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    by_radius.push_back({particles.position(p, 0), particles.mass(p), p});
    mass += particles.mass(p);
  }
  return sim::front_of(by_radius, mass).along / radius - 1.0;
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
    curve.x.push_back(cells[k]);
    curve.computed.push_back(found);
    curve.exact.push_back(runout_of_lube(1.0));
  }
  EXPECT_TRUE(std::is_sorted(curve.computed.begin(), curve.computed.end()));
  record.draw(curve);
}

}  // namespace thawslide::verification::cylinder_column
