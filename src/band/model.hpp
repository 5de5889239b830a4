// What heat and pore pressure need to know, the same for every step.
#pragma once

#include <variant>
#include <vector>

#include "base/linear.hpp"
#include "mpm/transfer.hpp"
#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"
#include "physics/mixture.hpp"

namespace thawslide::band {

enum class FaceHeat { insulated, temperature, flux };

template <class Real>
struct HeatFace {
  FaceHeat kind = FaceHeat::insulated;
  Real value = 0;  // [C], or [W/m2] into the body
};

enum class ScaledRegion { all, first_layer };

template <class Real>
using AnyHeatContent = std::variant<physics::HeatContent<Real, physics::PowerLawCurve<Real>>,
                                    physics::HeatContent<Real, physics::LinearCurve<Real>>>;

template <int Dim, class Real>
struct BandModel {
  physics::Phases<Real> phases;
  AnyHeatContent<Real> heat_content;
  Real reference_temperature = 0;  // Tref [C]
  Real clapeyron_sign = 1;         // +1 as usual, -1 as Eq. 4 prints it
  Real gravity = 0;                // magnitude [m/s2]
  bool heat = true;
  bool conduction = true;
  bool advection = true;
  HeatFace<Real> faces[2 * Dim] = {};
  Vector<Real, Dim> extent;  // upper corner of the domain [m]
  ScaledRegion region = ScaledRegion::all;
  bool secant_capacity = true;  // off: the old apparent capacity, as Eq. 19 is printed
  bool current_masses = false;  // heat is held by masses from the current porosity and volume, as printed
  bool lubrication = true;      // off: Eq. 25 sees the initial porosity and saturation (Sec. 3.3)

  bool pressure = true;
  bool thermal_pressurization = true;
  bool volumetric_term = false;  // Eq. 8's -div v, which Eq. 23 drops
  bool seepage = true;
  bool seepage_as_printed = false;  // Eq. 23 with one xi over the whole pore space
  bool normal_thickness = true;
  bool thickness_each_step = true;
  std::vector<Real> hydraulic_conductivity;      // by material [m/s]
  mpm::BodySizes<Real> sizes;                    // of particles, in cells
  mpm::ShapeKind shape = mpm::ShapeKind::ugimp;  // of momentum
  mpm::HeldSides<Dim> sides;

  // Hydraulic conductivities [m/s].
  template <class Particles, class At>
  [[nodiscard]] typename At::Value hydraulic(const Particles& particles, const At& at) const {
    if (hydraulic_conductivity.size() == 1) {
      return hydraulic_conductivity[0];
    }
    return at.each(
        [&](std::uint32_t p) { return hydraulic_conductivity[static_cast<std::size_t>(particles.material(p))]; });
  }

  // Calls work(content) with the heat content law of the run.
  template <class Work>
  decltype(auto) with_heat_content(const Work& work) const {
    return std::visit(work, heat_content);
  }
};

}  // namespace thawslide::band
