// Contact of the slide with the ground at the nodes (Eqs. 15-17, 20, 25; Nairn 2013; Nairn et al. 2018), and how the
// nodes move. The trial momentum is corrected once: correcting the old momentum and the force by the same amount, as
// Eq. 15 reads, would count contact twice.
#pragma once

#include "mpm/constraints.hpp"
#include "mpm/nodes.hpp"
#include "mpm/section_width.hpp"
#include "terrain/basal_law.hpp"
#include "terrain/bed.hpp"
#include "terrain/contact_work.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

template <int Dim, class Real>
struct ContactModel {
  BasalLaw<Real> law;
  mpm::SectionWidth<Real> width;  // of a 2D section
  bool base_holds = false;        // no slip at all: while gravity is being settled in
  bool pore_pressure = true;      // off: P = 0 at contact nodes (mechanism P of Sec. 3.3)
  bool band_columns = false;      // the base's state is that of nodes.base_state
  Real mass_damping = 0;          // [1/s]
  bool distance_check = false;    // a node may close its clearance before contact acts
};

// Fills nodes.base of the blocks that have candidate nodes: how every candidate node presses on the ground, and the
// area it covers. The clearance in nodes.near_ground must be that of this step.
template <int Dim, class Real>
void press_on_ground(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                     const mpm::Constraints<Dim, Real>& constraints, const ContactModel<Dim, Real>& model, Real time,
                     Real dt, mpm::Nodes<Dim, Real>& nodes);

// Whether a node that presses on the ground sees no band column (nodes.base_state).
template <int Dim, class Real>
bool loads_bare_ground(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Nodes<Dim, Real>& nodes);

// From nodal momentum and force to nodal motion: trial momentum, constraints, contact. `ground` may be null; with
// ground, press_on_ground comes before. nodes.averages, nodes.state and nodes.near_ground must hold what this step
// made, but for nodes that see band columns. What nodes take of the bed stands in nodes.bed; null: there is none.
template <int Dim, class Real>
ContactWork<Dim, Real> resolve_contact(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                                       const mpm::Constraints<Dim, Real>& constraints,
                                       const ContactModel<Dim, Real>& model, Real time, Real dt,
                                       mpm::Nodes<Dim, Real>& nodes, const Bed<Dim, Real>* bed = nullptr);

// Fills nodes.contact before anything has moved: no node is in contact. `ground` may be null.
template <int Dim, class Real>
void start_contact(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                   mpm::Nodes<Dim, Real>& nodes);

}  // namespace thawslide::terrain
