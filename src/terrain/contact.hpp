// Contact with the ground at the nodes (Eqs. 15-17, 20, 25; Nairn 2013; Nairn et al. 2018), and nodal motion. The trial
// momentum is corrected once: correcting both the old momentum and the force, as Eq. 15 reads, would count contact
// twice.
#pragma once

#include "mpm/constraints.hpp"
#include "mpm/nodes.hpp"
#include "mpm/section_width.hpp"
#include "terrain/bed_on_grid.hpp"
#include "terrain/contact_stage.hpp"
#include "terrain/contact_work.hpp"
#include "terrain/strength_law.hpp"

namespace thawslide::terrain {

template <int Dim>
struct ContactModel : ContactOptions {
  BasalLaw law;
  mpm::SectionWidth width;    // of a 2D section
  bool reads_mass = true;     // the laws depend on P, T, S, n_e or the slip of the mass at nodes
  bool band_columns = false;  // the basal state is that of nodes.base_states
};

// Fills nodes.base of the blocks with candidate nodes: load on the ground and covered area. Requires the clearance in
// nodes.near_ground of this step.
template <int Dim>
void press_on_ground(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                     const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model, double time, double dt,
                     mpm::Nodes<Dim>& nodes);

// True if a loaded node has no band column in reach (nodes.base_states).
template <int Dim>
bool loads_bare_ground(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes);

// From nodal momentum and force to nodal motion: trial momentum, constraints, contact. `ground` may be null; with
// ground, call press_on_ground before. Requires the clearance of this step, and if the mass is read, also
// nodes.averages, nodes.state and nodes.near_ground, except at nodes with band columns. bed: after distribute(); may be
// null. strength: replaces the strengths of the case's laws unless it is null or the base is fixed.
template <int Dim>
ContactWork<Dim> resolve_contact(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                                 const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model, double time,
                                 double dt, mpm::Nodes<Dim>& nodes, const BedOnGrid<Dim>* bed = nullptr,
                                 const StrengthLaw* strength = nullptr);

// Initializes nodes.contact before the first motion, without contact. `ground` may be null.
template <int Dim>
void start_contact(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground, mpm::Nodes<Dim>& nodes);

}  // namespace thawslide::terrain
