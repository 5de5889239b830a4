// Averages of band quantities at nodes, and the depth of flow above particles.
#pragma once

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
// their depth below its top; both times slope_cosine(x), the cosine of the terrain's slope there. columns_top is filled
// with the depth below the column's top for every particle.
template <int Dim, class Real>
class FlowDepth {
 public:
  // The columns from positions and volumes. slope_cosine may be empty: level ground.
  void update(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
              const std::function<Real(Real)>& slope_cosine, const mpm::Particles<Dim, Real>& particles);
  // particles.flow_depth from the columns and in_band.
  void depth_to_particles(const mpm::SparseGrid<Dim, Real>& grid, mpm::Particles<Dim, Real>& particles) const;

  // Depth of a particle below the top of its column [m], vertical.
  [[nodiscard]] Real depth_below_top(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                                     std::uint32_t p) const;

 private:
  struct Column {
    Real volume = 0;
    Real top = 0;
    Real cosine = 1;
  };

  static std::uint64_t column_key(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                                  std::uint32_t p);

  KeyIndex index_;
  std::vector<Column> columns_;
};

}  // namespace thawslide::band
