// What the step tells of all particles, beside what it does to them: kernels (mpm/kernel.hpp).
#pragma once

#include "band/step_extremes.hpp"
#include "device/tile_tables.hpp"
#include "mpm/kernel.hpp"
#include "mpm/watched_sums.hpp"

namespace thawslide::device {

// For guards and rest.
template <int Dim, class Real>
struct Watch {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Account = mpm::WatchedSums<Real>;

  mpm::LookAtParticle<Dim, Real> look;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Added& /*added*/,
                               Account& sums) const {
    sums = look(particles, at.particle[0]);
  }
};

// For the next step.
template <int Dim, class Real>
struct FindExtremes {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Account = band::StepExtremes;

  band::BandPhysics<Real> physics;
  band::HydraulicConductivity<Real> hydraulic;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Added& /*added*/,
                               Account& found) const {
    found = band::extremes_of_particle<Dim>(physics, hydraulic, particles, at.particle[0]);
  }
};

// How many particles the processor has to look at: they are beyond the sides of the domain, or where the ground is not
// known all about the block that their step began in.
template <int Dim, class Real>
struct CountStrays {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Account = std::uint64_t;

  const std::int32_t* blocks_about_tile;
  const std::uint8_t* partly_unknown;  // by block; null: the ground is known everywhere, or there is none
  Vector<Real, Dim> extent;            // of the domain [m]
  bool all_stray = false;              // of the tile

  [[nodiscard]] THAWSLIDE_HD CountStrays in_tile(std::size_t tile) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    CountStrays of_tile = *this;
    of_tile.all_stray =
        partly_unknown != nullptr && partly_unknown[blocks_about_tile[tile * stencil + stencil / 2]] != 0;
    return of_tile;
  }

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Added& /*added*/,
                               Account& strays) const {
    bool strays_off = all_stray;
    for (int a = 0; a < Dim; ++a) {
      const Real position = particles.position(at.particle[0], a);
      strays_off = strays_off || position < Real(0) || position > extent[a];
    }
    strays = strays_off ? 1 : 0;
  }
};

}  // namespace thawslide::device
