// Energy and momentum budget: terms accumulated over all steps since t = 0. Energies in [J].
#pragma once

#include "base/linear.hpp"
#include "device/step_sums.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

using device::StepSums;

template <int Dim>
struct Budget {
  // Mechanical: stress work by kind, work of contact and constraints.
  double stress_work = 0, plastic = 0, viscous = 0, damping = 0, pore_work = 0;
  double friction_work = 0, contact_loss = 0, frame_work = 0;
  // Energy gained or lost by the transfers, computed directly and not as a residual. It is the kinetic energy that FLIP
  // adds to particles minus the gain at the nodes, sum m_p |dv_p|^2/2 - sum m_i |dv_i|^2/2. To this is added the work
  // of internal forces at the nodes' mid-step velocity minus that at the mapped-back (MUSL) velocity, which defines the
  // stress work.
  double numerical = 0;
  // Thermal.
  double friction_heat = 0, converted = 0, boundary_heat = 0, band_rescale = 0, advection = 0, capacity_heat = 0,
         drained_heat = 0;
  // Water lost by seepage [kg]: at the surface, to frozen pores, and as gained by particles that left.
  double drained_water = 0, vented_water = 0, left_seeped = 0;
  // Impulses on the slide [N s]: gravity, ground, and constraints (walls, frames and mass damping).
  Vector<double, Dim> gravity_impulse = Vector<double, Dim>::Zero();
  Vector<double, Dim> ground_impulse = Vector<double, Dim>::Zero();
  Vector<double, Dim> constraint_impulse = Vector<double, Dim>::Zero();
  // At t = 0; mass [kg], momentum [kg m/s].
  double initial_mechanical = 0, initial_thermal = 0, initial_mass = 0;
  Vector<double, Dim> initial_momentum = Vector<double, Dim>::Zero();
  // Contributed by appended particles.
  double joined_mechanical = 0, joined_thermal = 0, joined_mass = 0;
  Vector<double, Dim> joined_momentum = Vector<double, Dim>::Zero();
  // Entrainment from an erodible bed: work lost by the slide, the part of it that became heat of joining particles, and
  // the impulse.
  double bed_work = 0, bed_heat = 0, bed_joined_mass = 0, bed_joined_kinetic = 0;
  Vector<double, Dim> bed_impulse = Vector<double, Dim>::Zero();
  // Carried away by particles that left or were removed.
  double left_mechanical = 0, left_thermal = 0, left_mass = 0;
  double removed_mass = 0;  // part of left_mass removed by guards
  Vector<double, Dim> left_momentum = Vector<double, Dim>::Zero();

  // Calls visit(number) for each number above, in order.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (double* totals : {&stress_work,     &plastic,           &viscous,         &damping,
                           &friction_work,   &contact_loss,      &frame_work,      &numerical,
                           &pore_work,       &friction_heat,     &converted,       &boundary_heat,
                           &band_rescale,    &advection,         &capacity_heat,   &initial_mechanical,
                           &initial_thermal, &initial_mass,      &left_mechanical, &left_thermal,
                           &left_mass,       &joined_mechanical, &joined_thermal,  &joined_mass,
                           &drained_heat,    &drained_water,     &vented_water,    &left_seeped,
                           &bed_work,        &bed_heat,          &bed_joined_mass, &bed_joined_kinetic,
                           &removed_mass}) {
      visit(*totals);
    }
    for (Vector<double, Dim>* impulse : {&gravity_impulse, &ground_impulse, &constraint_impulse, &initial_momentum,
                                         &left_momentum, &joined_momentum, &bed_impulse}) {
      for (int a = 0; a < Dim; ++a) {
        visit((*impulse)[a]);
      }
    }
  }
};

// Adds contact and all terms that act on the slide as a whole. has_bed: an erodible bed was in reach.
template <int Dim>
void add_contact(const terrain::ContactWork<Dim>& contact, const Model<Dim>& model, bool has_bed, double dt,
                 Budget<Dim>& budget) {
  budget.friction_work += contact.friction_work;
  budget.converted += model.band.heat ? contact.converted : contact.friction_work;
  budget.contact_loss += contact.loss;
  budget.frame_work += contact.frame_work;
  budget.damping += contact.damping;
  budget.gravity_impulse += dt * (budget.initial_mass + budget.joined_mass - budget.left_mass) * model.motion.gravity;
  budget.ground_impulse -= dt * contact.force;
  budget.constraint_impulse += contact.constraint_impulse;
  if (has_bed) {
    budget.bed_work += contact.bed_work;
    budget.bed_impulse += contact.bed_impulse;
  }
}

// Adds all terms of a step of dt [s].
template <int Dim>
void add_step(const StepSums<Dim>& sums, const Setup<Dim>& setup, bool has_bed, double dt, Budget<Dim>& budget) {
  const Model<Dim>& model = setup.model;
  if (setup.parameters.mechanics.enabled) {
    add_contact(sums.contact, model, has_bed, dt, budget);
  }
  budget.contact_loss += sums.between_bodies.loss;
  budget.numerical += sums.particle_kinetic - sums.contact.node_kinetic;
  budget.numerical += sums.filtered;
  budget.numerical += sums.mapped_back;
  budget.numerical += sums.between_bodies.numerical;
  const mpm::StressWork& work = sums.deformed.work;
  budget.stress_work += work.total;
  budget.plastic += work.plastic;
  budget.viscous += work.viscous;
  budget.pore_work += model.motion.effective_stress ? work.pore : 0.0;
  budget.band_rescale += model.band.heat ? sums.band_rescale : 0.0;
  // With band columns the temperature of the body is constant.
  budget.friction_heat +=
      model.contact.band_columns ? sums.contact.friction_work - sums.contact.converted : sums.heat.friction;
  budget.boundary_heat += sums.heat.boundary;
  budget.advection += sums.heat.advection;
  budget.capacity_heat += sums.heat.capacity;
  budget.drained_water += sums.water.drained.mass;
  budget.drained_heat += sums.water.drained.heat;
  budget.vented_water += sums.water.vented(model.band.phases);
}

}  // namespace thawslide::sim
