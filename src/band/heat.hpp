// Heat on the grid (Eqs. 9, 18-20), with the shear band scaling of Sec. 2.3: equivalent to a grid finer by xi.
#pragma once

#include "band/model.hpp"
#include "band/nodal_heat.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Updates heat content, temperature and saturation of all particles over dt. nodes.state must be that of
// average_on_grid in this step. first_step: prescribed temperatures are applied as a jump.
template <int Dim>
HeatGain conduct_heat(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double dt, bool first_step,
                      mpm::Nodes<Dim>& nodes, mpm::Particles<Dim>& particles);

// Adds heat [J] to a particle and updates its temperature. particle: memory index.
template <int Dim>
void add_heat(const BandModel<Dim>& model, double heat, std::size_t particle, mpm::Particles<Dim>& particles);

// Sets heat content and saturation of new particles, those at memory index `first` and above, from temperature and
// porosity.
template <int Dim>
void set_heat_content(const BandModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first = 0);

// Sets the current scaling xi = layer / thickness of particles at memory index `first` and above (1 outside the
// region). Returns the heat [J] that the change adds at constant temperature and pressure. thickness 0: no band,
// xi = 1.
template <int Dim>
double rescale_band(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double thickness,
                    mpm::Particles<Dim>& particles, std::size_t first = 0);

}  // namespace thawslide::band
