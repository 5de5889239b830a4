// Collapse of a cylindrical granular column in a section of width b = x. Its equations are those of axial symmetry
// (docs/theory/width.md).
#pragma once

#include "cylinder_column.hpp"

namespace thawslide::verification::cylinder_column {

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
