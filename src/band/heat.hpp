// Heat on the grid (Eqs. 9, 18-20), with the shear band scaling of Sec. 2.3: as if the grid were xi times finer.
#pragma once

#include <functional>

#include "band/model.hpp"
#include "band/nodal_heat.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Heat content, temperature and saturation of all particles after dt; nodes.state must hold what average_on_grid made
// of this step. first_step: prescribed temperatures jump now.
template <int Dim, class Real>
HeatGain<Real> conduct_heat(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real dt,
                            bool first_step, mpm::Nodes<Dim, Real>& nodes, mpm::Particles<Dim, Real>& particles);

// A particle gets heat [J] and has the temperature that follows. particle: its place in memory.
template <int Dim, class Real>
void add_heat(const BandModel<Dim, Real>& model, Real heat, std::size_t particle, mpm::Particles<Dim, Real>& particles);

// Sets heat content and saturation from temperature and porosity, of particles that begin: of those that stand in
// memory from `first` on.
template <int Dim, class Real>
void set_heat_content(const BandModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles, std::size_t first = 0);

// Gives each particle the scaling xi = layer / thickness now in force (1 outside the region); returns the heat [J] the
// change adds at constant temperature and pressure. thickness 0: no band, xi = 1. layer_thickness(x), the thickness of
// the cells that make up the band, may be empty: one cell. Only of the particles that stand in memory from `first` on.
template <int Dim, class Real>
Real rescale_band(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real thickness,
                  const std::function<Real(const Vector<Real, Dim - 1>&)>& layer_thickness,
                  mpm::Particles<Dim, Real>& particles, std::size_t first = 0);

}  // namespace thawslide::band
