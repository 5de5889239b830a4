// Where energy and momentum went: what each step adds to each account, since t = 0. Energies in [J].
#pragma once

#include "base/linear.hpp"

namespace thawslide::sim {

template <int Dim, class Real>
struct Ledger {
  // Mechanical: stress work by kind, work of contact and constraints.
  Real stress_work = 0, plastic = 0, viscous = 0, damping = 0, pore_work = 0;
  Real friction_work = 0, contact_loss = 0, frame_work = 0;
  // What the transfers make or lose, computed and not left over: the kinetic energy that FLIP gives particles less what
  // nodes gained, sum m_p |dv_p|^2/2 - sum m_i |dv_i|^2/2; and the work of internal forces at the nodes' mid-step
  // velocity less that at the mapped-back (MUSL) velocity, which is what the stress work books.
  Real numerical = 0;
  // Thermal.
  Real friction_heat = 0, converted = 0, boundary_heat = 0, band_rescale = 0, advection = 0, capacity_heat = 0,
       porosity_heat = 0, drained_heat = 0;
  // Water that seepage took [kg]: at the surface, to frozen pores, and what particles that left had gained by it.
  Real drained_water = 0, vented_water = 0, left_seeped = 0;
  // Impulses on the slide [N s]: of gravity, of the ground, of walls, frames and mass damping.
  Vector<Real, Dim> gravity_impulse = Vector<Real, Dim>::Zero();
  Vector<Real, Dim> ground_impulse = Vector<Real, Dim>::Zero();
  Vector<Real, Dim> constraint_impulse = Vector<Real, Dim>::Zero();
  // At t = 0; mass [kg], momentum [kg m/s].
  Real initial_mechanical = 0, initial_thermal = 0, initial_mass = 0;
  Vector<Real, Dim> initial_momentum = Vector<Real, Dim>::Zero();
  // Brought in by particles that were appended.
  Real joined_mechanical = 0, joined_thermal = 0, joined_mass = 0;
  Vector<Real, Dim> joined_momentum = Vector<Real, Dim>::Zero();
  // Taken from an erodible bed: work that the slide lost to what it took up, what of it became heat of particles that
  // joined, and the impulse.
  Real bed_work = 0, bed_heat = 0, bed_joined_mass = 0, bed_joined_kinetic = 0;
  Vector<Real, Dim> bed_impulse = Vector<Real, Dim>::Zero();
  // Carried away by particles that left and were removed.
  Real left_mechanical = 0, left_thermal = 0, left_mass = 0;
  Real removed_mass = 0;  // of left_mass, by guards
  Vector<Real, Dim> left_momentum = Vector<Real, Dim>::Zero();

  // Calls visit(number) with each of the numbers above, in order.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (Real* account : {&stress_work,        &plastic,         &viscous,           &damping,
                          &friction_work,      &contact_loss,    &frame_work,        &numerical,
                          &pore_work,          &friction_heat,   &converted,         &boundary_heat,
                          &band_rescale,       &advection,       &capacity_heat,     &porosity_heat,
                          &initial_mechanical, &initial_thermal, &initial_mass,      &left_mechanical,
                          &left_thermal,       &left_mass,       &joined_mechanical, &joined_thermal,
                          &joined_mass,        &drained_heat,    &drained_water,     &vented_water,
                          &left_seeped,        &bed_work,        &bed_heat,          &bed_joined_mass,
                          &bed_joined_kinetic, &removed_mass}) {
      visit(*account);
    }
    for (Vector<Real, Dim>* impulse : {&gravity_impulse, &ground_impulse, &constraint_impulse, &initial_momentum,
                                       &left_momentum, &joined_momentum, &bed_impulse}) {
      for (int a = 0; a < Dim; ++a) {
        visit((*impulse)[a]);
      }
    }
  }
};

}  // namespace thawslide::sim
