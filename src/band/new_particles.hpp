// Heat and pore pressure of new particles, those at memory index `first` and above.
#pragma once

#include "band/model.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Sets heat content and saturation from temperature and porosity.
template <int Dim>
void set_heat_content(const BandModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first = 0);

// Adds heat [J] to a particle and updates its temperature. particle: memory index.
template <int Dim>
void add_heat(const BandModel<Dim>& model, double heat, std::size_t particle, mpm::Particles<Dim>& particles);

// Sets pressures from temperature and flow depth. A melted particle starts from P_L = P_I / r.
template <int Dim>
void set_pore_pressure(const BandModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first = 0);

}  // namespace thawslide::band
