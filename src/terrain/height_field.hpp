// Ground as heights on a regular grid of points (a DEM), triangulated. Each cell of four points is split into four
// triangles around its centre, whose height is the mean of the four; the surface is therefore invariant under mirroring
// and quarter turns of the points. Beyond the outermost points, the ground continues at the height of the edge. Points
// without data have the height of the nearest point with data, and count as unknown ground.
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
  // Distances are exact up to this number of grid cells.
  static constexpr double reach_in_cells = 4.0;

  // Elevations [m] at points relative to the domain's lower corner; NaN: no data. At least two points along each axis,
  // and one with data.
  explicit HeightField(Raster points);

  [[nodiscard]] double height(const Point& point) const override;
  // With zero width: gradient of the triangle that contains the place; on an edge, of one of the two.
  [[nodiscard]] Point gradient(const Point& point, double width) const override;
  // Exact to round-off.
  [[nodiscard]] ColumnMeans column_means(const Point& at, double cell) const override;
  [[nodiscard]] double highest(const Point& from, const Point& to) const override;
  [[nodiscard]] double steepest(const Point& from, const Point& to) const override;

  // Area and space are exact to round-off. The normal is along the integral of S n dA if the node has area, otherwise
  // towards the nearest point of the surface. If the surface is further than `reach_in_cells`, the distance is that
  // limit, with its sign, and the normal is that of the ground vertically below or above.
  void at_block(const NodeIndex& first, double cell, int edge, GroundAtNode<3>* nodes) const override;
  // The same for nodes at any position. lowest: position of the first node.
  void at_nodes_from(const Vector<double, 3>& lowest, double cell, int edge, GroundAtNode<3>* nodes) const;

  // True within the outermost points if all points of the cells there have data.
  [[nodiscard]] bool is_known(const Point& point) const override;
  [[nodiscard]] bool is_known(const Point& from, const Point& to) const override;

  // Point of the surface nearest to a position, if nearer than `reach` [m].
  [[nodiscard]] std::optional<Vector<double, 3>> nearest(const Vector<double, 3>& position, double reach) const;

 private:
  // Summary of the points of a rectangle.
  struct Summary {
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    bool known = true;  // all have data

    void add(const Summary& other);
  };
  // Columns or rows of cells, or of points; both ends are included.
  struct Span {
    int first, last;
  };
  // Cell of the DEM: its points from the south-west counter-clockwise, and its centre.
  struct Cell {
    std::array<Vector<double, 3>, 4> point;
    Vector<double, 3> centre;

    // South, east, north and west of the centre, counter-clockwise.
    [[nodiscard]] std::array<Vector<double, 3>, 3> triangle(std::size_t k) const {
      return {point[k], point[(k + 1) % 4], centre};
    }
    [[nodiscard]] std::size_t triangle_at(const Point& position) const;
    [[nodiscard]] Point gradient(std::size_t triangle) const;
  };

  // Columns -1 and columns - 1, and the corresponding rows, are the cells beyond the outermost points.
  [[nodiscard]] Span cell_columns(double from, double to) const;
  [[nodiscard]] Span cell_rows(double from, double to) const;
  [[nodiscard]] double height_at(int column, int row) const;  // of the nearest point for places outside the DEM
  // Cells beyond the outermost points extend to the sides of the rectangle.
  [[nodiscard]] Cell cell(int column, int row, const Point& from, const Point& to) const;
  [[nodiscard]] Cell cell_at(const Point& point) const;
  template <class Visit>
  void for_triangles(const Point& from, const Point& to, const Visit& visit) const;

  [[nodiscard]] Summary summary_of_points(Span columns, Span rows) const;
  [[nodiscard]] Summary summary_one_by_one(Span columns, Span rows) const;
  // Summary of the points of all cells that overlap a rectangle.
  [[nodiscard]] Summary summary(const Point& from, const Point& to) const;
  void summarize_blocks();

  // Squared distance [m2] to the bounding box of a cell of the DEM: a lower bound of that to its ground.
  [[nodiscard]] double squared_distance_of_cell(const Vector<double, 3>& position, int column, int row) const;
  void set_distances(const Vector<double, 3>& lowest, double cell, int edge, GroundAtNode<3>* nodes) const;

  Raster points_;                       // without no-data points
  std::vector<bool> no_data_;           // by point; empty if all have data
  std::vector<Summary> block_summary_;  // by blocks of points
};

}  // namespace thawslide::terrain
