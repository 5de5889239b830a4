// What the step on a device needs to know of the run, and what it tells of a step, in plain numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "band/any_heat_content.hpp"
#include "band/at_columns.hpp"
#include "band/heat_face.hpp"
#include "band/nodal_heat.hpp"
#include "band/physics.hpp"
#include "band/pressure_kernels.hpp"
#include "band/step_extremes.hpp"
#include "mpm/accounts.hpp"
#include "mpm/domain_faces.hpp"
#include "mpm/map_sums.hpp"
#include "mpm/material.hpp"
#include "mpm/records.hpp"
#include "mpm/shape.hpp"
#include "mpm/stress_kernel.hpp"
#include "mpm/tile.hpp"
#include "physics/mixture.hpp"
#include "terrain/basal_law.hpp"
#include "terrain/bed_node.hpp"
#include "terrain/contact_work.hpp"
#include "terrain/surface.hpp"

namespace thawslide::device {

template <int Dim, class Real>
struct StepModel {
  Real cell = 0;                                 // mesh size [m]
  std::vector<Real> half_sizes;                  // of particles, by body, in cells
  mpm::ShapeKind shape = mpm::ShapeKind::ugimp;  // of momentum
  bool affine = false;                           // APIC
  bool moves = true;                             // off: heat and pore pressure alone
  mpm::HeldSides<Dim> sides;                     // that prescribe velocity
  Vector<Real, Dim> gravity;                     // [m/s2]
  Real pic_share = 0;                            // of new velocities
  int filter_order = 0;                          // of the velocity filter; 0: there is none
  std::function<bool(Real time, Real dt)> filters_in_step;
  Real mass_damping = 0;  // [1/s]
  std::vector<mpm::MaterialModel<Real>> materials;
  physics::Phases<Real> phases;
  bool effective_stress = false;  // the pore pressure acts inside the body too
  bool lubrication = true;        // off: the base sees the initial porosity and saturation
  mpm::DomainFaces<Dim, Real> faces;
  Vector<Real, Dim> lower, upper;  // particles may be between these [m]
  bool finds_extremes = false;     // StepSums::extremes is asked for
  bool counts_escaped = false;     // and StepSums::strays
  terrain::BasalLaw<Real> base;
  bool base_holds = false;        // no slip at all
  bool pore_pressure = true;      // off: P = 0 at contact nodes
  bool distance_check = false;    // a node may close its clearance before contact acts
  bool pressure_changes = false;  // off: pore pressures rest
  // Heat of particles, by masses of t = 0 and the secant to their heat content.
  bool heat = false;   // off: temperatures rest
  bool starts = true;  // the first step is that of t = 0
  band::AnyHeatContent<Real> heat_content;
  band::HeatFaces<Dim, Real> heat_faces;
  band::BandPhysics<Real> band;
  std::vector<Real> hydraulic_conductivity;       // by material [m/s]
  std::vector<Real> free_gaps;                    // as band::FreeGaps
  std::function<Real(Real time)> band_thickness;  // [m]; 0: there is no band, and xi = 1
  bool rescales_band = true;                      // off: its scaling rests
  bool scales_all = true;                         // and elsewhere too

  [[nodiscard]] bool has_band() const { return heat || pressure_changes; }
  [[nodiscard]] bool lets_water_seep() const {
    return pressure_changes && band::water_may_seep(band, hydraulic_conductivity);
  }
  [[nodiscard]] bool is_viscous() const {
    return std::any_of(materials.begin(), materials.end(),
                       [](const auto& material) { return material.viscosity_time > Real(0); });
  }
};

// Tells what the nodes of a block know of the ground: of all nodes, x fastest; and returns whether the ground is known
// everywhere below the block and a cell about it. Empty where there is no ground.
template <int Dim, class Real>
using GroundQuery = std::function<bool(std::uint64_t block, terrain::GroundAtNode<Dim, Real>* nodes)>;

// Thickness of the cells along the ground at the middle of a column of cells, by its indices along the horizontal axes
// [m] (terrain/layer_thickness.hpp); empty: it is one cell.
template <int Dim>
using LayerAtMiddle = std::function<double(const std::array<int, Dim - 1>&)>;

// Band columns, which lie under the slide and are the processor's; empty where there are none.
template <class Real>
struct HostColumns {
  // Told of the active blocks, by ascending key, when they have changed: returns the numbers of those whose nodes it
  // asks for.
  std::function<std::vector<std::uint32_t>(const std::vector<std::uint64_t>& blocks)> update_blocks;
  // Records of BaseState of the nodes that may touch the ground, in the order of blocks and nodes.
  std::function<const std::vector<Real>&()> states;
  // After contact: a record of column_record_size<Dim> numbers of each node of the blocks that were asked for.
  std::function<void(const std::vector<Real>& nodes)> follow;
};
// Of a node: the record of Contact, mass [kg] and mid-step velocity [m/s].
template <int Dim>
inline constexpr std::size_t column_record_size = static_cast<std::size_t>(mpm::Contact::size<Dim> + 1 + Dim);

// The erodible bed, which is the processor's; empty where there is none.
template <int Dim, class Real>
struct HostBed {
  using Columns = std::vector<std::array<int, Dim - 1>>;  // by the indices of their nodes along the horizontal axes

  terrain::BedMaterial<Real> material;
  // Told of the columns of the active blocks and of those that the nodes stand in that may touch the ground, when
  // blocks have changed; some are beyond the domain.
  std::function<void(const Columns& of_blocks, const Columns& of_candidates)> set_columns;
  // Told which parts of the former the slide has come to cover (terrain/bed.hpp) and how the latter press on the
  // ground: what of the bed is available to these [kg].
  std::function<const std::vector<Real>&(const std::vector<std::uint32_t>& parts, const std::vector<Real>& loads)>
      parallel_chunks;
  // After contact: a record of bed_record_size<Dim> numbers of each of the latter.
  std::function<void(const std::vector<Real>& nodes)> collect;
};
// Of a node: the record of BedLayout, and the normal pressure where it has taken some of the bed [Pa].
template <int Dim>
inline constexpr std::size_t bed_record_size = static_cast<std::size_t>(mpm::BedLayout<Dim>::size) + 1;

// What the processor is asked amid a step.
template <int Dim, class Real>
struct HostCallbacks {
  GroundQuery<Dim, Real> ground;
  // As band/flow_depth.hpp asks. Without the slope's cosine thickness is vertical; the gravity is needed for loads
  // only.
  band::OfPlace<Dim, Real> slope_cosine, normal_gravity;
  LayerAtMiddle<Dim> layer_at_middle;
  HostColumns<Real> columns;
  HostBed<Dim, Real> bed;
};

// What maps and the way of the centre of mass take after a step, in space.
struct MapSample {
  std::vector<std::uint64_t> keys;  // of cells that the slide may be above, ascending (mpm::map_cell_key)
  std::vector<mpm::MapSums> sums;   // of these
  mpm::MassMoments moments;
};

// Sums over particles and nodes of one step; energies [J].
template <int Dim, class Real>
struct StepSums {
  terrain::ContactWork<Dim, Real> contact;
  Real particle_kinetic = 0;  // as mpm::MoveWork
  Real filtered = 0;          // kinetic energy that the velocity filter gave
  Real mapped_back = 0;       // work of internal forces at mid-step velocities less that at the mapped-back ones
  mpm::Deformed<Real> deformed;
  Real band_rescale = 0;  // heat by another scaling
  band::HeatGain<Real> heat;
  band::DrainedWater<Real> drained;  // at the surface
  Real vented = 0;                   // water lost to frozen pores [kg]
  mpm::InvalidParticle invalid;      // after the particles have moved
  band::StepExtremes extremes;
  std::uint64_t escapes = 0;  // particles beyond the domain's sides, or in a block whose ground is partly unknown
};

}  // namespace thawslide::device
