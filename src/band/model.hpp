// Parameters of heat and pore pressure that are constant during a run.
#pragma once

#include <type_traits>
#include <variant>
#include <vector>

#include "band/heat_face.hpp"
#include "band/particle_heat.hpp"
#include "band/physics.hpp"
#include "base/linear.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/particles.hpp"
#include "mpm/section_width.hpp"
#include "mpm/transfer.hpp"
#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"
#include "physics/options.hpp"

namespace thawslide::band {

using physics::BandRegion;

template <int Dim>
struct BandModel : BandPhysics {
  AnyHeatContent heat_content;
  bool heat = true;
  HeatFaces<Dim> at_faces;
  BandRegion region = BandRegion::all;
  bool secant_capacity = true;  // off: the old apparent capacity, Eq. 19 as published
  bool current_masses = false;  // heat content uses masses from the current porosity and volume, as published
  bool lubrication = true;      // off: Eq. 25 uses the initial porosity and saturation (Sec. 3.3)

  bool pressure = true;
  bool normal_thickness = true;
  std::vector<double> hydraulic_conductivity;            // by material [m/s]
  mpm::BodySizes sizes;                                  // of particles, in cells
  mpm::ShapeFunction shape = mpm::ShapeFunction::ugimp;  // of momentum
  mpm::PrescribedSides<Dim> sides;
  mpm::SectionWidth width;  // of a 2D section

  [[nodiscard]] HydraulicConductivity hydraulic() const {
    return {hydraulic_conductivity.data(), hydraulic_conductivity.size() == 1};
  }

  [[nodiscard]] bool has_seepage() const { return pressure && water_may_seep(*this, hydraulic_conductivity); }

  // Calls work(content) with the heat content law of the run.
  template <class Work>
  decltype(auto) with_heat_content(const Work& work) const {
    return std::visit(work, heat_content);
  }
};

// Calls work(law) with the ParticleHeat of the run.
template <int Dim, class Work>
decltype(auto) with_particle_heat(const BandModel<Dim>& model, const Work& work) {
  return model.with_heat_content([&](const auto& content) {
    using Content = std::decay_t<decltype(content)>;
    if (model.current_masses) {
      return work(ParticleHeat<Content, CurrentMasses>{content});
    }
    return work(ParticleHeat<Content, InitialMasses>{content});
  });
}

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
