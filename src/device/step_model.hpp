// What the step on a device needs to know of the run, and what it tells of a step, in plain numbers.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "band/any_heat_content.hpp"
#include "band/nodal_heat.hpp"
#include "band/physics.hpp"
#include "mpm/accounts.hpp"
#include "mpm/domain_faces.hpp"
#include "mpm/material.hpp"
#include "mpm/stress_kernel.hpp"
#include "mpm/tile.hpp"
#include "physics/mixture.hpp"
#include "terrain/basal_law.hpp"
#include "terrain/contact_work.hpp"
#include "terrain/surface.hpp"

namespace thawslide::device {

// Heat of particles, by masses of t = 0 and the secant to their heat content; no conditions at the domain's faces.
template <class Real>
struct HeatModel {
  band::BandPhysics<Real> physics;
  band::AnyHeatContent<Real> content;
  std::vector<Real> hydraulic_conductivity;  // by material [m/s]
  Real scaling_in_band = 1;                  // xi
  bool starts = true;                        // the first step is that of t = 0
  bool scales_all = true;                    // and elsewhere too
};

template <int Dim, class Real>
struct StepModel {
  Real cell = 0;                 // mesh size [m]
  std::vector<Real> half_sizes;  // of particles, by body, in cells
  mpm::HeldSides<Dim> sides;     // that prescribe velocity
  Vector<Real, Dim> gravity;     // [m/s2]
  Real pic_share = 0;            // of new velocities
  Real mass_damping = 0;         // [1/s]
  std::vector<mpm::MaterialModel<Real>> materials;
  physics::Phases<Real> phases;
  bool effective_stress = false;  // the pore pressure acts inside the body too
  bool lubrication = true;        // off: the base sees the initial porosity and saturation
  mpm::DomainFaces<Dim, Real> faces;
  Vector<Real, Dim> lower, upper;  // particles may be between these [m]
  terrain::BasalLaw<Real> base;
  bool base_holds = false;              // no slip at all
  bool pore_pressure = true;            // off: P = 0 at contact nodes
  std::optional<HeatModel<Real>> heat;  // none: temperatures rest
  bool distance_check = false;          // a node may close its clearance before contact acts
};

// Tells what the nodes of a block know of the ground: of all nodes, x fastest. Empty where there is no ground.
template <int Dim, class Real>
using AskGround = std::function<void(std::uint64_t block, terrain::GroundAtNode<Dim, Real>* nodes)>;

// Sums over particles and nodes of one step; energies [J].
template <int Dim, class Real>
struct StepSums {
  terrain::ContactWork<Dim, Real> contact;
  Real particle_kinetic = 0;  // as mpm::MoveWork
  Real mapped_back = 0;       // work of internal forces at mid-step velocities less that at the mapped-back ones
  mpm::Deformed<Real> deformed;
  Real band_rescale = 0;  // heat by another scaling
  band::HeatGain<Real> heat;
  mpm::BadParticle bad;  // after the particles have moved
};

}  // namespace thawslide::device
