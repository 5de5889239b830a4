// Contact of the slide with the ground at the nodes (Eqs. 15-17, 20, 25; Nairn 2013; Nairn et al. 2018), and how the
// nodes move. The trial momentum is corrected once: correcting the old momentum and the force by the same amount, as
// Eq. 15 reads, would count contact twice.
#pragma once

#include <algorithm>

#include "mpm/constraints.hpp"
#include "mpm/nodes.hpp"
#include "terrain/basal_law.hpp"
#include "terrain/bed.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// What contact and constraints did in one step. Energies [J], forces [N], areas [m2].
template <int Dim, class Real>
struct ContactWork {
  Real friction_work = 0;                               // dissipated by sliding
  Real loss = 0;                                        // taken by impact on ground and walls, and by sticking
  Real frame_work = 0;                                  // done by rigid frames on the slide
  Real converted = 0;                                   // friction work that does not become heat
  Real damping = 0;                                     // taken by mass damping
  Real node_kinetic = 0;                                // sum m |a dt|^2 / 2 over nodes
  Real area = 0;                                        // in contact
  Real friction_area = 0;                               // sum mu_e A
  Real shear_force = 0;                                 // of the ground on the slide, whichever way
  Real bed_work = 0;                                    // that the slide loses to bed matter that it takes up
  Vector<Real, Dim> force = Vector<Real, Dim>::Zero();  // on the ground
  // On the slide, of walls, frames and mass damping [N s].
  Vector<Real, Dim> constraint_impulse = Vector<Real, Dim>::Zero();
  Vector<Real, Dim> bed_impulse = Vector<Real, Dim>::Zero();  // of the slide on bed matter that it takes up [N s]

  ContactWork& operator+=(const ContactWork& part) {
    friction_work += part.friction_work;
    loss += part.loss;
    frame_work += part.frame_work;
    converted += part.converted;
    damping += part.damping;
    node_kinetic += part.node_kinetic;
    area += part.area;
    friction_area += part.friction_area;
    shear_force += part.shear_force;
    force += part.force;
    constraint_impulse += part.constraint_impulse;
    bed_work += part.bed_work;
    bed_impulse += part.bed_impulse;
    return *this;
  }
};

template <int Dim, class Real>
struct ContactModel {
  BasalLaw<Real> law;
  bool base_holds = false;      // no slip at all: while gravity is being settled in
  bool pore_pressure = true;    // off: P = 0 at contact nodes (mechanism P of Sec. 3.3)
  bool band_columns = false;    // the base's state is that of nodes.base_state
  Real mass_damping = 0;        // [1/s]
  bool distance_check = false;  // a node may close its clearance before contact acts
};

// From nodal momentum and force to nodal motion: trial momentum, constraints, contact. `ground` may be null.
// nodes.averages, nodes.state and, with ground, nodes.near_ground must hold what this step made. What nodes take of the
// bed stands in nodes.bed; null: there is none.
template <int Dim, class Real>
ContactWork<Dim, Real> resolve_contact(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                                       const mpm::Constraints<Dim, Real>& constraints,
                                       const ContactModel<Dim, Real>& model, Real time, Real dt,
                                       mpm::Nodes<Dim, Real>& nodes, const Bed<Dim, Real>* bed = nullptr);

// Fills nodes.contact before anything has moved: no node is in contact. `ground` may be null.
template <int Dim, class Real>
void start_contact(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                   mpm::Nodes<Dim, Real>& nodes);

// Momentum with which a node runs into the ground in this step, less what closes the clearance before it.
template <int Dim, class Real>
Real approach_of(const mpm::Nodes<Dim, Real>& nodes, std::size_t b, std::size_t k, bool distance_check, Real dt,
                 Real mass, Real inward_momentum) {
  return std::max(Real(0), distance_check
                               ? inward_momentum - mass * (nodes.near_ground(b, k)[mpm::NearGround::clearance] / dt)
                               : inward_momentum);
}

}  // namespace thawslide::terrain
