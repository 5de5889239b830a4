// Particles that have left the domain, or the part of the terrain that is known: they end the run, or are removed and
// counted, as the case has it.
#include "base/error.hpp"
#include "base/instances.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim, class Real>
void Simulation<Dim, Real>::handle_left_particles() {
  const bool removes = parameters_.grid.leaving == config::Leaving::remove;
  left_.assign(removes ? particles_.size() : 0, 0);
  std::size_t count = 0;
  const auto take = [&](std::uint32_t p, mpm::Fault fault) {
    if (!removes) {
      bad_.note(particles_.id(p), fault);
    } else if (left_[p] == 0) {
      left_[p] = 1;
      ++count;
    }
  };
  for (std::size_t p = 0; removes && p < particles_.size(); ++p) {
    for (int a = 0; a < Dim; ++a) {
      if (particles_.position(p, a) < Real(0) || particles_.position(p, a) > model_.constraints.extent[a]) {
        take(static_cast<std::uint32_t>(p), mpm::Fault::left_domain);
      }
    }
  }
  for (std::size_t t = 0; model_.ground && t < grid_.tiles().size(); ++t) {
    // The tile's own block stands in the middle of those about it; its ground is looked at a cell further.
    const auto own = static_cast<std::size_t>(grid_.blocks_about_tile(t)[mpm::Tile<Dim>::stencil / 2]);
    if (!ground_.partly_unknown(own)) {
      continue;
    }
    for (std::uint32_t k = grid_.tiles()[t].first; k < grid_.tiles()[t].last; ++k) {
      const std::uint32_t p = grid_.order()[k];
      const auto place = particles_.position.template get<Vector<Real, Dim - 1>>(p).template cast<double>();
      if (!model_.ground->is_known(place)) {
        take(p, mpm::Fault::left_map);
      }
    }
  }
  stop_if_bad();
  if (count == 0) {
    return;
  }
  if (count == particles_.size()) {
    throw RunError(
        fmt::format("the run ended at t = {:.6g} s (step {}): the rest of the slide is leaving the domain, and "
                    "grid.leaving is \"remove\". Widen [grid] min and max to follow it further.",
                    time_, step_number_));
  }
  const BodySums<Dim, Real> sums = sum_over_body(*this, &left_);
  ledger_.left_mass += sums.mass;
  ledger_.left_mechanical += sums.kinetic + sums.potential;
  ledger_.left_thermal += sums.sensible + sums.latent;
  ledger_.left_momentum += sums.momentum;
  particles_.remove(left_);
  grid_ = mpm::SparseGrid<Dim, Real>(static_cast<Real>(parameters_.grid.cell));
  find_particles_cells();
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) template void Simulation<Dim, Real>::handle_left_particles();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
