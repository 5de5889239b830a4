// Ground as heights on a regular grid of points (a DEM), triangulated. Each cell of four points is split into four
// triangles around its centre, whose height is the mean of the four; the surface is therefore invariant under mirroring
// and quarter turns of the points. Beyond the outermost points, the ground continues at the height of the edge. Points
// without data have the height of the nearest point with data, and count as unknown ground.
#pragma once

#include <array>
#include <vector>

#include "base/raster.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

class HeightField final : public Surface<3> {
 public:
  // Elevations [m] at points relative to the domain's lower corner; NaN: no data. At least two points along each axis,
  // and one with data.
  explicit HeightField(Raster points);

  [[nodiscard]] double height(const Point& point) const override;
  // With zero width: gradient of the triangle that contains the place; on an edge, of one of the two.
  [[nodiscard]] Point gradient(const Point& point, double width) const override;
  // Exact to round-off.
  [[nodiscard]] ColumnMeans column_means(const Point& at, double cell) const override;
  [[nodiscard]] double steepest(const Point& from, const Point& to) const override;

  // True within the outermost points if all points of the cells there have data.
  [[nodiscard]] bool is_known(const Point& point) const override;
  [[nodiscard]] bool is_known(const Point& from, const Point& to) const override;

 private:
  // Columns or rows of cells; both ends are included.
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

  // Number of points without data with a smaller column and a smaller row.
  [[nodiscard]] int no_data_before(int column, int row) const;

  Raster points_;                    // without no-data points
  std::vector<int> no_data_before_;  // empty if all points have data
};

}  // namespace thawslide::terrain
