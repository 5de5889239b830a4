// Sums over the particles of a run: energies, masses, momentum, and what rows of the history tell the means of.
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim, class Real>
BodySums<Dim, Real> Simulation<Dim, Real>::sum_over_body() const {
  if (!device_step_) {
    return sum_over_particles(nullptr);
  }
  BodySums<Dim, Real> sums;
  on_device([&] { sums = device_step_->sum_over_body(summed_of_body()); });
  return sums;
}

template <int Dim, class Real>
BodySums<Dim, Real> Simulation<Dim, Real>::sum_over_marked(const std::vector<std::uint8_t>& marked) const {
  bring_particles_back();
  return sum_over_particles(marked.data());
}

// marked: by particle; null: all are.
template <int Dim, class Real>
BodySums<Dim, Real> Simulation<Dim, Real>::sum_over_particles(const std::uint8_t* marked) const {
  using Sums = BodySums<Dim, Real>;
  const band::SumBody<Dim, Real> sum_of = summed_of_body();
  return parallel_sum<Sums>(grid_.tiles().size(), [&](std::size_t t, Sums& sums) {
    for (std::uint32_t k = grid_.tiles()[t].first; k < grid_.tiles()[t].last; ++k) {
      const std::uint32_t p = grid_.order()[k];
      if (marked == nullptr || marked[p] != 0) {
        sums += sum_of(particles_, p);
      }
    }
  });
}

template <int Dim, class Real>
band::SumBody<Dim, Real> Simulation<Dim, Real>::summed_of_body() const {
  return {model_.motion.gravity,   model_.origin.template cast<Real>(), model_.motion.phases,
          parameters_.heat.latent, model_.band.current_masses,          model_.band.melt_contracts};
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                       \
  template BodySums<Dim, Real> Simulation<Dim, Real>::sum_over_body() const;                                   \
  template BodySums<Dim, Real> Simulation<Dim, Real>::sum_over_marked(const std::vector<std::uint8_t>&) const; \
  template BodySums<Dim, Real> Simulation<Dim, Real>::sum_over_particles(const std::uint8_t*) const;           \
  template band::SumBody<Dim, Real> Simulation<Dim, Real>::summed_of_body() const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
