// Advection between the cells of a column (band_column.hpp), and exchange with the body, as cell faces move
// (docs/theory/band-columns.md).
#pragma once

#include <cmath>

#include "physics/band_column_heat.hpp"

namespace thawslide::physics {

// Largest fraction of a cell's content that moves to its neighbours or the body when faces move from one grid to
// another while material spreads. left: old area over new area. Up to 1, no cell loses more than its content.
inline THAWSLIDE_HD double largest_fraction_given(const ColumnGrid& before, const ColumnGrid& after, double left) {
  double largest = 0, below = 0;  // below: height swept by the cell's lower face [m]
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    const double above = after.face(k + 1) - left * before.face(k + 1);
    const double given = max(below, 0.0) + max(-above, 0.0);
    largest = max(largest, given / (left * before.slide_height(k)));
    below = above;
  }
  return largest;
}

// Motion of a column's faces in a step.
struct ColumnChange {
  double stretch;                        // logarithm of new area over old area
  double thickness, next_thickness;      // of the band, before and after [m]
  double cell_growth, next_cell_growth;  // r

  // After `part` of `parts` equal parts of the step.
  [[nodiscard]] THAWSLIDE_HD double thickness_after(int part, int parts) const {
    return thickness + (next_thickness - thickness) * static_cast<double>(part) / static_cast<double>(parts);
  }
  [[nodiscard]] THAWSLIDE_HD double cell_growth_after(int part, int parts) const {
    return cell_growth + (next_cell_growth - cell_growth) * static_cast<double>(part) / static_cast<double>(parts);
  }
};

// Number of substeps of a change: in each, a segment stretches by at most a tenth, and no cell loses more than its
// content. The second condition applies if cells are thin compared with their height above the base.
template <class Curve>
THAWSLIDE_HD int parts_of(const ColumnModel<Curve>& model, const ColumnChange& change) {
  constexpr double most_stretch = 0.1;
  int parts = static_cast<int>(max(1.0, std::ceil(std::abs(change.stretch) / most_stretch)));
  while (true) {
    const double left = std::exp(-change.stretch / static_cast<double>(parts));
    double largest = 0;
    THAWSLIDE_ROLLED for (int part = 0; part < parts; ++part) {
      const auto grid_after = [&](int count) {
        return grid_of(model, change.thickness_after(count, parts), change.cell_growth_after(count, parts));
      };
      largest = max(largest, largest_fraction_given(grid_after(part), grid_after(part + 1), left));
    }
    if (!(largest > 1.0)) {
      return parts;
    }
    parts = static_cast<int>(max(static_cast<double>(parts + 1), std::ceil(static_cast<double>(parts) * largest)));
  }
}

// Moves the faces of a column's cells, by changes of band thickness and cell growth and by the spreading of a
// stretching segment. The swept volume moves between cells; at the top, it is exchanged with the body.
template <class Curve>
THAWSLIDE_HD void mix_in_surroundings(const ColumnModel<Curve>& model, const ColumnGrid& before,
                                      const ColumnGrid& after, const ColumnDrive& drive, BandColumn& column,
                                      ColumnBudget& budget) {
  constexpr int count = ColumnCells::slide;
  const double left = 1.0 / (1.0 + drive.stretching * drive.dt);                // old area over new area
  double heat[count + 1] = {}, water[count + 1] = {}, thawing[count + 1] = {};  // downward through each lower face
  THAWSLIDE_ROLLED for (int f = 1; f <= count; ++f) {
    const double swept = after.face(f) - left * before.face(f);  // [m]
    if (swept > 0.0 && f == count) {
      heat[f] = swept * drive.body_heat;
      water[f] = swept * drive.body_water;
      thawing[f] = swept * column.thawing[count - 1];
    } else {
      const int from = swept > 0.0 ? f : f - 1;
      const double fraction = swept / before.slide_height(from);
      heat[f] = fraction * column.heat[ColumnCells::ground + from];
      water[f] = fraction * column.water[from];
      thawing[f] = swept * column.thawing[from];
    }
  }
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
    double& of_cell = column.heat[ColumnCells::ground + k];
    of_cell = left * of_cell + heat[k + 1] - heat[k];
    column.water[k] = left * column.water[k] + water[k + 1] - water[k];
    column.thawing[k] =
        (left * before.slide_height(k) * column.thawing[k] + thawing[k + 1] - thawing[k]) / after.slide_height(k);
  }
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::ground;
                        ++k) {  // newly covered ground has the temperature of the segment's ground
    budget.ground_heat += (1.0 - left) * column.heat[k];
  }
  column.thickness = drive.thickness;
  column.cell_growth = drive.cell_growth;
  budget.body_heat += heat[count];
  budget.body_water += water[count];
  temperatures_from_heat(model, after, column);
}

// Changes the cell growth of a column, with exchange with the body at the top [J/m3, kg/m3]. Pressures are not updated.
template <class Curve>
THAWSLIDE_HD ColumnBudget apply_cell_growth(const ColumnModel<Curve>& model, double cell_growth, double body_heat,
                                            double body_water, BandColumn& column) {
  ColumnBudget budget;
  if (cell_growth == column.cell_growth) {
    return budget;
  }
  const ColumnChange change{0.0, column.thickness, column.thickness, column.cell_growth, cell_growth};
  const int parts = parts_of(model, change);
  ColumnDrive drive{};
  drive.thickness = column.thickness;
  drive.body_heat = body_heat;
  drive.body_water = body_water;
  THAWSLIDE_ROLLED for (int part = 1; part <= parts; ++part) {
    drive.cell_growth = change.cell_growth_after(part, parts);
    mix_in_surroundings(model, grid_of(model, column), grid_of(model, drive.thickness, drive.cell_growth), drive,
                        column, budget);
  }
  return budget;
}

}  // namespace thawslide::physics
