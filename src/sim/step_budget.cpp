// Budget terms of a step, on the CPU or on a device.
#include "band/heat.hpp"
#include "base/instances.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Adds contact and all terms that act on the slide as a whole.
template <int Dim>
void Simulation<Dim>::add_contact_energy() {
  budget_.friction_work += contact_.friction_work;
  budget_.converted += model_.band.heat ? contact_.converted : contact_.friction_work;
  budget_.contact_loss += contact_.loss;
  budget_.frame_work += contact_.frame_work;
  budget_.damping += contact_.damping;
  budget_.gravity_impulse +=
      dt_ * (budget_.initial_mass + budget_.joined_mass - budget_.left_mass) * model_.motion.gravity;
  budget_.ground_impulse -= dt_ * contact_.force;
  budget_.constraint_impulse += contact_.constraint_impulse;
}

template <int Dim>
void Simulation<Dim>::add_bed_energy() {
  if (bed_in_reach() != nullptr) {
    budget_.bed_work += contact_.bed_work;
    budget_.bed_impulse += contact_.bed_impulse;
  }
}

template <int Dim>
void Simulation<Dim>::add_stress_work(const mpm::StressWork& work) {
  budget_.stress_work += work.total;
  budget_.plastic += work.plastic;
  budget_.viscous += work.viscous;
  budget_.pore_work += model_.motion.effective_stress ? work.pore : Real(0);
}

template <int Dim>
void Simulation<Dim>::add_heat_gain(const band::HeatGain& gain) {
  budget_.friction_heat += gain.friction;
  budget_.boundary_heat += gain.boundary;
  budget_.advection += gain.advection;
  budget_.capacity_heat += gain.capacity;
  budget_.porosity_heat += gain.porosity;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                        \
  template void Simulation<Dim>::add_contact_energy();                    \
  template void Simulation<Dim>::add_bed_energy();                        \
  template void Simulation<Dim>::add_stress_work(const mpm::StressWork&); \
  template void Simulation<Dim>::add_heat_gain(const band::HeatGain&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
