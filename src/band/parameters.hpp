// Parameters of heat and pore pressure for the stages of a step, on CPU and devices.
#pragma once

#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "band/heat_face.hpp"
#include "band/particle_heat.hpp"
#include "band/physics.hpp"
#include "physics/options.hpp"

namespace thawslide::band {

using physics::BandRegion;

template <int Dim>
struct BandParameters : BandPhysics {
  AnyHeatContent heat_content;
  bool heat = true;      // off: temperatures are constant
  bool pressure = true;  // off: pore pressures are constant
  HeatFaces<Dim> at_faces;
  BandRegion region = BandRegion::all;
  bool secant_capacity = true;                 // off: the old apparent capacity, Eq. 19 as published
  std::vector<double> hydraulic_conductivity;  // by material [m/s]

  // True if the scaling of particles changes: with the thickness of the band [m] since the last call, as particles
  // enter or leave the band, or with the slope of the ground.
  [[nodiscard]] bool scaling_changes(bool follows_ground, double thickness, double& last) const {
    return region != BandRegion::all || follows_ground || std::exchange(last, thickness) != thickness;
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
decltype(auto) with_particle_heat(const BandParameters<Dim>& model, const Work& work) {
  return model.with_heat_content(
      [&](const auto& content) { return work(ParticleHeat<std::decay_t<decltype(content)>>{content}); });
}

}  // namespace thawslide::band
