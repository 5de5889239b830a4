// What a particle does in update_stress_and_porosity: a kernel (mpm/kernel.hpp).
#pragma once

#include <cmath>

#include "mpm/kernel.hpp"
#include "mpm/motion.hpp"
#include "physics/kinematics.hpp"
#include "physics/tension_gap.hpp"

namespace thawslide::mpm {

template <class Value>
THAWSLIDE_ALWAYS_INLINE Value double_contraction(const SymmetricTensor<Value>& a, const SymmetricTensor<Value>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + Value(2) * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

// What comes of the particles' strain: energies, and the bad particle of smallest id.
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

// Strain, rotation, stress, volume and porosity (Eqs. 6, 11) from the mapped-back velocities.
template <int Dim, class Real>
struct UpdateStress {
  using Reads = RecordList<Velocity>;
  using Adds = RecordList<>;
  using Account = Deformed<Real>;

  const MotionModel<Dim, Real>& model;
  Real dt;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen, Added& /*added*/,
                                          Account& account) const {
    using Value = typename At::Value;
    const Matrix<Value, Dim> gradient = Value(dt) * gradient_of(seen.template read<Velocity, Dim>());
    // A batch is of one material.
    const MaterialModel<Real>& material = model.materials[static_cast<std::size_t>(particles.material(at.particle[0]))];
    std::visit([&](const auto& law) { deform(law, material, gradient, particles, at, account.work); }, material.law);
    note_bad_volumes(particles, at, account.bad);
  }

 private:
  // The stress that follows from an elastic trial stress.
  template <class Law, class Particles, class At, class Tensor, class Value>
  THAWSLIDE_ALWAYS_INLINE static void admit(const Law& law, Particles& particles, const At& at, Tensor& stress,
                                            Value& plastic_work_density, Value& opening) {
    plastic_work_density = opening = Real(0);
    if constexpr (Law::yields) {
      const Value plastic_strain = particles.plastic_strain.load(at);
      if (any(law.template may_yield<Dim>(stress, plastic_strain))) {
        const auto result = law.template update<Dim>(stress, plastic_strain);
        stress = result.stress;
        plastic_work_density = result.plastic_work_density;
        opening = result.opening;
        particles.plastic_strain.store(at, plastic_strain + result.equivalent_plastic_strain_increment);
      }
    }
  }

  template <class Law, class Gradient, class Particles, class At>
  THAWSLIDE_ALWAYS_INLINE void deform(const Law& law, const MaterialModel<Real>& material, const Gradient& gradient,
                                      Particles& particles, const At& at, StressWork<Real>& work) const {
    using Value = typename At::Value;
    using Tensor = SymmetricTensor<Value>;
    const auto increment = physics::strain_increment<Value, Dim>(gradient);
    const Tensor old_stress = particles.stress.template load_vector<6>(at);
    const Value volume_strain = increment.strain[0] + increment.strain[1] + increment.strain[2];
    const Value closing =
        material.gaps_close_first ? physics::closing_strain(particles.gap.load(at), volume_strain) : Value(Real(0));
    const Tensor elastic =
        physics::stress_increment(material.elastic, physics::borne_strain(increment.strain, closing));
    Tensor stress = physics::rotate<Value, Dim>(old_stress, increment.rotation) + elastic;
    Value plastic_work_density, opening;
    admit(law, particles, at, stress, plastic_work_density, opening);
    const Value volume = particles.volume.load(at);
    at.add_to(work.total, volume * Real(0.5) * double_contraction<Value>(old_stress + stress, increment.strain));
    particles.stress.store_vector(at, stress);
    if (Law::yields) {
      const Value pressure = (stress[0] + stress[1] + stress[2]) * (Real(1) / Real(3));
      at.add_to(work.plastic, volume * (plastic_work_density - closing * pressure));
    }
    if (material.viscosity_time > Real(0)) {
      const Tensor viscous = Value(material.viscosity_time / dt) * elastic;
      at.add_to(work.viscous, volume * double_contraction<Value>(viscous, increment.strain));
      particles.viscous_stress.store_vector(at, viscous);
    }
    if (material.gaps_close_first) {
      particles.gap.store(at, particles.gap.load(at) + (opening - closing));
    }
    if (model.effective_stress) {
      at.add_to(work.pore, -volume * particles.pore_pressure.load(at) * volume_strain);
    }
    particles.volume.store(at, volume * increment.volume_ratio);
    particles.volume_strain.store(at, volume_strain);
    particles.porosity.store(
        at, physics::updated_porosity(model.phases, particles.porosity.load(at), volume_strain, Value(Real(0))));
  }

  template <class Particles, class At>
  THAWSLIDE_ALWAYS_INLINE static void note_bad_volumes(const Particles& particles, const At& at, BadParticle& bad) {
    if (!any(!(particles.volume.load(at) > Real(0)))) {
      return;
    }
    at.for_each([&](std::uint32_t p) {
      if (!(particles.volume(p) > Real(0))) {
        bad.note(particles.id(p),
                 std::isnan(particles.volume(p)) ? Fault::volume_not_finite : Fault::volume_not_positive);
      }
    });
  }
};

}  // namespace thawslide::mpm
