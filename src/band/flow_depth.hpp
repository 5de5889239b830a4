// The thickness of the slide above the ground, and the depth of particles in it.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "band/model.hpp"
#include "base/key_index.hpp"
#include "mpm/particles.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::band {

// H of P_I = rho_I g H [m]: band particles see the thickness of the whole grid column (volume over footprint), others
// their depth below its top; both times slope_cosine(x), the cosine of the terrain's slope there. A particle belongs to
// the columns its box overlaps, by its share in each; the footprint is the cell's, or in a column at the body's edge
// what the boxes cover of it. So thickness does not jump when particles pass from column to column, and the top by the
// rise of one particle at most.
template <int Dim, class Real>
class FlowDepth {
 public:
  // The columns from positions and volumes. slope_cosine may be empty: level ground.
  void update(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
              const std::function<Real(Real)>& slope_cosine, const mpm::Particles<Dim, Real>& particles);
  // particles.flow_depth from the columns and in_band.
  void depth_to_particles(const mpm::SparseGrid<Dim, Real>& grid, mpm::Particles<Dim, Real>& particles) const;

  // Depth of particle p of tile t below the top of its column [m], vertical.
  [[nodiscard]] Real depth_below_top(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                                     std::size_t t, std::uint32_t p) const;

 private:
  struct Column {
    Real volume = 0;
    Real top = 0;
    std::array<Real, Dim - 1> from{}, to{};  // what the boxes cover of it along each horizontal axis
    Real footprint = 0;                      // [m2], per metre of width in 2D
    Real cosine = 1;

    void add(const Column& part);
  };
  // The columns that a tile's particles reach: their cells begin one below the tile's first node.
  static constexpr int columns_per_axis = mpm::Tile<Dim>::edge + 1;
  static constexpr auto columns_per_tile = static_cast<std::size_t>(mpm::power(columns_per_axis, Dim - 1));
  struct TileColumns {
    std::array<Column, columns_per_tile> part;
    std::array<std::int32_t, columns_per_tile> number;
  };

  // Calls visit(place in the tile, share, from, to) for each column that the box of a particle overlaps.
  template <class Visit>
  void for_columns(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles, std::size_t t,
                   std::uint32_t p, const Visit& visit) const;
  // Cell of the tile's columns, from 0, that holds a place [m] along a horizontal axis.
  static int local_cell(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t, std::size_t axis, Real place);
  static std::uint64_t column_key(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t, std::size_t place);
  // Key of the neighbour column `cells` further along a horizontal axis.
  static std::uint64_t neighbour(std::uint64_t key, std::size_t axis, int cells);
  void set_footprints(Real cell);
  void number_columns(const mpm::SparseGrid<Dim, Real>& grid);
  [[nodiscard]] const Column& column(std::size_t t, std::size_t place) const {
    return columns_[static_cast<std::size_t>(tiles_[t].number[place])];
  }

  KeyIndex index_;  // column key -> place in columns_
  std::vector<std::uint64_t> keys_;
  std::vector<Column> columns_;
  std::vector<TileColumns> tiles_;
  std::vector<Real> half_size_;  // of each body's particles [m]
};

}  // namespace thawslide::band
