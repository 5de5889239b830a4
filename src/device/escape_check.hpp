// Particles that need a check on the CPU: those outside the domain, and those that began the step in a block with
// no-data ground in or around it. They are counted after each step, and listed if there are any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/tile_tables.hpp"
#include "exec/array.hpp"
#include "mpm/kernel.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// Counts escaped particles: a kernel (mpm/kernel.hpp).
template <int Dim>
struct CountEscaped {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = std::uint64_t;

  const std::int32_t* blocks_about_tile;
  const std::uint8_t* partly_unknown;  // by block; null: no ground, or ground known everywhere
  Vector<double, Dim> extent;          // of the domain [m]
  bool all_escaped = false;            // all particles of the tile count as escaped

  [[nodiscard]] THAWSLIDE_HD CountEscaped in_tile(std::size_t tile) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    CountEscaped of_tile = *this;
    of_tile.all_escaped =
        partly_unknown != nullptr && partly_unknown[blocks_about_tile[tile * stencil + stencil / 2]] != 0;
    return of_tile;
  }

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD bool escapes(const Particles& particles, std::uint32_t p) const {
    bool has_escaped = all_escaped;
    for (int a = 0; a < Dim; ++a) {
      const double position = particles.position(p, a);
      has_escaped = has_escaped || position < 0.0 || position > extent[a];
    }
    return has_escaped;
  }

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& count) const {
    count = escapes(particles, at.particle[0]) ? 1 : 0;
  }
};

// Marks each escaped particle.
template <int Dim>
struct MarkEscaped {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  CountEscaped<Dim> count;
  std::uint32_t* marks;  // by particle: 1 or 0

  [[nodiscard]] THAWSLIDE_HD MarkEscaped in_tile(std::size_t tile) const { return {count.in_tile(tile), marks}; }

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& /*totals*/) const {
    marks[at.particle[0]] = count.escapes(particles, at.particle[0]) ? 1 : 0;
  }
};

// Compacts the positions of marked particles.
template <int Dim>
struct ListEscaped {
  mpm::ParticleView<Dim> particles;
  const std::uint32_t* marks;
  const std::uint32_t* marked_before;
  Vector<double, Dim>* indices;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    if (marks[p] != 0) {
      for (int a = 0; a < Dim; ++a) {
        indices[marked_before[p]][a] = particles.position(p, a);
      }
    }
  }
};

template <class Backend, int Dim>
class EscapeCheck {
 public:
  explicit EscapeCheck(Backend& backend) : marks_(backend), marked_before_(backend), places_(backend) {}

  // Positions [m] of the escaped particles. escapes: their number.
  template <class Passes>
  std::vector<Vector<double, Dim>> indices(Passes& passes, const CountEscaped<Dim>& count, std::size_t escapes) {
    const std::size_t particles = passes.particles.size();
    marks_.resize(particles);
    marked_before_.resize(particles);
    places_.resize(escapes);
    passes.run(passes.linear(), MarkEscaped<Dim>{count, marks_.data()});
    passes.backend.sum_before(marks_.data(), marked_before_.data(), particles);
    passes.backend.for_each(
        particles, ListEscaped<Dim>{passes.particles.view(), marks_.data(), marked_before_.data(), places_.data()});
    return places_.get();
  }

 private:
  exec::Array<std::uint32_t, Backend> marks_, marked_before_;
  exec::Array<Vector<double, Dim>, Backend> places_;
};

}  // namespace thawslide::device
