// Parameters of materials and of motion, on CPU and devices.
#pragma once

#include <algorithm>
#include <vector>

#include "base/linear.hpp"
#include "mpm/shape.hpp"
#include "mpm/tile.hpp"
#include "physics/elasticity.hpp"
#include "physics/mixture.hpp"
#include "physics/mohr_coulomb.hpp"

namespace thawslide::mpm {

struct MaterialParameters {
  physics::Elastic elastic;
  bool gaps_close_first = false;      // physics/tension_gap.hpp
  double viscosity_time = 0;          // Kelvin-Voigt [s]
  double hydraulic_conductivity = 0;  // [m/s]
};
struct MaterialModel : MaterialParameters {
  physics::ConstitutiveLaw law;
};

// Velocity transfer from nodes to particles: changes (FLIP, Eq. 13) with a fraction of nodal velocities (PIC), or nodal
// velocities with the affine velocity around the particle (APIC; Jiang et al. 2015).
enum class TransferKind { flip_pic, apic };

template <int Dim>
struct MotionParameters {
  ShapeFunction shape = ShapeFunction::ugimp;
  PrescribedSides<Dim> sides;
  TransferKind transfer = TransferKind::flip_pic;
  double pic_fraction = 0;      // of TransferKind::flip_pic; 0: FLIP
  int filter_order = 0;         // of the velocity filter (mpm/velocity_filter.hpp); 0: none
  Vector<double, Dim> gravity;  // [m/s2]
  std::vector<MaterialModel> materials;
  physics::Phases phases;
  bool effective_stress = false;  // stress is effective: the pore pressure also acts inside the body
  bool lubrication = true;        // off: Eq. 25 uses the initial porosity and saturation (Sec. 3.3)

  [[nodiscard]] bool viscous() const {
    return std::any_of(materials.begin(), materials.end(),
                       [](const MaterialModel& material) { return material.viscosity_time > 0.0; });
  }
  [[nodiscard]] bool is_affine() const { return transfer == TransferKind::apic; }
};

}  // namespace thawslide::mpm
