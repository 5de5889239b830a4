// Strain, rotation, stress, volume and porosity of particles (Eqs. 6, 11).
#include <algorithm>
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

// The stresses that follow from a batch's elastic trial stresses.
template <int Dim, class Real, class Law>
THAWSLIDE_ALWAYS_INLINE void admit(const Law& law, const Batch<Real>& batch, Particles<Dim, Real>& particles,
                                   SymmetricTensor<Lanes<Real>>& stress, Lanes<Real>& plastic_work_density,
                                   Lanes<Real>& opening) {
  plastic_work_density = opening = Real(0);
  if constexpr (Law::yields) {
    const Lanes<Real> plastic_strain = particles.plastic_strain.load(batch);
    if (any(law.template may_yield<Dim>(stress, plastic_strain))) {
      const auto result = law.template update<Dim>(stress, plastic_strain);
      stress = result.stress;
      plastic_work_density = result.plastic_work_density;
      opening = result.opening;
      particles.plastic_strain.store(batch, plastic_strain + result.equivalent_plastic_strain_increment);
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
    const Lanes<Real> pressure = (stress[0] + stress[1] + stress[2]) * (Real(1) / Real(3));
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
THAWSLIDE_ALWAYS_INLINE void note_bad_volumes(const Particles<Dim, Real>& particles, const Batch<Real>& batch,
                                              BadParticle& bad) {
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
StressWork<Real> deform_tile(const SparseGrid<Dim, Real>& grid, std::size_t t, const MotionModel<Dim, Real>& model,
                             Real dt, const Patch<Dim, Real, Dim>& velocity, Particles<Dim, Real>& particles,
                             BadParticle& bad) {
  StressWork<Real> sum;
  const auto& batches = grid.batches(t);
  const auto material_of = [&](const TileBatch<Dim, Real>& batch) {
    return static_cast<std::size_t>(particles.material(batch.particle[0]));
  };
  // Batches of one material share one choice of law.
  for (auto first = batches.begin(); first != batches.end();) {
    const std::size_t material = material_of(*first);
    const auto last = std::find_if(first, batches.end(), [&](const auto& b) { return material_of(b) != material; });
    const MaterialModel<Real>& chosen = model.materials[material];
    std::visit(
        [&](const auto& law) {
          for (auto batch = first; batch != last; ++batch) {
            const auto stencil = make_stencil<Shape>(grid, *batch, place_of(grid, particles, *batch),
                                                     model.sizes.of(particles, *batch), model.sides);
            const Matrix<Lanes<Real>, Dim> gradient = Lanes<Real>(dt) * gradient_of(read_nodes<Dim>(stencil, velocity));
            deform<Dim, Real>(particles, *batch, gradient, law, chosen, model, dt, sum);
            note_bad_volumes(particles, *batch, bad);
          }
        },
        chosen.law);
    first = last;
  }
  return sum;
}

// What comes of the particles of some tiles.
template <class Real>
struct Deformed {
  StressWork<Real> work;
  BadParticle bad;

  Deformed& operator+=(const Deformed& part) {
    work += part.work;
    bad += part.bad;
    return *this;
  }
};

}  // namespace

template <int Dim, class Real>
StressWork<Real> update_stress_and_porosity(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                                            const MotionModel<Dim, Real>& model, Real dt, const Nodes<Dim, Real>& nodes,
                                            BadParticle& bad) {
  Deformed<Real> sum;
  with_shape<Real>(model.shape, [&](auto shape) {
    sum = parallel_sum<Deformed<Real>>(grid.tiles().size(), [&](std::size_t t, Deformed<Real>& part) {
      Patch<Dim, Real, Dim> velocity;
      load_patch(grid, t, nodes.velocity, velocity);
      part.work += deform_tile<decltype(shape)>(grid, t, model, dt, velocity, particles, part.bad);
    });
  });
  bad += sum.bad;
  return sum.work;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template StressWork<Real> update_stress_and_porosity<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&, \
                                                                  const MotionModel<Dim, Real>&, Real,                 \
                                                                  const Nodes<Dim, Real>&, BadParticle&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
