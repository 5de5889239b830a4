// Budget terms of a step, on the CPU or on a device.
#include "base/instances.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Adds contact and all terms that act on the slide as a whole.
template <int Dim>
void Simulation<Dim>::add_contact_energy() {
  ledger_.friction_work += contact_.friction_work;
  ledger_.converted += model_.band.heat ? contact_.converted : contact_.friction_work;
  ledger_.contact_loss += contact_.loss;
  ledger_.frame_work += contact_.frame_work;
  ledger_.damping += contact_.damping;
  ledger_.gravity_impulse +=
      dt_ * (ledger_.initial_mass + ledger_.joined_mass - ledger_.left_mass) * model_.motion.gravity;
  ledger_.ground_impulse -= dt_ * contact_.force;
  ledger_.constraint_impulse += contact_.constraint_impulse;
}

template <int Dim>
void Simulation<Dim>::add_bed_energy() {
  if (bed_in_reach() != nullptr) {
    ledger_.bed_work += contact_.bed_work;
    ledger_.bed_impulse += contact_.bed_impulse;
  }
}

template <int Dim>
void Simulation<Dim>::add_stress_work(const mpm::StressWork& work) {
  ledger_.stress_work += work.total;
  ledger_.plastic += work.plastic;
  ledger_.viscous += work.viscous;
  ledger_.pore_work += model_.motion.effective_stress ? work.pore : Real(0);
}

template <int Dim>
void Simulation<Dim>::add_heat_gain(const band::HeatGain& gain) {
  ledger_.friction_heat += gain.friction;
  ledger_.boundary_heat += gain.boundary;
  ledger_.advection += gain.advection;
  ledger_.capacity_heat += gain.capacity;
  ledger_.porosity_heat += gain.porosity;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                        \
  template void Simulation<Dim>::add_contact_energy();                    \
  template void Simulation<Dim>::add_bed_energy();                        \
  template void Simulation<Dim>::add_stress_work(const mpm::StressWork&); \
  template void Simulation<Dim>::add_heat_gain(const band::HeatGain&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
