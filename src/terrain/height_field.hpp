// The ground as heights on a regular grid of points (a DEM), triangulated: each cell of four points is four
// triangles about its centre, whose height is the mean of the four, so that mirror images and quarter turns of the
// points give mirrored and turned ground. Beyond the outermost points the ground goes on with the height of the edge.
// Points without data take the height of the nearest point that has one, and the ground is not known there.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/raster.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

class HeightField final : public Surface<3> {
 public:
  // Distances are exact up to this many cells of the grid.
  static constexpr double reach_in_cells = 4.0;

  // Elevations [m] at points relative to the domain's lower corner; NaN: no data. At least two points each way, and one
  // of them with data.
  explicit HeightField(Raster points);

  [[nodiscard]] double height(const Place& place) const override;
  // Over a width of zero, that of the triangle that holds the place; on an edge, of one of the two.
  [[nodiscard]] Place gradient(const Place& place, double width) const override;
  [[nodiscard]] double highest(const Place& from, const Place& to) const override;

  // Area and space are exact to round-off. The normal is along the integral of S n dA where a node has area, otherwise
  // along the line to the nearest point of the surface. Where the surface is more than `reach_in_cells` away, the
  // distance is that reach, with its sign, and the normal that of the ground straight below (or above).
  void at_block(const NodeIndex& first, double cell, int edge, GroundAtNode<3, double>* nodes) const override;
  // The same for nodes of which the first is anywhere, at `lowest`.
  void at_nodes_from(const Vector<double, 3>& lowest, double cell, int edge, GroundAtNode<3, double>* nodes) const;

  // Within the outermost points, and all points of the cells there have data.
  [[nodiscard]] bool is_known(const Place& place) const override;
  [[nodiscard]] bool is_known(const Place& from, const Place& to) const override;

  // The point of the surface nearest to a position, if there is one nearer than `reach` [m].
  [[nodiscard]] std::optional<Vector<double, 3>> nearest(const Vector<double, 3>& position, double reach) const;

 private:
  // What the points of a rectangle tell.
  struct Summary {
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    bool known = true;  // all have data

    void add(const Summary& other);
  };
  // Columns or rows of cells, or of points; both ends are included.
  struct Span {
    int first, last;
  };
  // A cell of the DEM: its points from the south-west counter-clockwise, and its centre.
  struct Cell {
    std::array<Vector<double, 3>, 4> point;
    Vector<double, 3> centre;

    // South, east, north and west of the centre, counter-clockwise.
    [[nodiscard]] std::array<Vector<double, 3>, 3> triangle(std::size_t k) const {
      return {point[k], point[(k + 1) % 4], centre};
    }
    [[nodiscard]] std::size_t triangle_at(const Place& place) const;
    [[nodiscard]] Place gradient(std::size_t triangle) const;
  };

  // Columns -1 and columns - 1, and rows likewise, are the cells beyond the outermost points.
  [[nodiscard]] Span cell_columns(double from, double to) const;
  [[nodiscard]] Span cell_rows(double from, double to) const;
  [[nodiscard]] double height_at(int column, int row) const;  // that of the nearest point where there is none
  // Cells beyond the outermost points reach as far as the rectangle.
  [[nodiscard]] Cell cell(int column, int row, const Place& from, const Place& to) const;
  [[nodiscard]] Cell cell_at(const Place& place) const;
  template <class Visit>
  void for_triangles(const Place& from, const Place& to, const Visit& visit) const;

  [[nodiscard]] Summary summary_of_points(Span columns, Span rows) const;
  [[nodiscard]] Summary summary_one_by_one(Span columns, Span rows) const;
  // Of the points of all cells that overlap a rectangle.
  [[nodiscard]] Summary summary(const Place& from, const Place& to) const;
  void summarise_blocks();

  // Of the box that holds a cell of the DEM: no point of its ground is nearer to the position [m2].
  [[nodiscard]] double squared_distance_of_cell(const Vector<double, 3>& position, int column, int row) const;
  void set_distances(const Vector<double, 3>& lowest, double cell, int edge, GroundAtNode<3, double>* nodes) const;

  Raster points_;                       // without holes
  std::vector<bool> no_data_;           // by point; empty if all have data
  std::vector<Summary> block_summary_;  // by blocks of points
};

}  // namespace thawslide::terrain
