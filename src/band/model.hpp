// Parameters of heat and pore pressure that are constant during a run.
#pragma once

#include "band/parameters.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/particles.hpp"
#include "mpm/section_width.hpp"
#include "mpm/transfer.hpp"

namespace thawslide::band {

template <int Dim>
struct BandModel : BandParameters<Dim> {
  bool lubrication = true;  // off: Eq. 25 uses the initial porosity and saturation (Sec. 3.3)
  bool normal_thickness = true;
  mpm::BodySizes sizes;                                  // of particles, in cells
  mpm::ShapeFunction shape = mpm::ShapeFunction::ugimp;  // of momentum
  mpm::PrescribedSides<Dim> sides;
  mpm::SectionWidth width;  // of a 2D section

  [[nodiscard]] HydraulicConductivity hydraulic() const {
    return {this->hydraulic_conductivity.data(), this->hydraulic_conductivity.size() == 1};
  }
};

// Selects the particle fields that heat and pore pressure need. Call before particles are allocated.
template <int Dim>
void keep_fields(const BandModel<Dim>& model, mpm::Particles<Dim>& particles) {
  particles.volume_strain.keep(model.volumetric_term);
  particles.initial_heat_content.keep(model.rescaling_mixes);
  particles.pore_void.keep(model.balances_water());
  particles.normal_load.keep(model.needs_normal_load());
  particles.load_change.keep(model.needs_normal_load());
  particles.seeped_water.keep(model.has_seepage());
}

}  // namespace thawslide::band
