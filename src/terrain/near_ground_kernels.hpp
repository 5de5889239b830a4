// Particle kernels (mpm/kernel.hpp) of contact: clearance and state of the mass near the ground for candidate nodes,
// and from these nodes the marks of band particles and their slip. GIMP shape functions reach nodes up to a cell ahead
// of the sliding mass; without a check of the clearance, contact acts from then on.
#pragma once

#include "base/select.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"
#include "physics/mixture.hpp"

namespace thawslide::terrain {

// n_e of Eq. 2 for the basal law, from the current or, without lubrication, initial state.
template <class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE typename At::Value basal_solid_fraction(const physics::Phases& phases,
                                                                             bool lubrication,
                                                                             const Particles& particles, const At& at) {
  const auto& porosity = lubrication ? particles.porosity : particles.initial_porosity;
  const auto& saturation = lubrication ? particles.liquid_saturation : particles.initial_saturation;
  return physics::effective_solid_fraction(phases, porosity.load(at), saturation.load(at));
}

// Reduces the clearance of nodes near the ground to the minimum: the larger of the height above the ground and the
// vertical distance from the node's plane, both of the lower side of the particle.
template <int Dim>
struct LowerClearance {
  using Reads = mpm::RecordList<mpm::Planes>;
  using Adds = mpm::RecordList<mpm::Clearance>;
  using Totals = mpm::NoTotals;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& /*totals*/) const {
    auto& gaps = added.template of<mpm::Clearance>();
    unrolled<static_cast<std::size_t>(Dim)>(
        [&](auto a) THAWSLIDE_INLINE_LAMBDA { gaps.position[a] = particles.position.load(at, static_cast<int>(a())); });
    const auto offset = particles.contact_offset.load(at);
    gaps.position[Dim - 1] -= offset;
    gaps.least = particles.height_above_ground.load(at) - offset;
    gaps.planes = seen.template planes<mpm::Planes>();
  }
};

// Scatters state and slip to the nodes near the ground, by mass with the momentum shape functions and by volume with
// the linear ones; reduces the clearance.
template <int Dim>
struct AddNearGround {
  using Reads = mpm::RecordList<mpm::Planes>;
  using Adds = mpm::RecordList<mpm::NearGround, mpm::NearGroundByLinear, mpm::Clearance>;
  using Totals = mpm::NoTotals;

  physics::Phases phases;
  bool lubrication;  // off: the solid fraction uses the initial porosity and saturation
  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& totals) const {
    using mpm::NearGround, mpm::NearGroundByLinear;
    using Value = typename At::Value;
    const Value mass = particles.mass.load(at), volume = particles.volume.load(at);
    const Value saturation = particles.liquid_saturation.load(at);
    const Value solid_fraction = basal_solid_fraction(phases, lubrication, particles, at);
    auto& by_mass = added.template of<NearGround>();
    by_mass.value[NearGround::temperature] = mass * particles.temperature.load(at);
    by_mass.value[NearGround::pore_pressure] = mass * particles.pore_pressure.load(at);
    by_mass.value[NearGround::saturation] = mass * saturation;
    by_mass.value[NearGround::solid_fraction] = mass * solid_fraction;
    by_mass.value[NearGround::slip] = mass * particles.slip.load(at);
    auto& by_linear = added.template of<NearGroundByLinear>();
    constexpr std::size_t first = mpm::first_in_register<NearGroundByLinear, Dim>;
    by_linear.value[NearGround::saturation_by_linear - first] = volume * saturation;
    by_linear.value[NearGround::solid_fraction_by_linear - first] = volume * solid_fraction;
    LowerClearance<Dim>{}(particles, at, seen, added, totals);
  }
};

// Resets the band mark: particles without a candidate node nearby are outside the band.
template <int Dim>
struct LeaveBand {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& /*added*/, Totals& /*totals*/) const {
    particles.in_band.store_whole(at, typename At::Value(0.0));
  }
};

// Marks particles in a cell with a candidate corner as band particles; adds nodal slip to particles in a cell with a
// contact node.
template <int Dim>
struct MarkBand {
  using Reads = mpm::RecordList<mpm::Contact>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  double dt;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& /*added*/, Totals& /*totals*/) const {
    using mpm::Contact;
    using Value = typename At::Value;
    const auto contact = seen.template read<Contact, 3>().value;
    const Value zero = 0.0, one = 1.0;
    particles.in_band.store_whole(at, select(contact[Contact::candidate] > zero, one, zero));
    const auto touches = contact[Contact::touching] > zero;
    if (any(touches)) {
      const Value slip_speed = contact[Contact::slip_speed] / select(touches, contact[Contact::touching], one);
      const Value slip = particles.slip.load(at);
      particles.slip.store(at, select(touches, slip + dt * slip_speed, slip));
    }
  }
};

}  // namespace thawslide::terrain
