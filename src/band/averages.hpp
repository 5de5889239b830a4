// Averages of band quantities at nodes, and the depth of flow above particles.
#pragma once

#include <array>
#include <functional>

#include "band/model.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Temperature, pore pressure (Eq. 21 with normalised weights), saturation and solid fraction to the nodes, by volume
// with the linear hats.
template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                     const BandModel<Dim, Real>& model, mpm::Nodes<Dim, Real>& nodes);

// H of P_I = rho_I g H [m]: band particles see the thickness of the whole grid column (volume over footprint), others
// their depth below its top; both times slope_cosine(x), the cosine of the terrain's slope there.
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
                                     std::size_t t, std::uint32_t p) const {
    return column(grid, particles, t, p).top - particles.position(p, Dim - 1);
  }

 private:
  struct Column {
    Real volume = 0;
    Real top = 0;
    Real cosine = 1;
  };
  // The columns that a tile's particles stand in: their cells reach one below the tile's first node.
  static constexpr int columns_per_axis = mpm::Tile<Dim>::edge + 1;
  static constexpr auto columns_per_tile = static_cast<std::size_t>(mpm::power(columns_per_axis, Dim - 1));
  struct TileColumns {
    std::array<Column, columns_per_tile> part;
    std::array<std::int32_t, columns_per_tile> number;
  };

  static std::size_t place_in_tile(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                                   std::size_t t, std::uint32_t p);
  static std::uint64_t column_key(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t, std::size_t place);
  [[nodiscard]] const Column& column(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                                     std::size_t t, std::uint32_t p) const {
    return columns_[static_cast<std::size_t>(tiles_[t].number[place_in_tile(grid, particles, t, p)])];
  }

  KeyIndex index_;
  std::vector<Column> columns_;
  std::vector<TileColumns> tiles_;
};

}  // namespace thawslide::band
