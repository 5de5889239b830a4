// Strain, rotation, stress, volume and porosity of particles (Eqs. 6, 11).
#include <cmath>

#include "base/instances.hpp"
#include "mpm/batch_transfer.hpp"
#include "mpm/motion.hpp"
#include "physics/kinematics.hpp"
#include "physics/tension_gap.hpp"

namespace thawslide::mpm {

namespace {

template <class Value>
THAWSLIDE_ALWAYS_INLINE Value double_contraction(const SymmetricTensor<Value>& a, const SymmetricTensor<Value>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + Value(2) * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

// What a law made of a batch's trial stresses, by lane; members as in physics::ReturnResult.
template <class Real>
struct Returned {
  Lanes<Real> stress[6];
  Lanes<Real> plastic_work_density = Real(0);
  Lanes<Real> opening = Real(0);
};

// Sends the particles of a mask through the law one by one; their plastic strains grow.
template <int Dim, class Real, class Law>
[[gnu::noinline]] void return_one_by_one(const Law& law, const LaneMask<Real>& which, const Batch<Real>& batch,
                                         Particles<Dim, Real>& particles, Returned<Real>& returned) {
  alignas(sizeof(Lanes<Real>)) Real stress[6][lane_count<Real>], work[lane_count<Real>] = {},
                                                                 opening[lane_count<Real>] = {};
  for (int c = 0; c < 6; ++c) {
    returned.stress[c].store(stress[c]);
  }
  for (std::size_t lane = 0; lane < batch.count; ++lane) {
    if (!which[lane]) {
      continue;
    }
    Real& plastic_strain = particles.plastic_strain(batch.particle[lane]);
    SymmetricTensor<Real> trial;
    for (int c = 0; c < 6; ++c) {
      trial[c] = stress[c][lane];
    }
    const auto result = law.update(trial, plastic_strain);
    for (int c = 0; c < 6; ++c) {
      stress[c][lane] = result.stress[c];
    }
    plastic_strain += result.equivalent_plastic_strain_increment;
    work[lane] = result.plastic_work_density;
    opening[lane] = result.opening;
  }
  for (int c = 0; c < 6; ++c) {
    returned.stress[c] = Lanes<Real>::load(stress[c]);
  }
  returned.plastic_work_density = Lanes<Real>::load(work);
  returned.opening = Lanes<Real>::load(opening);
}

// The stresses that follow from a batch's elastic trial stresses.
template <int Dim, class Real, class Law>
THAWSLIDE_ALWAYS_INLINE void admit(const Law& law, const Batch<Real>& batch, Particles<Dim, Real>& particles,
                                   SymmetricTensor<Lanes<Real>>& stress, Lanes<Real>& plastic_work_density,
                                   Lanes<Real>& opening) {
  plastic_work_density = opening = Real(0);
  if constexpr (Law::yields) {
    const LaneMask<Real> may_yield = law.may_yield(stress);
    if (any(may_yield)) {
      Returned<Real> returned{{stress[0], stress[1], stress[2], stress[3], stress[4], stress[5]}};
      return_one_by_one(law, may_yield, batch, particles, returned);
      unrolled<6>([&](auto c) THAWSLIDE_INLINE_LAMBDA { stress[static_cast<int>(c())] = returned.stress[c()]; });
      plastic_work_density = returned.plastic_work_density;
      opening = returned.opening;
    }
  }
}

// The strain, rotation, stress, volume and porosity of a batch of one material; adds to the energies.
template <int Dim, class Real, class Law>
THAWSLIDE_ALWAYS_INLINE void deform(Particles<Dim, Real>& particles, const Batch<Real>& batch,
                                    const Matrix<Lanes<Real>, Dim>& displacement_gradient, const Law& law,
                                    const MaterialModel<Real>& material, const MotionModel<Dim, Real>& model, Real dt,
                                    StressWork<Real>& work) {
  using Tensor = SymmetricTensor<Lanes<Real>>;
  const auto increment = physics::strain_increment<Lanes<Real>, Dim>(displacement_gradient);
  const Tensor old_stress = particles.stress.template load_vector<6>(batch);
  const Lanes<Real> volume_strain = increment.strain[0] + increment.strain[1] + increment.strain[2];
  const Lanes<Real> closing = material.gaps_close_first
                                  ? physics::closing_strain(particles.gap.load(batch), volume_strain)
                                  : Lanes<Real>(Real(0));
  const Tensor elastic = physics::stress_increment(material.elastic, physics::borne_strain(increment.strain, closing));
  Tensor stress = physics::rotate<Lanes<Real>, Dim>(old_stress, increment.rotation) + elastic;
  Lanes<Real> plastic_work_density, opening;
  admit(law, batch, particles, stress, plastic_work_density, opening);
  const Lanes<Real> volume = particles.volume.load(batch);
  batch.add_to(work.total, volume * Real(0.5) * double_contraction<Lanes<Real>>(old_stress + stress, increment.strain));
  particles.stress.store_vector(batch, stress);
  if (Law::yields) {
    const Lanes<Real> pressure = (stress[0] + stress[1] + stress[2]) / Real(3);
    batch.add_to(work.plastic, volume * (plastic_work_density - closing * pressure));
  }
  if (material.viscosity_time > Real(0)) {
    const Tensor viscous = Lanes<Real>(material.viscosity_time / dt) * elastic;
    batch.add_to(work.viscous, volume * double_contraction<Lanes<Real>>(viscous, increment.strain));
    particles.viscous_stress.store_vector(batch, viscous);
  }
  if (material.gaps_close_first) {
    particles.gap.store(batch, particles.gap.load(batch) + (opening - closing));
  }
  if (model.effective_stress) {
    batch.add_to(work.pore, -volume * particles.pore_pressure.load(batch) * volume_strain);
  }
  particles.volume.store(batch, volume * increment.volume_ratio);
  particles.volume_strain.store(batch, volume_strain);
  particles.porosity.store(batch, physics::updated_porosity(model.phases, particles.porosity.load(batch), volume_strain,
                                                            Lanes<Real>(Real(0))));
}

template <int Dim, class Real>
void note_bad_volumes(const Particles<Dim, Real>& particles, const Batch<Real>& batch, BadParticle& bad) {
  if (!any(!(particles.volume.load(batch) > Real(0)))) {
    return;
  }
  for (const std::uint32_t p : batch.particle) {
    if (!(particles.volume(p) > Real(0))) {
      bad.note(particles.id(p),
               std::isnan(particles.volume(p)) ? Fault::volume_not_finite : Fault::volume_not_positive);
    }
  }
}

// One tile's particles; the velocities of the nodes about it are given.
template <class Shape, int Dim, class Real>
StressWork<Real> deform_tile(const SparseGrid<Dim, Real>& grid,
                             const typename SparseGrid<Dim, Real>::OccupiedTile& tile,
                             const MotionModel<Dim, Real>& model, Real dt, const Patch<Dim, Real, Dim>& velocity,
                             Particles<Dim, Real>& particles, BadParticle& bad) {
  StressWork<Real> sum;
  // Runs of particles of one material share one choice of law.
  for (std::uint32_t k = tile.first; k < tile.last;) {
    const std::int32_t material = particles.material(grid.order()[k]);
    const MaterialModel<Real>& chosen = model.materials[static_cast<std::size_t>(material)];
    const std::uint32_t first = k;
    while (k < tile.last && particles.material(grid.order()[k]) == material) {
      ++k;
    }
    std::visit(
        [&](const auto& law) {
          for_each_batch<Real>(grid.order(), first, k, [&](const Batch<Real>& batch) {
            const auto stencil = make_stencil<Shape>(grid, tile.key, place_of(grid, particles, batch),
                                                     model.half_sizes(particles, batch), model.sides);
            const Matrix<Lanes<Real>, Dim> gradient = Lanes<Real>(dt) * gradient_of(read_nodes<Dim>(stencil, velocity));
            deform<Dim, Real>(particles, batch, gradient, law, chosen, model, dt, sum);
            note_bad_volumes(particles, batch, bad);
          });
        },
        chosen.law);
  }
  return sum;
}

}  // namespace

template <int Dim, class Real>
StressWork<Real> update_stress_and_porosity(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                                            const MotionModel<Dim, Real>& model, Real dt, const Nodes<Dim, Real>& nodes,
                                            BadParticle& bad) {
  std::vector<StressWork<Real>> works(grid.tiles().size());
  std::vector<BadParticle> bads(grid.tiles().size());
  with_shape<Real>(model.shape, [&](auto shape) {
    parallel_for(grid.tiles().size(), [&](std::size_t t) {
      Patch<Dim, Real, Dim> velocity;
      load_patch(grid, t, nodes.velocity, velocity);
      works[t] = deform_tile<decltype(shape)>(grid, grid.tiles()[t], model, dt, velocity, particles, bads[t]);
    });
  });
  StressWork<Real> sum;
  for (const StressWork<Real>& work : works) {
    sum.total += work.total;
    sum.plastic += work.plastic;
    sum.viscous += work.viscous;
    sum.pore += work.pore;
  }
  for (const BadParticle& one : bads) {
    bad.note(one.id, one.fault);
  }
  return sum;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template StressWork<Real> update_stress_and_porosity<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&, \
                                                                  const MotionModel<Dim, Real>&, Real,                 \
                                                                  const Nodes<Dim, Real>&, BadParticle&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
