#include "mpm/motion.hpp"

#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "mpm/cell_sums.hpp"

namespace thawslide::mpm {

namespace {

// The transfers of MotionModel, as types.
template <class Real>
struct FlipPic {
  static constexpr bool affine = false;
  Real pic_share;
};
template <class Real>
struct Apic {
  static constexpr bool affine = true;
  Real pic_share = 1;
};

// Calls work(shape, transfer) with what the model chose.
template <int Dim, class Real, class Work>
void with_transfer(const MotionModel<Dim, Real>& model, const Work& work) {
  if (model.transfer == TransferKind::flip_pic) {
    with_shape<Real>(model.shape, [&](auto shape) { work(shape, FlipPic<Real>{model.pic_share}); });
    return;
  }
  THAWSLIDE_ASSERT(model.shape != ShapeKind::linear, "APIC with linear shape functions");
  if (model.shape == ShapeKind::ugimp) {
    work(Ugimp<Real>{}, Apic<Real>{});
  } else {
    work(Quadratic<Real>{}, Apic<Real>{});
  }
}

template <class Shape, int Dim, class Real>
AffineBatch<Dim, Real> affine_stencil(const SparseGrid<Dim, Real>& grid, const Particles<Dim, Real>& particles,
                                      const MotionModel<Dim, Real>& model, const TileBatch<Dim, Real>& batch) {
  const auto place = place_of(grid, particles, batch);
  const auto size = model.sizes.of(particles, batch);
  return make_affine<Shape>(grid, make_stencil<Shape>(grid, batch, place, size, model.sides), place, model.sides);
}

// Components of the register that S m C (x_i - x_p) is added to.
template <int Dim, class Real>
constexpr std::size_t affine_width = Contribution<Dim, Real, Dim>::width;

// Adds S m C (x_i - x_p), the momentum of the velocity about the particles, to components First ... of the nodes.
template <std::size_t First, int Dim, class Real, class Sums>
void add_affine_momentum(const AffineBatch<Dim, Real>& affine, const Particles<Dim, Real>& particles,
                         const Batch<Real>& batch, Sums& sums) {
  constexpr std::size_t width = affine_width<Dim, Real>;
  const Lanes<Real> mass = particles.mass.load(batch);
  const Matrix<Lanes<Real>, Dim> moment = mass * affine_velocity(particles, batch) * affine.moment.asDiagonal();
  Contribution<Dim, Real, Dim> carried;
  unrolled<static_cast<std::size_t>(Dim * Dim)>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    carried.flux[k / Dim][First % width + k % Dim] = moment(static_cast<int>(k) % Dim, static_cast<int>(k) / Dim);
  });
  sums.add(affine.nodes, batch.count, carried);
}

// V sigma [J] that Eq. 12 sees.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE SymmetricTensor<Lanes<Real>> stress_on_nodes(const Particles<Dim, Real>& particles,
                                                                     const MotionModel<Dim, Real>& model, bool viscous,
                                                                     const Batch<Real>& batch) {
  SymmetricTensor<Lanes<Real>> stress = particles.stress.template load_vector<6>(batch);
  if (viscous) {
    stress += particles.viscous_stress.template load_vector<6>(batch);
  }
  if (model.effective_stress) {
    const Lanes<Real> pressure = particles.pore_pressure.load(batch);
    for (int c = 0; c < 3; ++c) {
      stress[c] -= pressure;
    }
  }
  return particles.volume.load(batch) * stress;
}

// What particles add to the nodes' records of MomentumLayout.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Contribution<Dim, Real, MomentumLayout<Dim>::size> momentum_contribution(
    const Particles<Dim, Real>& particles, const MotionModel<Dim, Real>& model, bool viscous,
    const Batch<Real>& batch) {
  using Layout = MomentumLayout<Dim>;
  constexpr int row[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};  // of a symmetric tensor
  Contribution<Dim, Real, Layout::size> carried;
  const Lanes<Real> mass = particles.mass.load(batch);
  const SymmetricTensor<Lanes<Real>> stress = stress_on_nodes(particles, model, viscous, batch);
  unrolled<static_cast<std::size_t>(Dim)>([&](auto a) THAWSLIDE_INLINE_LAMBDA {
    constexpr int axis = static_cast<int>(a());
    carried.value[Layout::momentum + a] = mass * particles.velocity.load(batch, axis);
    carried.value[Layout::force + a] = mass * model.gravity[axis];
    unrolled<static_cast<std::size_t>(Dim)>(
        [&](auto b) THAWSLIDE_INLINE_LAMBDA { carried.flux[b][Layout::force + a] = -stress[row[a()][b()]]; });
  });
  carried.value[Layout::mass] = mass;
  carried.value[Layout::volume] = particles.volume.load(batch);
  return carried;
}

}  // namespace

template <int Dim, class Real>
void split_total_stress(Particles<Dim, Real>& particles, std::size_t first) {
  for (std::size_t p = first; p < particles.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      particles.stress(p, c) += particles.pore_pressure(p);
    }
  }
}

template <int Dim, class Real>
void momentum_to_grid(const SparseGrid<Dim, Real>& grid, const Particles<Dim, Real>& particles,
                      const MotionModel<Dim, Real>& model, Nodes<Dim, Real>& nodes) {
  const auto patches = nodes.momentum.patches(grid.tiles().size());
  const bool viscous = model.viscous();
  with_transfer(model, [&](auto shape, auto transfer) {
    using Shape = decltype(shape);
    parallel_for(grid.tiles().size(), [&](std::size_t t) {
      auto& patch = patches[t];
      patch.clear();
      auto sums = cell_sums<0, MomentumLayout<Dim>::size>(patch);
      for (const TileBatch<Dim, Real>& batch : grid.batches(t)) {
        const auto place = place_of(grid, particles, batch);
        const auto stencil = make_stencil<Shape>(grid, batch, place, model.sizes.of(particles, batch), model.sides);
        auto carried = momentum_contribution(particles, model, viscous, batch);
        sums.add(stencil, batch.count, carried);
      }
      if constexpr (decltype(transfer)::affine) {
        constexpr std::size_t first = MomentumLayout<Dim>::momentum / affine_width<Dim, Real> * affine_width<Dim, Real>;
        auto affine_sums = cell_sums<0, Dim, first>(patch);
        for (const TileBatch<Dim, Real>& batch : grid.batches(t)) {
          const auto affine = affine_stencil<Shape>(grid, particles, model, batch);
          add_affine_momentum<MomentumLayout<Dim>::momentum>(affine, particles, batch, affine_sums);
        }
      }
    });
  });
  sum_patches(grid, nodes.momentum);
}

namespace {

template <int Dim, class Real>
using MotionPatch = Patch<Dim, Real, MotionLayout<Dim>::size>;

// New velocities from the acceleration and the mid-step velocity that particles see. Returns the kinetic energy of
// MoveWork, by lane.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Lanes<Real> take_velocity(const Vector<Lanes<Real>, Dim>& acceleration,
                                                  const Vector<Lanes<Real>, Dim>& middle, Real pic_share, Real dt,
                                                  Particles<Dim, Real>& particles, const Batch<Real>& batch) {
  using LanesVector = Vector<Lanes<Real>, Dim>;
  const LanesVector old = particles.velocity.template load_vector<Dim>(batch);
  const LanesVector change = Lanes<Real>(dt) * acceleration;
  const LanesVector flip = old + change;
  const LanesVector pic = middle + Lanes<Real>(Real(0.5)) * change;
  const LanesVector towards_pic = Lanes<Real>(pic_share) * (pic - flip);
  particles.velocity.store_vector(batch, LanesVector(flip + towards_pic));
  return particles.mass.load(batch) * (Real(0.5) * (change + towards_pic).squaredNorm() + old.dot(towards_pic));
}

// New affine velocities. Returns the part of sum p_i.dv_i that was the old ones', by lane.
template <int Dim, class Real>
Lanes<Real> take_affine_velocity(const AffineBatch<Dim, Real>& affine, const MotionPatch<Dim, Real>& motion, Real dt,
                                 Particles<Dim, Real>& particles, const Batch<Real>& batch) {
  using Layout = MotionLayout<Dim>;
  using Square = Matrix<Lanes<Real>, Dim>;
  const Square change = Lanes<Real>(dt) * gradient_of(read_nodes<Dim>(affine.nodes, motion, Layout::acceleration));
  const Square middle = gradient_of(read_nodes<Dim>(affine.nodes, motion, Layout::middle_velocity));
  const Square moment = affine_velocity(particles, batch) * affine.moment.asDiagonal();
  const Square velocity = middle + Lanes<Real>(Real(0.5)) * change;
  particles.affine_velocity.store_vector(batch, velocity.reshaped());
  return particles.mass.load(batch) * moment.cwiseProduct(change).sum();
}

// One tile's new velocities and displacements, and the momentum that its particles map back. Returns the kinetic energy
// of MoveWork.
template <class Shape, class Transfer, int Dim, class Real>
Real move_tile(const SparseGrid<Dim, Real>& grid, std::size_t t, const MotionModel<Dim, Real>& model,
               const Transfer& transfer, Real dt, const MotionPatch<Dim, Real>& motion, Particles<Dim, Real>& particles,
               Patch<Dim, Real, Dim>& patch) {
  using Layout = MotionLayout<Dim>;
  Real kinetic = 0;
  auto sums = cell_sums<no_flux, Dim>(patch);
  for (const TileBatch<Dim, Real>& batch : grid.batches(t)) {
    const auto place = place_of(grid, particles, batch);
    const auto stencil = make_stencil<Shape>(grid, batch, place, model.sizes.of(particles, batch), model.sides);
    const auto seen = read_values(stencil, motion);
    Vector<Lanes<Real>, Dim> acceleration, middle;
    for (std::size_t a = 0; a < Dim; ++a) {
      acceleration[static_cast<int>(a)] = seen[Layout::acceleration + a];
      middle[static_cast<int>(a)] = seen[Layout::middle_velocity + a];
    }
    particles.step_displacement.store_vector(batch, Vector<Lanes<Real>, Dim>(Lanes<Real>(dt) * middle));
    batch.add_to(kinetic, take_velocity(acceleration, middle, transfer.pic_share, dt, particles, batch));
    Contribution<Dim, Real, Dim> momentum;
    for (std::size_t a = 0; a < Dim; ++a) {
      momentum.value[a] = particles.mass.load(batch) * particles.velocity.load(batch, static_cast<int>(a));
    }
    sums.add(stencil, batch.count, momentum);
  }
  if constexpr (Transfer::affine) {
    auto affine_sums = cell_sums<0, Dim>(patch);
    for (const TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const auto affine = affine_stencil<Shape>(grid, particles, model, batch);
      batch.add_to(kinetic, -take_affine_velocity(affine, motion, dt, particles, batch));
      add_affine_momentum<0>(affine, particles, batch, affine_sums);
    }
  }
  return kinetic;
}

}  // namespace

template <int Dim, class Real>
MoveWork<Real> move_particles(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                              const MotionModel<Dim, Real>& model, Real dt, Nodes<Dim, Real>& nodes) {
  const auto patches = nodes.velocity.patches(grid.tiles().size());
  MoveWork<Real> work;
  with_transfer(model, [&](auto shape, auto transfer) {
    work.particle_kinetic = parallel_sum<Real>(grid.tiles().size(), [&](std::size_t t, Real& kinetic) {
      patches[t].clear();
      MotionPatch<Dim, Real> motion;
      load_patch(grid, t, nodes.motion, motion);
      kinetic += move_tile<decltype(shape)>(grid, t, model, transfer, dt, motion, particles, patches[t]);
    });
  });
  return work;
}

namespace {

// What is wrong with the particles of a batch that are not well.
template <int Dim, class Real>
void note_faults(const Particles<Dim, Real>& particles, const Batch<Real>& batch, const LaneMask<Real>& well,
                 BadParticle& bad) {
  for (std::size_t lane = 0; lane < batch.count; ++lane) {
    const std::uint32_t p = batch.particle[lane];
    const Vector<Real, Dim> position = particles.position.template get<Vector<Real, Dim>>(p) +
                                       particles.step_displacement.template get<Vector<Real, Dim>>(p);
    const bool finite = position.allFinite() && std::isfinite(particles.temperature(p)) &&
                        std::isfinite(particles.pore_pressure(p)) && std::isfinite(particles.stress(p, 0));
    if (!well[lane]) {
      bad.note(particles.id(p), finite ? Fault::left_domain : Fault::state_not_finite);
    }
  }
}

}  // namespace

template <int Dim, class Real>
void take_new_positions(Particles<Dim, Real>& particles, const Vector<Real, Dim>& lower, const Vector<Real, Dim>& upper,
                        BadParticle& bad) {
  using LanesVector = Vector<Lanes<Real>, Dim>;
  constexpr std::size_t chunk = 1024;
  const std::size_t tasks = (particles.size() + chunk - 1) / chunk;
  bad += parallel_sum<BadParticle>(tasks, [&](std::size_t task, BadParticle& found) {
    const std::size_t last = std::min(particles.size(), (task + 1) * chunk);
    for (std::size_t p = task * chunk; p < last; p += Batch<Real>::most) {
      const auto batch = batch_in_memory<Real>(p, last);
      LanesVector step = particles.step_displacement.template load_vector<Dim>(batch);
      const LanesVector old = particles.position.template load_vector<Dim>(batch);
      // Not a number is in no range.
      const Lanes<Real> state =
          particles.temperature.load(batch) + particles.pore_pressure.load(batch) + particles.stress.load(batch);
      auto well = abs(state) <= Lanes<Real>(std::numeric_limits<Real>::max());
      for (int a = 0; a < Dim; ++a) {
        well = well & (old[a] + step[a] >= lower[a]) & (old[a] + step[a] <= upper[a]);
      }
      if (any(!well)) {
        note_faults(particles, batch, well, found);
        for (int a = 0; a < Dim; ++a) {
          step[a] = select(well, step[a], Lanes<Real>(Real(0)));
        }
      }
      particles.position.store_vector(batch, LanesVector(old + step));
      particles.displacement.store_vector(batch,
                                          LanesVector(particles.displacement.template load_vector<Dim>(batch) + step));
      particles.path_length.store(batch, particles.path_length.load(batch) + sqrt(step.squaredNorm()));
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                     \
  template void split_total_stress<Dim, Real>(Particles<Dim, Real>&, std::size_t);                           \
  template void momentum_to_grid<Dim, Real>(const SparseGrid<Dim, Real>&, const Particles<Dim, Real>&,       \
                                            const MotionModel<Dim, Real>&, Nodes<Dim, Real>&);               \
  template MoveWork<Real> move_particles<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&,     \
                                                    const MotionModel<Dim, Real>&, Real, Nodes<Dim, Real>&); \
  template void take_new_positions<Dim, Real>(Particles<Dim, Real>&, const Vector<Real, Dim>&,               \
                                              const Vector<Real, Dim>&, BadParticle&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
