// How thick the cells along the ground are which make up the band: one cell on level ground along a grid line, 1.5 to
// 2.3 cells where a slope cuts through them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/key_index.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

// Works out columns of cells where it is asked for and remembers them, so calls may not run side by side.
template <int Dim>
class LayerThickness {
 public:
  using Place = typename Surface<Dim>::Place;
  using Number = std::array<long, Dim - 1>;  // of a column of cells, along each horizontal axis

  // How particles fill the cells at the start: at the centres of the cells' equal parts, `spacing` [m] apart, where
  // these lie above the ground; or in columns that stand on the ground.
  enum class Filling { lattice, on_ground };

  LayerThickness(std::shared_ptr<const Surface<Dim>> ground, double cell, double spacing, Filling filling);

  // Volume of the particles in the band cells (those with a candidate corner, see GroundAtNode) over the ground's
  // surface [m], both averaged over some columns of cells about the place with weights that fall off linearly: without
  // that it would jump from column to column, and with it the heat of particles that slide through them.
  [[nodiscard]] double at(const Place& place);
  // The same at the middle of a column.
  [[nodiscard]] double at_middle(const Number& number);
  // The largest of it at the middles of the columns over a rectangle [m].
  [[nodiscard]] double largest(const Place& from, const Place& to);

 private:
  // Of one column of cells: what particles fill of its band cells, and its ground [m, m2 in 2D; m3, m2 in 3D].
  struct Column {
    double filled, ground;
  };

  [[nodiscard]] Column make_column(const Number& number) const;
  [[nodiscard]] Column column(const Number& number);

  std::shared_ptr<const Surface<Dim>> ground_;
  double cell_, spacing_;
  Filling filling_;
  KeyIndex column_index_, middle_index_;
  std::vector<Column> columns_;
  std::vector<double> at_middle_;
};

}  // namespace thawslide::terrain
