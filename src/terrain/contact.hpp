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

}  // namespace thawslide::terrain
