// What contact leaves in the balances. For host and device.
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"

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

  THAWSLIDE_HD ContactWork& operator+=(const ContactWork& part) {
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

}  // namespace thawslide::terrain
