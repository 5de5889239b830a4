// What nodes hold during a step: the layouts of their records, and the names by which kernels read and add to them.
#pragma once

#include <cstddef>

#include "base/select.hpp"
#include "mpm/kernel.hpp"
#include "physics/rigid_motion.hpp"

namespace thawslide::mpm {

// A record is filled up to a multiple of `record_step` numbers.
inline constexpr std::size_t record_step = 4;
constexpr std::size_t record_size(int components) {
  return (static_cast<std::size_t>(components) + record_step - 1) / record_step * record_step;
}

// Sums over particles with the momentum shape functions S_ip and gradients G_ip. No vector lies in two registers of
// four.
template <int Dim>
struct MomentumLayout {
  static constexpr std::size_t force = 0;                    // sum S m b - V sigma.G [N], Eq. 12
  static constexpr std::size_t momentum = Dim == 2 ? 2 : 4;  // sum S m v [kg m/s]
  static constexpr std::size_t mass = Dim == 2 ? 4 : 3;      // sum S m [kg]
  static constexpr std::size_t volume = Dim == 2 ? 5 : 7;    // sum S V [m3]
  static constexpr int size = 2 + 2 * Dim;
};

// What particles read to move: the node's acceleration [m/s2] and its velocity at mid-step [m/s].
template <int Dim>
struct MotionLayout {
  static constexpr std::size_t acceleration = 0;
  static constexpr std::size_t middle_velocity = Dim;
  static constexpr int size = 2 * Dim;
};

// Sums over particles, weighted by volume (Eq. 21, not normalised).
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

// What the particles near the ground tell its candidate nodes, in one record: sums S m X with the momentum shape
// functions, for nodes without linear weight and for the slip.
struct NearGround {
  using Functions = MomentumFunctions;
  static constexpr std::size_t temperature = 0;
  static constexpr std::size_t pore_pressure = 1;
  static constexpr std::size_t saturation = 2;
  static constexpr std::size_t solid_fraction = 3;  // effective, n_e of Eq. 2
  static constexpr std::size_t slip = 4;            // [kg m]
  static constexpr std::size_t by_mass = 5;         // those above

  static constexpr std::size_t saturation_by_linear = 5;
  static constexpr std::size_t solid_fraction_by_linear = 6;
  static constexpr std::size_t clearance = 7;  // [m], beyond all bounds where there is none
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
// The smallest gap between a node's plane and the particles that it sees with the momentum shape functions.
struct Clearance : NearGround {
  using Owner = NearGround;
  static constexpr bool min_reduced = true;
  template <int Dim>
  static constexpr RecordPart part{clearance, 1};
};

// The planes of nodes, to which particles measure gaps: x.n = offset for places x from the domain's lower corner.
struct Planes {
  using Functions = LinearFunctions;
  static constexpr std::size_t offset = 0;  // [m]
  static constexpr std::size_t normal = 1;  // unit vector
  template <int Dim>
  static constexpr int size = 1 + Dim;
};

// The gap between a particle and a node's plane [m]: its distance along the normal less its own reach. place: x of the
// particle; plane(component): of the node's record of Planes.
template <int Dim, class Value, class Plane>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value gap_to_plane(const Value (&place)[Dim], Value reach, const Plane& plane) {
  Value gap = plane(Planes::offset) - reach;
  unrolled<static_cast<std::size_t>(Dim)>([&](auto a)
                                              THAWSLIDE_INLINE_LAMBDA { gap -= plane(Planes::normal + a) * place[a]; });
  return gap;
}

// Candidate nodes: how they press on the ground, and what of it they have.
struct BaseLayout {
  // Trial momentum into the ground, less what closes the clearance, times the bend of the ground [kg m/s].
  static constexpr std::size_t load = 0;
  static constexpr std::size_t covered = 1;  // what the slide covers of the node's share of the ground's surface [m2]
  static constexpr int size = 2;
};

// What contact leaves at a node for the stages after it.
struct Contact {
  using Functions = LinearFunctions;
  static constexpr std::size_t candidate = 0;      // 1 where the ground is near, 0 elsewhere
  static constexpr std::size_t touching = 1;       // 1 in contact, 0 not
  static constexpr std::size_t slip_speed = 2;     // [m/s], tangential, at mid-step; 0 where not in contact
  static constexpr std::size_t friction_heat = 3;  // [W], after the conversion coefficient
  static constexpr std::size_t normal_force = 4;   // on the ground, times its bend: normal pressure times area [N]
  static constexpr std::size_t area = 5;           // [m2]
  template <int Dim>
  static constexpr int size = 6;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.contact; }
};

// What contact nodes may take of the bed below, and take.
template <int Dim>
struct BedLayout {
  static constexpr std::size_t available = 0;  // [kg]
  static constexpr std::size_t taken = 1;      // [kg]
  static constexpr std::size_t work = 2;       // that the slide loses to it [J]
  static constexpr std::size_t impulse = 3;    // that it gets from the slide [N s]
  static constexpr int size = 3 + Dim;
};

// What contact nodes see of the band columns about them: sums over pieces of base of their weight and area [m2] times
// each quantity.
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

// What particles see of heat and pore pressure: the averages, or a prescribed temperature, and what
// becomes of them.
struct NodalState {
  using Functions = LinearFunctions;
  static constexpr std::size_t temperature = 0;       // [C]
  static constexpr std::size_t pore_pressure = 1;     // [Pa]
  static constexpr std::size_t temperature_rate = 2;  // [K/s]
  static constexpr std::size_t pressure_change = 3;   // what seepage brings in the step [Pa], Eq. 22
  template <int Dim>
  static constexpr int size = 4;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.state; }
};

// Sums over particles of what changes their heat (Eq. 19).
struct HeatRates {
  using Functions = LinearFunctions;
  static constexpr std::size_t conduction = 0;  // [W]
  static constexpr std::size_t advection = 1;   // [W]
  static constexpr std::size_t capacity = 2;    // [J/K]
  static constexpr std::size_t subgrid = 3;     // heat taken by subgrid diffusion [J]
  template <int Dim>
  static constexpr int size = 4;
  static constexpr int flux = 0;
  static auto& in(auto& nodes) { return nodes.heat_rates; }
};

// Friction heat of nodes without linear weight, per mass [W/kg].
struct UnreachedHeat {
  using Functions = MomentumFunctions;
  template <int Dim>
  static constexpr int size = 1;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.unreached_heat; }
};

// Sums over particles of what changes their pore pressure (Eq. 23).
struct Seepage {
  using Functions = LinearFunctions;
  static constexpr std::size_t inflow = 0;      // times K_L [Pa m3/s]
  static constexpr std::size_t pore_space = 1;  // [m3]
  static constexpr std::size_t subgrid = 2;     // pore space times subgrid diffusion [Pa m3]
  static constexpr std::size_t seeping = 3;     // pore space of particles that water seeps from and to [m3]
  template <int Dim>
  static constexpr int size = 4;
  static constexpr int flux = 0;
  static auto& in(auto& nodes) { return nodes.seepage; }
};

// Sums over the particles whose pores take part in seepage, where these are not all.
struct SeepingWater {
  using Functions = LinearFunctions;
  static constexpr std::size_t volume = 0;         // sum S V [m3]
  static constexpr std::size_t pore_pressure = 1;  // sum S V P
  template <int Dim>
  static constexpr int size = 2;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.seeping_water; }
};

// The records of MomentumLayout and MotionLayout, and the velocity mapped back from the moved particles (MUSL) [m/s].
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

// Sums over particles for the filter of velocities (mpm/velocity_filter.hpp), about the domain's lower corner.
struct FilterMoments {
  using Functions = MomentumFunctions;
  static constexpr std::size_t first = 0;  // sum S m x [kg m]; after it sum S m x x [kg m2]
  template <int Dim>
  static constexpr int size = Dim + physics::squares<Dim>;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.filter_moments; }
};
struct FilterMomentum {
  using Functions = MomentumFunctions;
  static constexpr std::size_t momentum = 0;  // sum S m v [kg m/s]; after it sum S m x x v [kg m2/s]
  template <int Dim>
  static constexpr int size = Dim + physics::rotations<Dim>;
  static constexpr int flux = no_flux;
  static auto& in(auto& nodes) { return nodes.filter_momentum; }
};
// What of the nodes' rigid motions the last sweep brought, and all of them: the velocity at the domain's lower corner
// [m/s], after it the rotation [1/s].
struct FilterIncrement : FilterMomentum {
  static auto& in(auto& nodes) { return nodes.filter_increment; }
};
struct FilterTotal : FilterMomentum {
  static auto& in(auto& nodes) { return nodes.filter_total; }
};

// The same records as APIC's weights see them.
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

// The component of a record with which the register begins that holds the first one of a name, and the place of this
// one there.
template <class Name, int Dim>
inline constexpr std::size_t first_in_register = part_of<Name, Dim>.from / record_step* record_step;
template <class Name, int Dim>
inline constexpr std::size_t place_in_register = part_of<Name, Dim>.from - first_in_register<Name, Dim>;

// A record that has an owner is another way to add to the owner's: with other weights, to one of its registers. Where
// the owner's particles add to the same components, it takes a pass of its own after the owner's; else it may stand
// after it in one list.
template <class Name>
concept OfAnOwner = requires {
  typename Name::Owner;
};

// Numbers that a particle carries to a record, from the register on that holds the first one; or brings to one that it
// lowers.
template <class Name, int Dim>
inline constexpr std::size_t scatter_size =
    IsMinReduced<Name> ? part_of<Name, Dim>.count : place_in_register<Name, Dim> + part_of<Name, Dim>.count;

// What a batch, or one particle, brings to a component that it lowers: its gap to the plane of each node that it sees.
// PlanesRead: how it reads the nodes' records of Planes.
template <class Value, int Dim, class PlanesRead>
struct GapsToPlanes {
  Value place[Dim];  // [m]
  Value reach;       // [m]
  PlanesRead planes;
};
}  // namespace thawslide::mpm
