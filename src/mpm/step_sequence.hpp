// Sequence of the stages of a time step (Section 2.3 of the paper), written once for the CPU
// (sim/solver/cpu_solver.cpp) and for devices (device/step.hpp). All stages use the shape functions at the initial
// positions of the step.
//   m_i = sum S m,  p_i = sum S m v,  f_i = sum S m b - V sigma.G                              Eq. 12
//   P_i, S_i, n_i: averages with the linear shape functions                                    Eq. 21
//   f_i of bodies that do not share nodes: including the forces between them                   mpm/body_contact.hpp
//   p_i + f_i dt corrected by contact: N = p.n/(A dt), S_slide = mu_e (N - P) + c_S            Eqs. 15-17, 25
//   v_p += sum S a dt,  x_p += sum S (v_i + a_i dt/2) dt                                       Eqs. 13, 14
//   stress and porosity from the mapped-back velocities                                        Eqs. 11, 6
//   heat content from conduction, advection and the friction heat of the contact nodes         Eqs. 9, 18-20
//   pore pressure: Clapeyron, then thermal pressurization and seepage                          Eqs. 4, 8, 22, 23
#pragma once

namespace thawslide::mpm {

// Stages: has a function per stage, which does nothing if the case does not need it, and
//   measure(name, work): calls work(), a stage with a timer
//   moves(): off: heat and pore pressure only
//   rescaling_mixes(): changes of scaling change temperatures
// strength: replaces the basal laws of the case; or null.
template <class Stages, class StrengthLaw>
void perform_step(Stages& stages, double time, double dt, const StrengthLaw* strength) {
  stages.measure("find_cells", [&] { stages.find_cells(time); });
  stages.measure("average_band_on_grid", [&] {
    if (stages.rescaling_mixes()) {
      stages.rescale_band(time);
    }
    stages.average_band_on_grid(strength != nullptr);
  });
  if (stages.moves()) {
    stages.measure("momentum_to_grid", [&] { stages.momentum_to_grid(); });
    stages.measure("resolve_contact", [&] { stages.resolve_contact(time, dt, strength); });
    stages.measure("move_particles", [&] { stages.move_particles(time, dt); });
    stages.measure("update_stress_and_porosity", [&] { stages.update_stress_and_porosity(dt); });
  }
  stages.measure("conduct_heat", [&] {
    if (!stages.rescaling_mixes()) {
      stages.rescale_band(time);
    }
    stages.conduct_heat(dt);
  });
  stages.measure("drain_pore_pressure", [&] { stages.drain_pore_pressure(dt); });
  stages.measure("update_positions", [&] { stages.update_positions(); });
}

}  // namespace thawslide::mpm
