// Thickness of the sliding mass above the ground, and depth of particles in it.
#pragma once

#include <array>
#include <vector>

#include "band/at_columns.hpp"
#include "band/columns_of_tile.hpp"
#include "band/model.hpp"
#include "mpm/particles.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::band {

// H of P_I = rho_I g H [m]. Band particles use the thickness of the whole grid column (volume over footprint), others
// their depth below its top; both are multiplied by the cosine of the terrain slope. A particle contributes to the
// columns that its box overlaps, by its fraction in each. The footprint is that of the cell, or, in a column at the
// edge of the body, the extent of the boxes in it. Thickness is therefore continuous when particles move between
// columns; the top jumps by at most the rise of one particle.
template <int Dim>
class FlowDepth {
 public:
  // Slope cosine of the terrain at a horizontal position [m].
  using SlopeCosine = OfPosition<Dim>;
  // Gravity component that loads the ground per mass and footprint, at a horizontal position [m/s2]: g.n times the
  // slope cosine, because the ground area exceeds the footprint by its inverse.
  using NormalGravity = OfPosition<Dim>;

  // Updates the columns from positions and volumes. slope_cosine may be empty (level ground) and must be the same in
  // every call.
  void update(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, const SlopeCosine& slope_cosine,
              const mpm::Particles<Dim>& particles);
  // Sets particles.flow_depth from the columns and in_band.
  void depth_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles) const;

  // Sets particles.normal_load and its change load_change from the columns of the last update, for particles at memory
  // index `first` and above. N is that of the whole column in the band, elsewhere that of the material above, at the
  // column's mean density. normal_gravity must be the same in every call.
  void load_to_particles(const mpm::SparseGrid<Dim>& grid, const NormalGravity& normal_gravity,
                         mpm::Particles<Dim>& particles, std::size_t first = 0);

  [[nodiscard]] ColumnsOfTile<Dim> of_tile(const mpm::SparseGrid<Dim>& grid, std::size_t t) const;

 private:
  using OfTile = ColumnsOfTile<Dim>;
  static constexpr std::size_t indices = columns_per_tile<Dim>;

  struct Column {
    ColumnMass column_mass;
    Extent<Dim> extent;  // of a column at the edge of the body
    bool at_edge = false;
    double footprint = 0;
    double cosine = 1;                                       // of the terrain slope
    double width = 1;                                        // of the section, relative
    std::array<std::int32_t, column_sides<Dim>> adjacent{};  // adjacent columns, or KeyIndex::absent
  };
  // Contribution of one tile's particles to the columns in reach, by place.
  struct TilePart {
    std::array<ColumnMass, indices> column_mass;
    std::array<Extent<Dim>, indices> extent;  // if one of the columns is at the edge
    std::array<std::int32_t, indices> number;
  };

  void number_columns(const mpm::SparseGrid<Dim>& grid, const mpm::SectionWidth& width,
                      const SlopeCosine& slope_cosine);
  void add_tile(const mpm::SparseGrid<Dim>& grid, const mpm::Particles<Dim>& particles, std::size_t t);
  void add_extents(const mpm::SparseGrid<Dim>& grid, const mpm::Particles<Dim>& particles, std::size_t t);
  void sum_columns();
  void find_edge();
  void set_footprints(double cell);
  void sum_masses(const mpm::SparseGrid<Dim>& grid, const mpm::Particles<Dim>& particles);
  // True if the column exists and contains part of the sliding mass.
  [[nodiscard]] bool is_filled(std::int32_t column) const {
    return column != KeyIndex::absent && columns_[static_cast<std::size_t>(column)].column_mass.is_present();
  }

  std::vector<std::uint64_t> numbered_;  // tiles for which columns, their numbers and sizes_ are valid
  KeyIndex column_index_;
  std::vector<std::uint64_t> column_keys_;
  AtColumns<Dim> cosines_, normal_gravities_;
  std::vector<Column> columns_;
  std::vector<TilePart> tiles_;
  std::vector<std::size_t> edge_tiles_;
  mpm::BodySizes sizes_;  // half sizes of particles [m]
  // If loads are required: mass of each tile's columns by place, and of columns [kg]; load per depth [Pa/m].
  std::vector<std::array<double, indices>> tile_masses_;
  std::vector<double> masses_, load_per_depth_;
};

}  // namespace thawslide::band
