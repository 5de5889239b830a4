// Contribution of contact to the energy and momentum budgets. For host and device.
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::terrain {

// Sums over contact and constraints in one step. Energies [J], forces [N], areas [m2].
template <int Dim>
struct ContactWork {
  double friction_work = 0;                                 // dissipated by sliding
  double loss = 0;                                          // dissipated by impact on ground and walls, and by sticking
  double frame_work = 0;                                    // done by rigid frames on the sliding mass
  double converted = 0;                                     // friction work not converted to heat
  double damping = 0;                                       // dissipated by mass damping
  double node_kinetic = 0;                                  // sum m |a dt|^2 / 2 over nodes
  double area = 0;                                          // in contact
  double friction_area = 0;                                 // sum mu_e A
  double shear_force = 0;                                   // of the ground on the sliding mass, in any direction
  double bed_work = 0;                                      // lost to entrained bed material
  Vector<double, Dim> force = Vector<double, Dim>::Zero();  // on the ground
  // On the sliding mass, from walls, frames and mass damping [N s].
  Vector<double, Dim> constraint_impulse = Vector<double, Dim>::Zero();
  Vector<double, Dim> bed_impulse = Vector<double, Dim>::Zero();  // on entrained bed material [N s]

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
