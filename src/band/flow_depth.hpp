// The thickness of the slide above the ground, and the depth of particles in it.
#pragma once

#include <array>
#include <vector>

#include "band/at_columns.hpp"
#include "band/columns_of_tile.hpp"
#include "band/model.hpp"
#include "mpm/particles.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::band {

// H of P_I = rho_I g H [m]: band particles see the thickness of the whole grid column (volume over footprint), others
// their depth below its top; both times the cosine of the terrain's slope there. A particle belongs to
// the columns its box overlaps, by its share in each; the footprint is the cell's, or in a column at the body's edge
// what the boxes cover of it. So thickness does not jump when particles pass from column to column, and the top by the
// rise of one particle at most.
template <int Dim, class Real>
class FlowDepth {
 public:
  // Of the terrain at a horizontal place [m].
  using SlopeCosine = OfPlace<Dim, Real>;
  // What of gravity presses a column of mass over footprint on its ground at a horizontal place [m/s2]: the part into
  // the ground, g.n, times the slope's cosine, since the ground below is larger than the footprint by that.
  using NormalGravity = OfPlace<Dim, Real>;

  // The columns from positions and volumes. slope_cosine may be empty: level ground; it must be the same in every call.
  void update(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
              const SlopeCosine& slope_cosine, const mpm::Particles<Dim, Real>& particles);
  // particles.flow_depth from the columns and in_band.
  void depth_to_particles(const mpm::SparseGrid<Dim, Real>& grid, mpm::Particles<Dim, Real>& particles) const;

  // particles.normal_load, and in load_change by how much it changed, from the columns of the last update: N of the
  // whole column in the band, elsewhere of what lies above, at the column's mean density. normal_gravity must be the
  // same in every call. Only of the particles that stand in memory from `first` on.
  void load_to_particles(const mpm::SparseGrid<Dim, Real>& grid, const NormalGravity& normal_gravity,
                         mpm::Particles<Dim, Real>& particles, std::size_t first = 0);

  [[nodiscard]] ColumnsOfTile<Dim, Real> of_tile(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t) const;

 private:
  using OfTile = ColumnsOfTile<Dim, Real>;
  static constexpr std::size_t places = columns_per_tile<Dim>;

  struct Column {
    ColumnMass<Real> column_mass;
    Extent<Dim, Real> extent;  // of a column at the body's edge
    bool at_edge = false;
    Real footprint = 0;
    Real cosine = 1;                                         // of the terrain's slope
    Real width = 1;                                          // of the section, relative
    std::array<std::int32_t, column_sides<Dim>> adjacent{};  // the next columns, or KeyIndex::absent
  };
  // What one tile's particles are to the columns they see, by place.
  struct TilePart {
    std::array<ColumnMass<Real>, places> column_mass;
    std::array<Extent<Dim, Real>, places> extent;  // where one of the columns is at the edge
    std::array<std::int32_t, places> number;
  };

  void number_columns(const mpm::SparseGrid<Dim, Real>& grid, const mpm::SectionWidth<Real>& width,
                      const SlopeCosine& slope_cosine);
  void add_tile(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles, std::size_t t);
  void add_extents(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles, std::size_t t);
  void sum_columns();
  void find_edge();
  void set_footprints(Real cell);
  void sum_masses(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles);
  // Whether the slide stands in a column that may be absent.
  [[nodiscard]] bool is_filled(std::int32_t column) const {
    return column != KeyIndex::absent && columns_[static_cast<std::size_t>(column)].column_mass.is_present();
  }

  std::vector<std::uint64_t> numbered_;  // the tiles that columns, their numbers and sizes_ are of
  KeyIndex column_index_;
  std::vector<std::uint64_t> column_keys_;
  AtColumns<Dim, Real> cosines_, normal_gravities_;
  std::vector<Column> columns_;
  std::vector<TilePart> tiles_;
  std::vector<std::size_t> edge_tiles_;
  mpm::BodySizes<Real> sizes_;  // of particles [m]
  // Where the load is asked for: the mass of tiles' columns by place and of columns [kg], and their load per depth
  // [Pa/m].
  std::vector<std::array<Real, places>> tile_masses_;
  std::vector<Real> masses_, load_per_depth_;
};

}  // namespace thawslide::band
