// Options that a case selects and that laws and kernels branch on. The headers of the laws give the equations and
// sources, as does docs/theory/. For host and device.
#pragma once

namespace thawslide::physics {

// Basal strength (physics/contact.hpp) if the pore pressure exceeds the normal pressure.
enum class FrictionClamp {
  keep_cohesion,  // mu max(0, N - P) + c_S: pressure reduces friction but not cohesion (default)
  joint           // max(0, mu (N - P) + c_S): excess pressure also reduces cohesion
};

// Thermal expansion of water (physics/pore_water.hpp).
enum class WaterExpansionLaw {
  constant,       // Table 1
  by_temperature  // through the four values of physics/pore_water.hpp
};

// Boundary condition for water of melted cells at frozen cells, and at the top of a band column.
enum class EndOfWater {
  sealed,  // impermeable
  vented   // air, at P = 0
};

// Boundary condition of frozen material for seepage.
enum class FrozenRows {
  draining,  // its pores take part, at the pressure of its ice
  sealed,    // impermeable
  vented     // its pores take part, at atmospheric pressure
};

// Growth of the band thickness e beyond the prescribed value.
enum class BandGrowth {
  none,
  inertial,  // e = v d sqrt(rho_S/(N - P))/I, with N - P at least 0.02 N
  slip       // in proportion to the slip
};

// Particles with scaled heat and seepage.
enum class BandRegion {
  all,         // as published
  first_layer  // of cells above the terrain
};

// Erosion of the bed (physics/entrainment.hpp).
enum class BedLaw {
  none,  // no bed
  strength,
  momentum
};

// Condition for velocity at a face of the domain.
enum class BoundaryKind {
  open,    // nothing is prescribed
  roller,  // no velocity across the face
  fixed    // no velocity
};

// Condition for heat at a face of the domain.
enum class HeatBoundaryKind { insulated, temperature, flux };

// Shape functions of momentum; heat and pore pressure always use the linear ones.
enum class ShapeFunction { ugimp, quadratic };

}  // namespace thawslide::physics
