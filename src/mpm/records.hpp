// Layouts of nodal records, and the names by which kernels access them.
#pragma once

#include <cstddef>

#include "base/select.hpp"
#include "mpm/kernel.hpp"
#include "physics/rigid_motion.hpp"

namespace thawslide::mpm {

// Records are padded to a multiple of `record_step` numbers.
inline constexpr std::size_t record_step = 4;
constexpr std::size_t record_size(int components) {
  return (static_cast<std::size_t>(components) + record_step - 1) / record_step * record_step;
}

// Sums over particles with the momentum shape functions S_ip and gradients G_ip. The order keeps each vector within a
// register of four numbers.
template <int Dim>
struct MomentumLayout {
  static constexpr std::size_t force = 0;                    // sum S m b - V sigma.G [N], Eq. 12
  static constexpr std::size_t momentum = Dim == 2 ? 2 : 4;  // sum S m v [kg m/s]
  static constexpr std::size_t mass = Dim == 2 ? 4 : 3;      // sum S m [kg]
  static constexpr std::size_t volume = Dim == 2 ? 5 : 7;    // sum S V [m3]
  static constexpr int size = 2 + 2 * Dim;
};

// Nodal motion read by particles: acceleration [m/s2] and velocity at mid-step [m/s].
template <int Dim>
struct MotionLayout {
  static constexpr std::size_t acceleration = 0;
  static constexpr std::size_t middle_velocity = Dim;
  static constexpr int size = 2 * Dim;
};

// Sums over particles, weighted by volume (Eq. 21, not normalized).
struct Averages {
  using Functions = LinearFunctions;
  static constexpr std::size_t volume = 0;  // sum S V [m3]
  static constexpr std::size_t temperature = 1;
  static constexpr std::size_t pore_pressure = 2;
  template <int Dim>
  static constexpr int size = 3;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.averages; }
};

// Sums over particles near the ground at candidate nodes, in one record: sums S m X with the momentum shape functions,
// for nodes without linear weight and for the slip.
struct NearGround {
  using Functions = MomentumFunctions;
  static constexpr std::size_t temperature = 0;
  static constexpr std::size_t pore_pressure = 1;
  static constexpr std::size_t saturation = 2;
  static constexpr std::size_t solid_fraction = 3;  // effective, n_e of Eq. 2
  static constexpr std::size_t slip = 4;            // [kg m]
  static constexpr std::size_t by_mass = 5;         // number of components weighted by mass

  static constexpr std::size_t saturation_by_linear = 5;
  static constexpr std::size_t solid_fraction_by_linear = 6;
  static constexpr std::size_t clearance = 7;  // [m], the largest number if undefined
  template <int Dim>
  static constexpr int size = 8;
  template <int Dim>
  static constexpr RecordPart part{0, by_mass};
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.near_ground; }
};
// Sums S V X with the linear shape functions.
struct NearGroundByLinear : NearGround {
  using Functions = LinearFunctions;
  using Owner = NearGround;
  template <int Dim>
  static constexpr RecordPart part{saturation_by_linear, 2};
};
// Smallest gap between a node's plane and the particles in its reach by the momentum shape functions.
struct Clearance : NearGround {
  using Owner = NearGround;
  static constexpr bool min_reduced = true;
  template <int Dim>
  static constexpr RecordPart part{clearance, 1};
};

// Planes of nodes, for gaps to particles: x.n = offset, with x relative to the domain's lower corner.
struct Planes {
  using Functions = LinearFunctions;
  static constexpr std::size_t offset = 0;  // [m]
  static constexpr std::size_t normal = 1;  // its vertical component is -1 for gaps along the vertical, 0 for none
  template <int Dim>
  static constexpr int size = 1 + Dim;
};

// Gap between a position and a node's plane [m]. plane(component): of the record of Planes.
template <int Dim, class Value, class Plane>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value gap_to_plane(const Value (&position)[Dim], const Plane& plane) {
  Value gap = plane(Planes::offset);
  unrolled<static_cast<std::size_t>(Dim)>(
      [&](auto a) THAWSLIDE_INLINE_LAMBDA { gap -= plane(Planes::normal + a) * position[a]; });
  return gap;
}

// Load of candidate nodes on the ground, and covered ground.
struct BaseLoad {
  // Trial momentum into the ground, minus the part that closes the clearance, times the bend of the ground [kg m/s].
  static constexpr std::size_t load = 0;
  static constexpr std::size_t covered = 1;  // covered part of the node's ground surface [m2]
  template <int Dim>
  static constexpr int size = 2;
  static auto& in(auto& nodes) { return nodes.base; }
};

// Results of contact at a node, for the stages after it.
struct Contact {
  using Functions = LinearFunctions;
  static constexpr std::size_t candidate = 0;      // 1 if the ground is near, otherwise 0
  static constexpr std::size_t touching = 1;       // 1 in contact, otherwise 0
  static constexpr std::size_t slip_speed = 2;     // [m/s], tangential, at mid-step; 0 without contact
  static constexpr std::size_t friction_heat = 3;  // [W], after the conversion coefficient
  static constexpr std::size_t normal_force = 4;   // on the ground, times its bend: normal pressure times area [N]
  static constexpr std::size_t area = 5;           // [m2]
  template <int Dim>
  static constexpr int size = 6;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.contact; }
};

// Bed mass available to contact nodes, and entrained mass.
template <int Dim>
struct BedLayout {
  static constexpr std::size_t available = 0;                    // [kg]
  static constexpr std::size_t entrained = 1;                    // [kg]
  static constexpr std::size_t work = 2;                         // work done on it by the sliding mass [J]
  static constexpr std::size_t impulse = 3;                      // impulse from the sliding mass [N s]
  static constexpr std::size_t normal_pressure = impulse + Dim;  // on the ground [Pa]
  static constexpr std::size_t size = normal_pressure + 1;
};

// State of the band columns around contact nodes: sums over basal segments of weight times area [m2] times each
// quantity.
struct BaseState {
  static constexpr std::size_t area = 0;
  static constexpr std::size_t temperature = 1;
  static constexpr std::size_t pressure_ratio = 2;  // pore pressure over averaged normal pressure
  static constexpr std::size_t saturation = 3;
  static constexpr std::size_t solid_fraction = 4;  // effective, n_e of Eq. 2
  static constexpr std::size_t slip = 5;            // [m]
  template <int Dim>
  static constexpr int size = 6;
};

// Nodal heat and pore pressure read by particles: averages, or a prescribed temperature, and their changes.
struct NodalState {
  using Functions = LinearFunctions;
  static constexpr std::size_t temperature = 0;       // [C]
  static constexpr std::size_t pore_pressure = 1;     // [Pa]
  static constexpr std::size_t temperature_rate = 2;  // [K/s]
  static constexpr std::size_t pressure_change = 3;   // by seepage in the step [Pa], Eq. 22
  template <int Dim>
  static constexpr int size = 4;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.state; }
};

// Sums over particles for the heat balance (Eq. 19).
struct HeatRates {
  using Functions = LinearFunctions;
  static constexpr std::size_t conduction = 0;  // [W]
  static constexpr std::size_t advection = 1;   // [W]
  static constexpr std::size_t capacity = 2;    // [J/K]
  static constexpr std::size_t subgrid = 3;     // heat gained by subgrid diffusion [J]
  template <int Dim>
  static constexpr int size = 4;
  static constexpr int flux = 0;
  static auto& in(auto& nodes) { return nodes.heat_rates; }
};

// The same with the secant capacity, where it differs: added to the patches of HeatRates.
struct SecantRates : HeatRates {
  static auto& in(auto& nodes) { return nodes.secant_rates; }
};

// Friction heat of nodes without linear weight, per mass [W/kg].
struct UnreachedHeat {
  using Functions = MomentumFunctions;
  template <int Dim>
  static constexpr int size = 1;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.unreached_heat; }
};

// Sums over particles for the pore pressure (Eq. 23).
struct Seepage {
  using Functions = LinearFunctions;
  static constexpr std::size_t inflow = 0;      // times K_L [Pa m3/s]
  static constexpr std::size_t pore_space = 1;  // [m3]
  static constexpr std::size_t subgrid = 2;     // pore space times subgrid diffusion [Pa m3]
  static constexpr std::size_t seeping = 3;     // pore space of particles with seepage [m3]
  template <int Dim>
  static constexpr int size = 4;
  static constexpr int flux = 0;
  static auto& in(auto& nodes) { return nodes.seepage; }
};

// Sums over the particles whose pores take part in seepage, if these are not all particles.
struct SeepingWater {
  using Functions = LinearFunctions;
  static constexpr std::size_t volume = 0;         // sum S V [m3]
  static constexpr std::size_t pore_pressure = 1;  // sum S V P
  template <int Dim>
  static constexpr int size = 2;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.seeping_water; }
};

// Records of MomentumLayout and MotionLayout, and the velocity mapped back from the moved particles (MUSL) [m/s].
struct Momentum {
  using Functions = MomentumFunctions;
  template <int Dim>
  static constexpr int size = MomentumLayout<Dim>::size;
  static constexpr int flux = 0;
  static auto& in(auto& nodes) { return nodes.momentum; }
};
struct Motion {
  using Functions = MomentumFunctions;
  template <int Dim>
  static constexpr int size = MotionLayout<Dim>::size;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.motion; }
};
struct Velocity {
  using Functions = MomentumFunctions;
  template <int Dim>
  static constexpr int size = Dim;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.velocity; }
};

// Sums over particles for the velocity filter (mpm/velocity_filter.hpp), around the domain's lower corner.
struct FilterMoments {
  using Functions = MomentumFunctions;
  static constexpr std::size_t first = 0;  // sum S m x [kg m], followed by sum S m x x [kg m2]
  template <int Dim>
  static constexpr int size = Dim + physics::squares<Dim>;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.filter_moments; }
};
struct FilterMomentum {
  using Functions = MomentumFunctions;
  static constexpr std::size_t momentum = 0;  // sum S m v [kg m/s], followed by sum S m x x v [kg m2/s]
  template <int Dim>
  static constexpr int size = Dim + physics::rotations<Dim>;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.filter_momentum; }
};
// Nodal rigid motions: increment of the last sweep, and total. Velocity at the domain's lower corner [m/s], followed by
// the rotation [1/s].
struct FilterIncrement : FilterMomentum {
  static auto& in(auto& nodes) { return nodes.filter_increment; }
};
struct FilterTotal : FilterMomentum {
  static auto& in(auto& nodes) { return nodes.filter_total; }
};

// The same records with the weights of APIC.
struct AffineMomentum : Momentum {
  using Functions = AffineFunctions;
  using Owner = Momentum;
  template <int Dim>
  static constexpr RecordPart part{MomentumLayout<Dim>::momentum, Dim};
};
struct AffineMotion : Motion {
  using Functions = AffineFunctions;
  using Owner = Motion;
};
struct AffineVelocity : Velocity {
  using Functions = AffineFunctions;
  using Owner = Velocity;
  static constexpr int flux = 0;
};

// First component of the register that contains the first component of a name, and its position in that register.
template <class Name, int Dim>
inline constexpr std::size_t first_in_register = part_of<Name, Dim>.from / record_step* record_step;
template <class Name, int Dim>
inline constexpr std::size_t index_in_register = part_of<Name, Dim>.from - first_in_register<Name, Dim>;

// An aliased record: it adds to its owner's record with other weights, within one register. If the owner's kernels add
// to the same components, it needs a separate pass after theirs; otherwise it can follow the owner in one list.
template <class Name>
concept OfAnOwner = requires {
  typename Name::Owner;
};

// Numbers that a particle contributes to a record, from the register with its first component on, or to min-reduced
// components.
template <class Name, int Dim>
inline constexpr std::size_t scatter_size =
    IsMinReduced<Name> ? part_of<Name, Dim>.count : index_in_register<Name, Dim> + part_of<Name, Dim>.count;

// Contribution of a batch, or of one particle, to a min-reduced component: its gap to the plane of each node in reach.
// PlanesRead: access to the records of Planes.
template <class Value, int Dim, class PlanesRead>
struct GapsToPlanes {
  Value position[Dim];  // [m]
  Value least;          // gaps are at least this [m]
  PlanesRead planes;
};
}  // namespace thawslide::mpm
