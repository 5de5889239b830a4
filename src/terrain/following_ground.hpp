// Ground of a background grid whose cells follow it (mpm/mapping.hpp). The terrain as it is gives each column of nodes
// two means over its hat function S_i: the height b_i, and the area of the ground per horizontal area. The ground that
// particles meet is B = sum S_i b_i. With b interpolated linearly between columns, and the slope grad b,
//   G_i = integral of S_i (grad b, -1) dx dy,   n_i = G_i/|G_i|,
//   chi_i = integral of S_i dA over the terrain / |G_i|,
// where chi counts only bends that b resolves. All are computed when the sliding mass arrives, except about slopes
// above a limit s: there, columns are lowered at the start to
//   b_i = min over j of (mean height of column j + s |x_i - x_j|).
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "mpm/body_sizes.hpp"
#include "mpm/particles.hpp"
#include "mpm/section_width.hpp"
#include "terrain/column_heights.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

template <int Dim>
class FollowingGround final : public Surface<Dim> {
 public:
  using Point = typename Surface<Dim>::Point;
  using NodeIndex = std::array<int, Dim>;
  using ColumnMeans = typename Surface<Dim>::ColumnMeans;

  // terrain: the ground as it is. extent: of the domain [m]; beyond it, columns have the height of the nearest one.
  // sizes: half sizes of particles by body, in cells; those of the first body define height() and gradient().
  // steepest: limit of the gradient between columns.
  FollowingGround(std::shared_ptr<const Surface<Dim>> terrain, double cell, const Point& extent,
                  const mpm::BodySizes& sizes, mpm::SectionWidth width, double steepest);
  ~FollowingGround() override;

  // B below particles of a body.
  [[nodiscard]] double height(const Point& point, std::size_t body) const {
    return below(point, sizes_.half(body)).height;
  }
  // B and its gradient. Over more than a cell, the gradient is that of the terrain.
  [[nodiscard]] double height(const Point& point) const override;
  [[nodiscard]] Point gradient(const Point& point, double width) const override;
  [[nodiscard]] double steepest(const Point& from, const Point& to) const override {
    return terrain_->steepest(from, to);
  }
  [[nodiscard]] bool is_known(const Point& point) const override { return terrain_->is_known(point); }
  [[nodiscard]] bool is_known(const Point& from, const Point& to) const override {
    return terrain_->is_known(from, to);
  }
  [[nodiscard]] ColumnMeans column_means(const Point& at, double cell) const override {
    return terrain_->column_means(at, cell);
  }

  // The ground as it is.
  [[nodiscard]] const Surface<Dim>& terrain() const { return *terrain_; }

  // Columns of the domain on known ground that the limit of slopes has lowered.
  struct Lowering {
    std::size_t columns = 0;
    double largest = 0.0;         // change of height [m]
    Point place = Point::Zero();  // of that column
  };
  [[nodiscard]] const Lowering& lowering() const { return lowering_; }

  // Fills the ground data of the `edge`^Dim nodes of a block, x fastest. first: index of its first node along each
  // axis.
  void at_block(const NodeIndex& first, int edge, GroundAtNode<Dim>* nodes) const;

  // Sets the height above the ground and the slopes of the ground of all particles, from their positions.
  void locate(mpm::Particles<Dim>& particles) const;

  // Height of a column of nodes [m], for GroundAnywhere.
  struct HeightOfColumn {
    const FollowingGround* ground;
    double operator()(const typename ColumnChunks<Dim>::Column& column) const { return ground->column_height(column); }
  };
  // The ground of height() and gradient().
  [[nodiscard]] GroundAnywhere<Dim, HeightOfColumn> anywhere() const {
    return {columns_, {this}, sizes_.half(0), cell_, width_.view()};
  }

  // Heights of all columns of nodes, by chunk and column, for solvers on a device.
  [[nodiscard]] const ColumnChunks<Dim>& columns() const { return columns_; }
  [[nodiscard]] std::vector<double> column_heights() const;

 private:
  using Column = typename ColumnChunks<Dim>::Column;
  // Bend and direction of the ground of a column as far as the heights of columns resolve it.
  struct Resolved {
    Point slope;       // mean by the hat function
    double area;       // mean area per horizontal area
    double resultant;  // |G| per horizontal area
    double middle;     // mean height
    [[nodiscard]] double bend() const { return area / resultant; }
  };

  // Means over the hat functions of a chunk's columns, x fastest.
  struct Chunk {
    std::array<double, static_cast<std::size_t>(ColumnChunks<Dim>::size)> height, area;  // [m], per horizontal area
  };

  [[nodiscard]] double& column_height(const Column& column) const;
  [[nodiscard]] Column first_of_chunk(std::size_t chunk) const;
  [[nodiscard]] Point place_of(const Column& column) const;
  [[nodiscard]] std::vector<std::size_t> chunks_steeper_than(double steepest) const;
  void limit_slopes(double steepest);
  [[nodiscard]] GroundBelow<Dim> below(const Point& point, double half) const;
  [[nodiscard]] Resolved resolved(const Column& column) const;
  [[nodiscard]] double largest_bend_about(const Column& column) const;
  [[nodiscard]] Chunk& means_of_chunk(std::size_t chunk) const;

  std::shared_ptr<const Surface<Dim>> terrain_;
  double cell_;
  mpm::BodySizes sizes_;
  mpm::SectionWidth width_;
  ColumnChunks<Dim> columns_;
  Lowering lowering_;
  mutable std::vector<std::atomic<Chunk*>> made_;  // null: not yet computed
};

}  // namespace thawslide::terrain
