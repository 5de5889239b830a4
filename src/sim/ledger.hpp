// Where the energy went: what each step adds to each account, since t = 0 [J].
#pragma once

namespace thawslide::sim {

template <class Real>
struct Ledger {
  // Mechanical: stress work by kind, work of contact and constraints.
  Real stress_work = 0, plastic = 0, viscous = 0, damping = 0;
  Real friction_work = 0, contact_loss = 0, frame_work = 0;
  // What the transfers make or lose, computed and not left over: the kinetic energy that FLIP gives particles less what
  // nodes gained, sum m_p |dv_p|^2/2 - sum m_i |dv_i|^2/2; and the work of internal forces at the nodes' mid-step
  // velocity less that at the mapped-back (MUSL) velocity, which is what the stress work books.
  Real numerical = 0;
  // Thermal.
  Real friction_heat = 0, boundary_heat = 0, band_rescale = 0, advection = 0;
  // At t = 0.
  Real initial_mechanical = 0, initial_thermal = 0;
};

}  // namespace thawslide::sim
