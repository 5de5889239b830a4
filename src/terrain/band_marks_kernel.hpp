// Particle kernels (mpm/kernel.hpp) of mark_band_and_slip.
#pragma once

#include "base/select.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"

namespace thawslide::terrain {

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
