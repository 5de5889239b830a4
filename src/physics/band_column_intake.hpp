// Intake of a column (band_column.hpp): material that changes cells, or comes from the body and goes back to it, as the
// faces of cells move (docs/theory/band-columns.md).
#pragma once

#include <cmath>

#include "physics/band_column_heat.hpp"

namespace thawslide::physics {

// The largest fraction of a cell's content that leaves it for its neighbours, or the body, as faces move from one grid
// to another while material spreads: `left` is the old area over the new. Up to 1 no cell gives more than it has.
template <class Real>
THAWSLIDE_HD Real largest_share_given(const ColumnGrid<Real>& before, const ColumnGrid<Real>& after, Real left) {
  Real largest = 0, below = 0;  // below: what the cell's lower face sweeps [m]
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
    const Real above = after.face(k + 1) - left * before.face(k + 1);
    const Real given = max(below, Real(0)) + max(-above, Real(0));
    largest = max(largest, given / (left * before.slide_height(k)));
    below = above;
  }
  return largest;
}

// How the faces of a column move in a step.
template <class Real>
struct ColumnChange {
  Real stretch;                        // logarithm of the new area over the old
  Real thickness, next_thickness;      // of the band, before and after [m]
  Real cell_growth, next_cell_growth;  // r

  // After so many of equal parts of the step.
  [[nodiscard]] THAWSLIDE_HD Real thickness_after(int part, int parts) const {
    return thickness + (next_thickness - thickness) * static_cast<Real>(part) / static_cast<Real>(parts);
  }
  [[nodiscard]] THAWSLIDE_HD Real cell_growth_after(int part, int parts) const {
    return cell_growth + (next_cell_growth - cell_growth) * static_cast<Real>(part) / static_cast<Real>(parts);
  }
};

// In how many parts a column takes a change: a piece stretches by at most a tenth in each, and no cell gives more than
// it has. The second matters where cells are thin against their height above the base.
template <class Real, class Curve>
THAWSLIDE_HD int parts_of(const ColumnModel<Real, Curve>& model, const ColumnChange<Real>& change) {
  constexpr Real most_stretch = static_cast<Real>(0.1);
  int parts = static_cast<int>(max(Real(1), std::ceil(std::abs(change.stretch) / most_stretch)));
  while (true) {
    const Real left = std::exp(-change.stretch / static_cast<Real>(parts));
    Real largest = 0;
    THAWSLIDE_ROLLED for (int part = 0; part < parts; ++part) {
      const auto grid_after = [&](int count) {
        return grid_of(model, change.thickness_after(count, parts), change.cell_growth_after(count, parts));
      };
      largest = max(largest, largest_share_given(grid_after(part), grid_after(part + 1), left));
    }
    if (!(largest > Real(1))) {
      return parts;
    }
    parts = static_cast<int>(max(static_cast<Real>(parts + 1), std::ceil(static_cast<Real>(parts) * largest)));
  }
}

// The faces of a column's cells move: with the band's thickness and the ratio of the cells above it, and against
// material that spreads as the piece stretches. The volume that they sweep changes cells; at the top the body gives it,
// or takes it.
template <class Real, class Curve>
THAWSLIDE_HD void take_in(const ColumnModel<Real, Curve>& model, const ColumnGrid<Real>& before,
                          const ColumnGrid<Real>& after, const ColumnDrive<Real>& drive, BandColumn<Real>& column,
                          ColumnAccount<Real>& account) {
  constexpr int count = ColumnCells::slide;
  const Real left = Real(1) / (Real(1) + drive.stretching * drive.dt);        // old area over new
  Real heat[count + 1] = {}, water[count + 1] = {}, thawing[count + 1] = {};  // that go down through each lower face
  THAWSLIDE_ROLLED for (int f = 1; f <= count; ++f) {
    const Real swept = after.face(f) - left * before.face(f);  // [m]
    if (swept > Real(0) && f == count) {
      heat[f] = swept * drive.body_heat;
      water[f] = swept * drive.body_water;
      thawing[f] = swept * column.thawing[count - 1];
    } else {
      const int from = swept > Real(0) ? f : f - 1;
      const Real share = swept / before.slide_height(from);
      heat[f] = share * column.heat[ColumnCells::ground + from];
      water[f] = share * column.water[from];
      thawing[f] = swept * column.thawing[from];
    }
  }
  THAWSLIDE_ROLLED for (int k = 0; k < count; ++k) {
    Real& of_cell = column.heat[ColumnCells::ground + k];
    of_cell = left * of_cell + heat[k + 1] - heat[k];
    column.water[k] = left * column.water[k] + water[k + 1] - water[k];
    column.thawing[k] =
        (left * before.slide_height(k) * column.thawing[k] + thawing[k + 1] - thawing[k]) / after.slide_height(k);
  }
  THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::ground;
                        ++k) {  // the ground that the piece comes to cover is as warm as its own
    account.ground_heat += (Real(1) - left) * column.heat[k];
  }
  column.thickness = drive.thickness;
  column.cell_growth = drive.cell_growth;
  account.body_heat += heat[count];
  account.body_water += water[count];
  temperatures_from_heat(model, after, column);
}

// Brings a column to another ratio of its cells, with what the body gives at the top [J/m3, kg/m3] or gets back.
// Pressures are those of before.
template <class Real, class Curve>
THAWSLIDE_HD ColumnAccount<Real> take_cell_growth(const ColumnModel<Real, Curve>& model, Real cell_growth,
                                                  Real body_heat, Real body_water, BandColumn<Real>& column) {
  ColumnAccount<Real> account;
  if (cell_growth == column.cell_growth) {
    return account;
  }
  const ColumnChange<Real> change{Real(0), column.thickness, column.thickness, column.cell_growth, cell_growth};
  const int parts = parts_of(model, change);
  ColumnDrive<Real> drive{};
  drive.thickness = column.thickness;
  drive.body_heat = body_heat;
  drive.body_water = body_water;
  THAWSLIDE_ROLLED for (int part = 1; part <= parts; ++part) {
    drive.cell_growth = change.cell_growth_after(part, parts);
    take_in(model, grid_of(model, column), grid_of(model, drive.thickness, drive.cell_growth), drive, column, account);
  }
  return account;
}

}  // namespace thawslide::physics
