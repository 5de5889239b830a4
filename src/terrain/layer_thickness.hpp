// Thickness of the cells along the ground that form the band: one cell on level ground along a grid line, 1.5 to 2.3
// cells if a slope cuts through them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/key_index.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

// Computes columns of cells on demand and caches them: serial calls only.
template <int Dim>
class LayerThickness {
 public:
  using Point = typename Surface<Dim>::Point;
  using Number = std::array<long, Dim - 1>;  // of a column of cells, along each horizontal axis

  // Initial arrangement of particles in the cells. lattice: at the centres of equal parts of the cells, `spacing` [m]
  // apart, if above the ground. on_ground: in columns on the ground.
  enum class Filling { lattice, on_ground };

  LayerThickness(std::shared_ptr<const Surface<Dim>> ground, double cell, double spacing, Filling filling);

  // Volume of the particles in the band cells (those with a candidate corner, see GroundAtNode) per ground surface [m],
  // averaged over adjacent columns of cells with linearly decreasing weights. Without averaging, it would jump between
  // columns, and with it the heat of particles that move through them.
  [[nodiscard]] double at(const Point& point);
  // The same at the middle of a column.
  [[nodiscard]] double at_middle(const Number& number);
  // Maximum over the middles of the columns in a rectangle [m].
  [[nodiscard]] double largest(const Point& from, const Point& to);

 private:
  // One column of cells: particle volume in its band cells, and area of its ground [m2, m in 2D; m3, m2 in 3D].
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
