// Thickness of the sliding mass above the ground, and depth of particles in it, on the CPU.
#pragma once

#include <optional>
#include <vector>

#include "band/model.hpp"
#include "band/slide_columns.hpp"
#include "exec/cpu.hpp"
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
  using Columns = ColumnsByTile<Dim, NumbersOfTile<Dim>>;

  FlowDepth() = default;
  FlowDepth(const FlowDepth&) = delete;
  FlowDepth& operator=(const FlowDepth&) = delete;

  // Updates the columns from positions and volumes. slope_cosine, normal_gravity: as in SlideColumns; the same in every
  // call.
  void update(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, const OfPosition<Dim>& slope_cosine,
              const OfPosition<Dim>& normal_gravity, const mpm::Particles<Dim>& particles);
  // Sets particles.flow_depth from the columns and in_band.
  void depth_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles) const;

  // Sets particles.normal_load and its change load_change from the columns of the last update, for particles at memory
  // index `first` and above. N is that of the whole column in the band, elsewhere that of the material above, at the
  // column's mean density.
  void load_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles, std::size_t first = 0) const;

  [[nodiscard]] Columns by_tile() const { return sums_->template by_tile<NumbersOfTile<Dim>>(tile_keys_.data()); }

 private:
  exec::Cpu cpu_;
  mpm::BodySizes sizes_;                              // half sizes of particles [m]
  std::optional<SlideColumns<exec::Cpu, Dim>> sums_;  // none before the first update
  std::vector<std::uint64_t> tile_keys_;              // for which columns are numbered
};

}  // namespace thawslide::band
