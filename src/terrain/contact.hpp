// Contact with the ground on the CPU (terrain/contact_stage.hpp).
#pragma once

#include <functional>

#include "exec/cpu.hpp"
#include "mpm/constraints.hpp"
#include "mpm/motion.hpp"
#include "terrain/contact_stage.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Particles, nodes and ground in contact.
template <int Dim>
struct SlideOnGround {
  const mpm::SparseGrid<Dim>& grid;
  const GroundOnGrid<Dim>* ground;  // null if there is none
  const mpm::Constraints<Dim>& constraints;
  const mpm::MotionModel<Dim>& motion;
  const ContactModel& contact;
  mpm::Particles<Dim>& particles;
  mpm::Nodes<Dim>& nodes;
};

// Sets particles.contact_offset [m], the height at which a particle touches the ground, for particles at memory index
// `first` and above. The lowest particles of a body that rests on the ground at the start touch at their initial
// height. Other particles touch with the lower side of their box. sizes: half sizes of particles, in cells.
template <int Dim>
void set_contact_offset(const mpm::BodySizes& sizes, double cell, mpm::Particles<Dim>& particles,
                        std::size_t first = 0);

// Initializes nodes.contact, and marks the particles in the band, before the first motion and without mechanics.
template <int Dim>
void start_contact(const SlideOnGround<Dim>& slide);

template <int Dim>
class ContactOnCpu {
 public:
  // As ContactStage::resolve, in a step of dt from `time` [s]. Requires nodes.momentum, and if the mass is read, also
  // nodes.averages and nodes.state, except at nodes with band columns. Fills nodes.near_ground and nodes.base of
  // candidate nodes, nodes.contact and nodes.motion.
  ContactWork<Dim> resolve(const SlideOnGround<Dim>& slide, double time, double dt,
                           const mpm::BaseStates<Dim>& columns = {}, const std::function<void()>& average_band = {},
                           Bed<Dim>* bed = nullptr, const StrengthLaw* strength = nullptr, double of_walls = 0.0);

 private:
  exec::Cpu cpu_;
  ContactStage<exec::Cpu, Dim> stage_{cpu_};
};

// Sums the momenta that particles mapped back (MUSL), applies constraints again, and converts them to nodal velocities
// (MapBack). Returns sum f_int.(v_mid - v_mapped) dt [J]: the work of internal forces on the nodes, minus the stress
// work at the mapped-back velocities.
template <int Dim>
double constrain_mapped_back(const SlideOnGround<Dim>& slide, double time, double dt);

}  // namespace thawslide::terrain
