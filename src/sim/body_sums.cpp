// Sums over the particles of a run: energies, masses, momentum, and sums for the means in the history.
#include "base/instances.hpp"
#include "device/solver.hpp"
#include "mpm/sum_over_particles.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
BodySums<Dim> Simulation<Dim>::sum_over_body() const {
  if (!device_solver_) {
    return sum_over_particles(nullptr);
  }
  BodySums<Dim> sums;
  on_device([&] { sums = device_solver_->sum_over_body(sums_of_particle()); });
  return sums;
}

template <int Dim>
BodySums<Dim> Simulation<Dim>::sum_over_marked(const std::vector<std::uint8_t>& marked) const {
  sync_to_host();
  return sum_over_particles(marked.data());
}

// marked: by particle; null selects all particles.
template <int Dim>
BodySums<Dim> Simulation<Dim>::sum_over_particles(const std::uint8_t* marked) const {
  using Sums = BodySums<Dim>;
  const band::SumsOfParticle<Dim> of_particle = sums_of_particle();
  return mpm::sum_over_particles<Sums>(grid_, [&](std::uint32_t p) {
    return marked == nullptr || marked[p] != 0 ? of_particle(particles_, p) : Sums{};
  });
}

template <int Dim>
band::SumsOfParticle<Dim> Simulation<Dim>::sums_of_particle() const {
  return {model_.motion.gravity,
          model_.origin.template cast<Real>(),
          model_.motion.phases,
          parameters_.heat.latent,
          model_.band.current_masses,
          model_.band.melt_contracts,
          static_cast<Real>(parameters_.time.moved_distance)};
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                 \
  template BodySums<Dim> Simulation<Dim>::sum_over_body() const;                                   \
  template BodySums<Dim> Simulation<Dim>::sum_over_marked(const std::vector<std::uint8_t>&) const; \
  template BodySums<Dim> Simulation<Dim>::sum_over_particles(const std::uint8_t*) const;           \
  template band::SumsOfParticle<Dim> Simulation<Dim>::sums_of_particle() const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
