// Particle kernels (mpm/kernel.hpp) of filter_velocities.
#pragma once

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/kernel.hpp"
#include "mpm/records.hpp"
#include "physics/rigid_motion.hpp"

namespace thawslide::mpm {

// Stores numbers in a particle's contribution, from number `First` on.
template <std::size_t First, class Numbers, class Carried>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void carry(const Numbers& numbers, Carried& carried) {
  unrolled<static_cast<std::size_t>(Numbers::SizeAtCompileTime)>(
      [&](auto k) THAWSLIDE_INLINE_LAMBDA { carried.value[First + k] = numbers[static_cast<int>(k)]; });
}

// Adds m v and m x x v, of a velocity v at the particle position x, to FilterMomentum.
template <int Dim, class Value, class Scatter>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void carry_momentum(Value mass, const Vector<Value, Dim>& position,
                                                         const Vector<Value, Dim>& velocity, Scatter& added) {
  auto& carried = added.template of<FilterMomentum>();
  const Vector<Value, Dim> momentum = mass * velocity;
  carry<0>(momentum, carried);
  carry<static_cast<std::size_t>(Dim)>(physics::moment_of<Dim>(position, momentum), carried);
}

// Velocity at the particle position of the surrounding nodes' rigid motions, given by a record.
template <class Name, int Dim, class Value, class Seen>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Value, Dim> rigid_velocity(const Seen& seen,
                                                                       const Vector<Value, Dim>& position) {
  const auto motion = seen.template values<Name>();
  Vector<Value, Dim> velocity;
  Vector<Value, physics::rotations<Dim>> rotation;
  unrolled<static_cast<std::size_t>(Dim)>([&](auto a)
                                              THAWSLIDE_INLINE_LAMBDA { velocity[static_cast<int>(a)] = motion[a]; });
  unrolled<static_cast<std::size_t>(physics::rotations<Dim>)>(
      [&](auto a) THAWSLIDE_INLINE_LAMBDA { rotation[static_cast<int>(a)] = motion[Dim + a]; });
  return velocity + physics::turned<Dim>(rotation, position);
}

// First and second moments of mass around the nodes.
template <int Dim>
struct AddFilterMoments {
  using Reads = RecordList<>;
  using Adds = RecordList<FilterMoments>;
  using Totals = NoTotals;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& added, Totals& /*totals*/) const {
    using Value = typename At::Value;
    const Value mass = particles.mass.load(at);
    const Vector<Value, Dim> position = particles.position.template load_vector<Dim>(at);
    auto& carried = added.template of<FilterMoments>();
    carry<0>(Vector<Value, Dim>(mass * position), carried);
    carry<static_cast<std::size_t>(Dim)>(
        Vector<Value, physics::squares<Dim>>(mass * physics::squares_of<Dim>(position)), carried);
  }
};

// Momentum and angular momentum of the particles' velocities.
template <int Dim>
struct AddFilterMomentum {
  using Reads = RecordList<>;
  using Adds = RecordList<FilterMomentum>;
  using Totals = NoTotals;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& added, Totals& /*totals*/) const {
    using Value = typename At::Value;
    carry_momentum<Dim>(particles.mass.load(at), Vector<Value, Dim>(particles.position.template load_vector<Dim>(at)),
                        Vector<Value, Dim>(particles.velocity.template load_vector<Dim>(at)), added);
  }
};

// Sweep: the same for the velocities that the last nodal increments give at the particles.
template <int Dim>
struct SweepFilter {
  using Reads = RecordList<FilterIncrement>;
  using Adds = RecordList<FilterMomentum>;
  using Totals = NoTotals;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& /*totals*/) const {
    using Value = typename At::Value;
    const Vector<Value, Dim> position = particles.position.template load_vector<Dim>(at);
    carry_momentum<Dim>(particles.mass.load(at), position, rigid_velocity<FilterIncrement, Dim>(seen, position), added);
  }
};

// Replaces particle velocities by those of the nodes' rigid motions, and maps their momentum back to the nodes (MUSL).
// Sums the kinetic energy gained [J].
template <int Dim>
struct ApplyFiltered {
  using Reads = RecordList<FilterTotal>;
  using Adds = RecordList<Velocity>;
  using Totals = double;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& gained) const {
    using Value = typename At::Value;
    const Vector<Value, Dim> position = particles.position.template load_vector<Dim>(at);
    const Vector<Value, Dim> old = particles.velocity.template load_vector<Dim>(at);
    const Vector<Value, Dim> velocity = rigid_velocity<FilterTotal, Dim>(seen, position);
    const Value mass = particles.mass.load(at);
    at.add_to(gained, 0.5 * mass * (velocity - old).dot(velocity + old));
    particles.velocity.store_vector(at, velocity);
    carry<0>(Vector<Value, Dim>(mass * velocity), added.template of<Velocity>());
  }
};

}  // namespace thawslide::mpm
