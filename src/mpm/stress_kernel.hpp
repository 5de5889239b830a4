// Particle kernels (mpm/kernel.hpp) of update_stress_and_porosity, one per constitutive law.
#pragma once

#include <cmath>
#include <variant>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/kernel_totals.hpp"
#include "mpm/parameters.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"
#include "mpm/splitting.hpp"
#include "physics/kinematics.hpp"
#include "physics/mixture.hpp"
#include "physics/tension_gap.hpp"

namespace thawslide::mpm {

template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value double_contraction(const SymmetricTensor<Value>& a,
                                                              const SymmetricTensor<Value>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + Value(2) * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

// Strain, rotation, stress, volume and porosity (Eqs. 6, 11) from the mapped-back velocities, for particles of one
// material with the constitutive law Law.
template <int Dim, class Law, class Width = EvenWidth>
struct Deform {
  using Reads = RecordList<Velocity>;
  using Adds = RecordList<>;
  using Totals = Deformed;

  Law law;
  MaterialParameters material;
  physics::Phases phases;
  bool effective_stress;  // pore pressure also acts inside the body
  double dt;
  Width width{};

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& /*added*/, Totals& totals) const {
    using Value = typename At::Value;
    using Tensor = SymmetricTensor<Value>;
    const auto velocity = seen.template read<Velocity, Dim>();
    const Matrix<Value, Dim> gradient = Value(dt) * gradient_of(velocity);
    auto increment = physics::strain_increment<Value, Dim>(gradient);
    if (particles.surface_stretch.is_kept()) {
      update_surface_stretch<Dim>(particles, at, gradient);
    }
    if constexpr (Width::varies) {
      stretch_across(particles, at, velocity.value[0], increment);
    }
    const Tensor old_stress = particles.stress.template load_vector<6>(at);
    const Value volume_strain = increment.strain[0] + increment.strain[1] + increment.strain[2];
    const Value closing =
        material.gaps_close_first ? physics::closing_strain(particles.gap.load(at), volume_strain) : Value(0.0);
    const Tensor change = physics::stress_increment(material.elastic, physics::borne_strain(increment.strain, closing));
    Tensor stress = physics::rotate<Value, Dim>(old_stress, increment.rotation) + change;
    Value plastic_work_density, opening;
    admit(particles, at, stress, plastic_work_density, opening);
    StressWork& work = totals.work;
    const Value volume = particles.volume.load(at);
    at.add_to(work.total, volume * 0.5 * double_contraction<Value>(old_stress + stress, increment.strain));
    particles.stress.store_vector(at, stress);
    if (Law::yields) {
      const Value pressure = (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0);
      at.add_to(work.plastic, volume * (plastic_work_density - closing * pressure));
    }
    if (material.viscosity_time > 0.0) {
      const Tensor viscous = Value(material.viscosity_time / dt) * change;
      at.add_to(work.viscous, volume * double_contraction<Value>(viscous, increment.strain));
      particles.viscous_stress.store_vector(at, viscous);
    }
    if (material.gaps_close_first) {
      particles.gap.store(at, particles.gap.load(at) + (opening - closing));
    }
    if (effective_stress) {
      at.add_to(work.pore, -volume * particles.pore_pressure.load(at) * volume_strain);
    }
    particles.volume.store(at, volume * increment.volume_ratio);
    if (particles.volume_strain.is_kept()) {
      particles.volume_strain.store(at, volume_strain);
    }
    particles.porosity.store(at,
                             physics::updated_porosity(phases, particles.porosity.load(at), volume_strain, Value(0.0)));
    record_inverted(particles, at, totals.invalid);
  }

 private:
  // The strain across the section, like the others on the middle configuration, uses the velocity conjugate to the wall
  // force. The volume uses the displacement; volume over width is then the area in the section.
  template <class Particles, class At, class Value, class Increment>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void stretch_across(const Particles& particles, const At& at,
                                                           const Value& velocity, Increment& increment) const {
    const Value x = particles.position.load(at, 0);
    const Value displacement = Value(dt) * velocity;
    increment.strain[2] = displacement * width.widening(Value(x + Value(0.5) * displacement));
    increment.volume_ratio =
        increment.volume_ratio * width.at(Value(x + particles.step_displacement.load(at, 0))) / width.at(x);
  }

  // Maps an elastic trial stress to the admissible stress.
  template <class Particles, class At, class Tensor, class Value>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void admit(Particles& particles, const At& at, Tensor& stress,
                                                  Value& plastic_work_density, Value& opening) const {
    plastic_work_density = opening = 0.0;
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

  template <class Particles, class At>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static void record_inverted(const Particles& particles, const At& at,
                                                                   InvalidParticle& invalid) {
    if (!any(!(particles.volume.load(at) > 0.0))) {
      return;
    }
    at.for_each([&](std::uint32_t p) {
      if (!(particles.volume(p) > 0.0)) {
        invalid.record(particles.id(p),
                       std::isnan(particles.volume(p)) ? Fault::volume_not_finite : Fault::volume_not_positive);
      }
    });
  }
};

// The kernel of any law.
template <int Dim, class Width, class Laws = physics::ConstitutiveLaw>
struct DeformByLaw;
template <int Dim, class Width, class... Laws>
struct DeformByLaw<Dim, Width, std::variant<Laws...>> {
  using Type = std::variant<Deform<Dim, Laws, Width>...>;
};

}  // namespace thawslide::mpm
