// Particle kernels (mpm/kernel.hpp) of motion.
#pragma once

#include <type_traits>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/kernel.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"

namespace thawslide::mpm {

// Mass, momentum, force (Eq. 12) and volume to the nodes. Sums the force of the walls along x if the width varies.
template <int Dim, class Width = EvenWidth>
struct AddMomentum {
  using Reads = RecordList<>;
  using Adds = RecordList<Momentum>;
  using Totals = std::conditional_t<Width::varies, double, NoTotals>;

  Vector<double, Dim> gravity;  // [m/s2]
  bool effective_stress;        // pore pressure also acts inside the body
  bool viscous;                 // at least one material is viscous
  Width width{};

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& added, [[maybe_unused]] Totals& of_walls) const {
    using Layout = MomentumLayout<Dim>;
    using Value = typename At::Value;
    constexpr int row[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};  // component indices of a symmetric tensor
    auto& momentum = added.template of<Momentum>();
    const Value mass = particles.mass.load(at);
    const SymmetricTensor<Value> stress = stress_on_nodes(particles, at);
    unrolled<static_cast<std::size_t>(Dim)>([&](auto a) THAWSLIDE_INLINE_LAMBDA {
      constexpr int axis = static_cast<int>(a());
      momentum.value[Layout::momentum + a] = mass * particles.velocity.load(at, axis);
      momentum.value[Layout::force + a] = mass * gravity[axis];
      unrolled<static_cast<std::size_t>(Dim)>(
          [&](auto b) THAWSLIDE_INLINE_LAMBDA { momentum.flux[b][Layout::force + a] = -stress[row[a()][b()]]; });
    });
    if constexpr (Width::varies) {
      const Value force = -stress[2] * width.widening(particles.position.load(at, 0));
      momentum.value[Layout::force] += force;
      at.add_to(of_walls, force);
    }
    momentum.value[Layout::mass] = mass;
    momentum.value[Layout::volume] = particles.volume.load(at);
  }

 private:
  // V sigma [J] in Eq. 12.
  template <class Particles, class At>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE SymmetricTensor<typename At::Value> stress_on_nodes(const Particles& particles,
                                                                                           const At& at) const {
    using Value = typename At::Value;
    SymmetricTensor<Value> stress = particles.stress.template load_vector<6>(at);
    if (viscous) {
      stress += particles.viscous_stress.template load_vector<6>(at);
    }
    if (effective_stress) {
      const Value pressure = particles.pore_pressure.load(at);
      for (int c = 0; c < 3; ++c) {
        stress[c] -= pressure;
      }
    }
    return particles.volume.load(at) * stress;
  }
};

// Affine velocity C [1/s] of APIC, by columns.
template <int Dim, class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Matrix<typename At::Value, Dim> affine_velocity(const Particles& particles,
                                                                                     const At& at) {
  Matrix<typename At::Value, Dim> matrix;
  for (int c = 0; c < Dim * Dim; ++c) {
    matrix(c % Dim, c / Dim) = particles.affine_velocity.load(at, c);
  }
  return matrix;
}

// Adds S m C (x_i - x_p), the momentum of the affine velocity, to the momentum of To: Momentum or Velocity.
template <class To, int Dim, class Particles, class At, class Seen, class Scatter>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void add_affine_momentum(const Particles& particles, const At& at,
                                                              const Seen& seen, Scatter& added) {
  using Value = typename At::Value;
  const Value mass = particles.mass.load(at);
  const Matrix<Value, Dim> moment =
      seen.weights.affine_moment(Matrix<Value, Dim>(mass * affine_velocity<Dim>(particles, at)));
  auto& carried = added.template of<To>();
  unrolled<static_cast<std::size_t>(Dim * Dim)>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    carried.flux[k / Dim][index_in_register<To, Dim> + k % Dim] =
        moment(static_cast<int>(k) % Dim, static_cast<int>(k) / Dim);
  });
}

template <int Dim>
struct AddAffineMomentum {
  using Reads = RecordList<>;
  using Adds = RecordList<AffineMomentum>;
  using Totals = NoTotals;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& /*totals*/) const {
    add_affine_momentum<AffineMomentum, Dim>(particles, at, seen, added);
  }
};

// New velocities (Eq. 13, or another transfer) and displacements (Eq. 14, with its missing summation sign); then the
// particles' momentum back to the nodes (MUSL). Sums the kinetic energy that move_particles returns.
template <int Dim>
struct Move {
  using Reads = RecordList<Motion>;
  using Adds = RecordList<Velocity>;
  using Totals = double;

  double pic_fraction, dt;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& kinetic) const {
    using Layout = MotionLayout<Dim>;
    using Value = typename At::Value;
    using VectorOfValues = Vector<Value, Dim>;
    const auto motion = seen.template values<Motion>();
    VectorOfValues acceleration, middle;
    for (std::size_t a = 0; a < Dim; ++a) {
      acceleration[static_cast<int>(a)] = motion[Layout::acceleration + a];
      middle[static_cast<int>(a)] = motion[Layout::middle_velocity + a];
    }
    particles.step_displacement.store_vector(at, VectorOfValues(Value(dt) * middle));
    const VectorOfValues old = particles.velocity.template load_vector<Dim>(at);
    const VectorOfValues change = Value(dt) * acceleration;
    const VectorOfValues flip = old + change;
    const VectorOfValues pic = middle + Value(0.5) * change;
    const VectorOfValues towards_pic = Value(pic_fraction) * (pic - flip);
    const VectorOfValues velocity = flip + towards_pic;
    const Value mass = particles.mass.load(at);
    particles.velocity.store_vector(at, velocity);
    at.add_to(kinetic, mass * (0.5 * (change + towards_pic).squaredNorm() + old.dot(towards_pic)));
    auto& mapped_back = added.template of<Velocity>();
    for (std::size_t a = 0; a < Dim; ++a) {
      mapped_back.value[a] = mass * velocity[static_cast<int>(a)];
    }
  }
};

// New affine velocities of APIC, after Move. Subtracts the contribution of the old affine velocities from the kinetic
// energy.
template <int Dim>
struct MoveAffine {
  using Reads = RecordList<AffineMotion>;
  using Adds = RecordList<AffineVelocity>;
  using Totals = double;

  double dt;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& kinetic) const {
    using Layout = MotionLayout<Dim>;
    using Value = typename At::Value;
    using Square = Matrix<Value, Dim>;
    const Square change = Value(dt) * gradient_of(seen.template read<AffineMotion, Dim>(Layout::acceleration));
    const Square middle = gradient_of(seen.template read<AffineMotion, Dim>(Layout::middle_velocity));
    const Square moment = seen.weights.affine_moment(affine_velocity<Dim>(particles, at));
    const Square velocity = middle + Value(0.5) * change;
    particles.affine_velocity.store_vector(at, velocity.reshaped());
    at.add_to(kinetic, -particles.mass.load(at) * moment.cwiseProduct(seen.weights.affine_on_grid(change)).sum());
    add_affine_momentum<AffineVelocity, Dim>(particles, at, seen, added);
  }
};

}  // namespace thawslide::mpm
