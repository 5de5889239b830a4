// Particles that have left the domain, or the part of the terrain that is known: they end the run, or are removed and
// counted, as the case has it.
#include <algorithm>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "sim/simulation.hpp"
#include "sim/slide_left.hpp"

namespace thawslide::sim {

// Marks the particles beyond the sides of the domain.
template <int Dim, class Real>
void mark_left_domain(const mpm::Particles<Dim, Real>& particles, const Vector<Real, Dim>& extent,
                      std::vector<std::uint8_t>& left) {
  constexpr std::size_t of_a_task = 1024;
  parallel_for((left.size() + of_a_task - 1) / of_a_task, [&](std::size_t task) {
    for (std::size_t p = task * of_a_task; p < std::min(left.size(), (task + 1) * of_a_task); ++p) {
      for (int a = 0; a < Dim; ++a) {
        if (particles.position(p, a) < Real(0) || particles.position(p, a) > extent[a]) {
          left[p] = 1;
        }
      }
    }
  });
}

template <int Dim, class Real>
void Simulation<Dim, Real>::handle_left_particles() {
  const bool removes = parameters_.grid.leaving == config::Leaving::remove;
  left_.assign(removes ? particles_.size() : 0, 0);
  mark_left_domain<Dim, Real>(particles_, model_.constraints.extent, left_);
  const std::size_t tiles = model_.ground ? grid_.tiles().size() : 0;
  bad_ += parallel_sum<mpm::BadParticle>(tiles, [&](std::size_t t, mpm::BadParticle& bad) {
    // The tile's own block stands in the middle of those about it; its ground is looked at a cell further.
    const auto own = static_cast<std::size_t>(grid_.blocks_about_tile(t)[mpm::Tile<Dim>::stencil / 2]);
    if (!ground_.partly_unknown(own)) {
      return;
    }
    for (std::uint32_t k = grid_.tiles()[t].first; k < grid_.tiles()[t].last; ++k) {
      const std::uint32_t p = grid_.order()[k];
      const auto place = particles_.position.template get<Vector<Real, Dim - 1>>(p).template cast<double>();
      if (!model_.ground->is_known(place)) {
        if (removes) {
          left_[p] = 1;
        } else {
          bad.note(particles_.id(p), mpm::Fault::left_map);
        }
      }
    }
  });
  stop_if_bad();
  const auto count = static_cast<std::size_t>(std::count(left_.begin(), left_.end(), std::uint8_t{1}));
  if (count == 0) {
    return;
  }
  const BodySums<Dim, Real> sums = sum_over_body(*this, &left_);
  if (count == particles_.size()) {
    throw SlideLeft(fmt::format(
        "the whole slide has left the domain or the known ground at t = {:.6g} s (step {}); the last {:.4g} kg{} "
        "of it, which left in this step, still stand in mass_kg. Widen [grid] min and max, or give a DEM "
        "that reaches further, to follow it on.",
        time_, step_number_, static_cast<double>(sums.mass), Dim == 2 ? " per m of width" : ""));
  }
  ledger_.left_mass += sums.mass;
  ledger_.left_mechanical += sums.kinetic + sums.potential;
  ledger_.left_thermal += sums.sensible + sums.latent;
  ledger_.left_momentum += sums.momentum;
  ledger_.left_seeped += sums.seeped;
  grid_.remove(particles_, particles_.remove(left_));
  update_ground();
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) template void Simulation<Dim, Real>::handle_left_particles();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
