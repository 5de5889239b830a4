#include "mpm/motion.hpp"

#include <cmath>

#include "base/error.hpp"
#include "physics/kinematics.hpp"
#include "physics/tension_gap.hpp"

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

// The nodes of a particle; its place, for make_affine.
template <class Shape, int Dim, class Real>
struct MomentumStencil {
  Place<Dim, Real> place;
  Stencil<Dim, Real> nodes;

  THAWSLIDE_ALWAYS_INLINE MomentumStencil(const SparseGrid<Dim, Real>& grid, std::uint64_t tile, std::uint32_t p,
                                          const Particles<Dim, Real>& particles, const MotionModel<Dim, Real>& model)
      : place(place_of(grid, particles.position.template get<Vector<Real, Dim>>(p))),
        nodes(make_stencil<Shape>(grid, tile, place,
                                  model.bodies[static_cast<std::size_t>(particles.body(p))].half_size, model.sides)) {}
};

// Adds S m C (x_i - x_p), the momentum of the velocity about a particle, to the nodes.
template <int Dim, class Real, class Records>
THAWSLIDE_ALWAYS_INLINE void add_affine_momentum(const AffineStencil<Dim, Real>& affine, Real mass,
                                                 const Matrix<Real, Dim>& velocity, std::size_t first,
                                                 Records& records) {
  const Matrix<Real, Dim> moment = mass * velocity * affine.moment.asDiagonal();
  affine.nodes.for_each_node([&](std::size_t place, Real /*weight*/, const Vector<Real, Dim>& arm) {
    const Vector<Real, Dim> momentum = moment * arm;
    for (std::size_t a = 0; a < Dim; ++a) {
      records[place][first + a] += momentum[static_cast<int>(a)];
    }
  });
}

// sigma.G for a tensor stored as xx yy zz xy [yz xz].
template <int Dim, class Real, class Stress>
Vector<Real, Dim> traction(const Stress& s, const Vector<Real, Dim>& g) {
  if constexpr (Dim == 2) {
    return {s[0] * g[0] + s[3] * g[1], s[3] * g[0] + s[1] * g[1]};
  } else {
    return {s[0] * g[0] + s[3] * g[1] + s[5] * g[2], s[3] * g[0] + s[1] * g[1] + s[4] * g[2],
            s[5] * g[0] + s[4] * g[1] + s[2] * g[2]};
  }
}

template <class Real>
Real double_contraction(const SymmetricTensor<Real>& a, const SymmetricTensor<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + Real(2) * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

}  // namespace

template <int Dim, class Real>
void split_total_stress(Particles<Dim, Real>& particles) {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      particles.stress(p, c) += particles.pore_pressure(p);
    }
  }
}

template <int Dim, class Real>
void momentum_to_grid(const SparseGrid<Dim, Real>& grid, const Particles<Dim, Real>& particles,
                      const MotionModel<Dim, Real>& model, Nodes<Dim, Real>& nodes) {
  using Layout = MomentumLayout<Dim>;
  auto& patches = nodes.momentum.patches(grid.tiles().size());
  with_transfer(model, [&](auto shape, auto transfer) {
    parallel_for(grid.tiles().size(), [&](std::size_t t) {
      auto& patch = patches[t];
      patch.clear();
      const auto& tile = grid.tiles()[t];
      for (std::uint32_t k = tile.first; k < tile.last; ++k) {
        const std::uint32_t p = grid.order()[k];
        const Real mass = particles.mass(p);
        const Real volume = particles.volume(p);
        const auto velocity = particles.velocity.template get<Vector<Real, Dim>>(p);
        Eigen::Matrix<Real, Particles<Dim, Real>::tensor_components, 1> stress;
        for (int c = 0; c < Particles<Dim, Real>::tensor_components; ++c) {
          stress[c] = volume * (particles.stress(p, c) + particles.viscous_stress(p, c));
        }
        if (model.effective_stress) {
          for (int c = 0; c < 3; ++c) {
            stress[c] -= volume * particles.pore_pressure(p);
          }
        }
        typename Patch<Dim, Real, Layout::size>::Record carried;
        carried[Layout::mass] = mass;
        for (std::size_t a = 0; a < Dim; ++a) {
          carried[Layout::momentum + a] = mass * velocity[static_cast<int>(a)];
          carried[Layout::force + a] = mass * model.gravity[static_cast<int>(a)];
        }
        carried[Layout::volume] = volume;
        carried[Layout::pore_pressure] = mass * particles.pore_pressure(p);
        carried[Layout::saturation] = mass * particles.liquid_saturation(p);
        carried[Layout::temperature] = mass * particles.temperature(p);
        carried[Layout::solid_fraction] = mass * basal_solid_fraction(particles, model.phases, model.lubrication, p);
        carried[Layout::slip] = mass * particles.slip(p);
        const MomentumStencil<decltype(shape), Dim, Real> stencil(grid, tile.key, p, particles, model);
        stencil.nodes.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& gradient) {
          auto& node = patch.records[place];
          add_weighted(node, weight, carried);
          const Vector<Real, Dim> internal = traction<Dim, Real>(stress, gradient);
          for (std::size_t a = 0; a < Dim; ++a) {
            node[Layout::force + a] -= internal[static_cast<int>(a)];
          }
        });
        if constexpr (decltype(transfer)::affine) {
          add_affine_momentum(make_affine<decltype(shape)>(grid, stencil.nodes, stencil.place, model.sides), mass,
                              affine_velocity(particles, p), Layout::momentum, patch.records);
        }
      }
    });
  });
  sum_patches(grid, nodes.momentum);
}

namespace {

// What a particle reads of the nodes about it.
template <int Dim, class Real>
struct NodeMotion {
  Vector<Real, Dim> acceleration = Vector<Real, Dim>::Zero();
  Vector<Real, Dim> middle_velocity = Vector<Real, Dim>::Zero();
};

template <int Dim, class Real>
using MotionPatch = Patch<Dim, Real, MotionLayout<Dim>::size>;

// One particle's new velocity. Returns the kinetic energy of MoveWork.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Real take_velocity(const NodeMotion<Dim, Real>& seen, Real pic_share, Real dt,
                                           Particles<Dim, Real>& particles, std::uint32_t p) {
  const auto old = particles.velocity.template get<Vector<Real, Dim>>(p);
  const Vector<Real, Dim> change = dt * seen.acceleration;
  const Vector<Real, Dim> flip = old + change;
  const Vector<Real, Dim> pic = seen.middle_velocity + Real(0.5) * change;
  const Vector<Real, Dim> towards_pic = pic_share * (pic - flip);
  particles.velocity.set(p, Vector<Real, Dim>(flip + towards_pic));
  return particles.mass(p) * (Real(0.5) * (change + towards_pic).squaredNorm() + old.dot(towards_pic));
}

// One particle's new affine velocity. Returns the part of sum p_i.dv_i that was the old one's.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Real take_affine_velocity(const AffineStencil<Dim, Real>& affine,
                                                  const MotionPatch<Dim, Real>& motion, Real dt,
                                                  Particles<Dim, Real>& particles, std::uint32_t p) {
  using Layout = MotionLayout<Dim>;
  Matrix<Real, Dim> change = Matrix<Real, Dim>::Zero();
  Matrix<Real, Dim> middle = Matrix<Real, Dim>::Zero();
  affine.nodes.for_each_node([&](std::size_t place, Real /*weight*/, const Vector<Real, Dim>& arm) {
    change += dt * vector_at<Dim, Real>(motion.records[place], Layout::acceleration) * arm.transpose();
    middle += vector_at<Dim, Real>(motion.records[place], Layout::middle_velocity) * arm.transpose();
  });
  const Matrix<Real, Dim> moment = affine_velocity(particles, p) * affine.moment.asDiagonal();
  const Matrix<Real, Dim> velocity = middle + Real(0.5) * change;
  for (int c = 0; c < Dim * Dim; ++c) {
    particles.affine_velocity(p, c) = velocity(c % Dim, c / Dim);
  }
  return particles.mass(p) * moment.cwiseProduct(change).sum();
}

}  // namespace

template <int Dim, class Real>
MoveWork<Real> move_particles(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                              const MotionModel<Dim, Real>& model, Real dt, Nodes<Dim, Real>& nodes) {
  using Layout = MotionLayout<Dim>;
  auto& patches = nodes.velocity.patches(grid.tiles().size());
  std::vector<MoveWork<Real>> works(grid.tiles().size());
  with_transfer(model, [&](auto shape, auto transfer) {
    parallel_for(grid.tiles().size(), [&](std::size_t t) {
      auto& patch = patches[t];
      patch.clear();
      MotionPatch<Dim, Real> motion;
      load_patch(grid, t, nodes.motion, motion);
      const auto& tile = grid.tiles()[t];
      for (std::uint32_t k = tile.first; k < tile.last; ++k) {
        const std::uint32_t p = grid.order()[k];
        const MomentumStencil<decltype(shape), Dim, Real> stencil(grid, tile.key, p, particles, model);
        const auto read = read_nodes<2 * Dim>(stencil.nodes, motion);
        NodeMotion<Dim, Real> seen;
        for (std::size_t a = 0; a < Dim; ++a) {
          seen.acceleration[static_cast<int>(a)] = read.value[Layout::acceleration + a];
          seen.middle_velocity[static_cast<int>(a)] = read.value[Layout::middle_velocity + a];
        }
        particles.step_displacement.set(p, Vector<Real, Dim>(dt * seen.middle_velocity));
        works[t].particle_kinetic += take_velocity(seen, transfer.pic_share, dt, particles, p);
        const Real mass = particles.mass(p);
        const auto velocity = particles.velocity.template get<Vector<Real, Dim>>(p);
        stencil.nodes.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*gradient*/) {
          for (std::size_t a = 0; a < Dim; ++a) {
            patch.records[place][a] += weight * mass * velocity[static_cast<int>(a)];
          }
        });
        if constexpr (decltype(transfer)::affine) {
          const auto affine = make_affine<decltype(shape)>(grid, stencil.nodes, stencil.place, model.sides);
          works[t].particle_kinetic -= take_affine_velocity(affine, motion, dt, particles, p);
          add_affine_momentum(affine, mass, affine_velocity(particles, p), 0, patch.records);
        }
      }
    });
  });
  sum_patches(grid, nodes.velocity);
  MoveWork<Real> sum;
  for (const MoveWork<Real>& work : works) {
    sum.particle_kinetic += work.particle_kinetic;
  }
  return sum;
}

namespace {

// One particle's strain, rotation, stress, volume and porosity; returns the energies. Everything the law needs is
// passed in.
template <int Dim, class Real, class Law>
THAWSLIDE_ALWAYS_INLINE StressWork<Real> deform(Particles<Dim, Real>& particles, std::uint32_t p,
                                                const Matrix<Real, Dim>& displacement_gradient, const Law& law,
                                                const MaterialModel<Real>& material,
                                                const physics::Phases<Real>& phases, Real dt) {
  const auto increment = physics::strain_increment<Real, Dim>(displacement_gradient);
  const SymmetricTensor<Real> old_stress = full_tensor<Dim, Real>(particles.stress, p);
  const Real volume_strain = increment.strain[0] + increment.strain[1] + increment.strain[2];
  const Real closing = physics::closing_strain(particles.gap(p), volume_strain);
  const SymmetricTensor<Real> elastic =
      physics::stress_increment(material.elastic, physics::borne_strain(increment.strain, closing));
  const SymmetricTensor<Real> trial = physics::rotate<Real, Dim>(old_stress, increment.rotation) + elastic;
  const auto result = law.update(trial, particles.plastic_strain(p));
  SymmetricTensor<Real> viscous = SymmetricTensor<Real>::Zero();
  if (material.viscosity_time > Real(0)) {
    viscous = (material.viscosity_time / dt) * elastic;
  }
  const Real volume = particles.volume(p);
  StressWork<Real> work;
  work.total = volume * Real(0.5) * double_contraction<Real>(old_stress + result.stress, increment.strain);
  work.plastic = volume * (result.plastic_work_density - closing * result.stress.template head<3>().mean());
  work.viscous = volume * double_contraction<Real>(viscous, increment.strain);
  for (int c = 0; c < Particles<Dim, Real>::tensor_components; ++c) {
    particles.stress(p, c) = result.stress[c];
    particles.viscous_stress(p, c) = viscous[c];
  }
  particles.plastic_strain(p) += result.equivalent_plastic_strain_increment;
  particles.volume(p) = volume * increment.volume_ratio;
  if (material.gaps_close_first) {
    particles.gap(p) += result.opening - closing;
  }
  particles.volume_strain(p) = volume_strain;
  particles.porosity(p) = physics::updated_porosity(phases, particles.porosity(p), volume_strain, Real(0));
  work.pore = -volume * particles.pore_pressure(p) * volume_strain;
  return work;
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
      const auto& tile = grid.tiles()[t];
      StressWork<Real>& sum = works[t];
      // Runs of particles of one material share one choice of law.
      for (std::uint32_t k = tile.first; k < tile.last;) {
        const std::int32_t material = particles.material(grid.order()[k]);
        const MaterialModel<Real>& chosen = model.materials[static_cast<std::size_t>(material)];
        std::visit(
            [&](const auto& law) {
              for (; k < tile.last && particles.material(grid.order()[k]) == material; ++k) {
                const std::uint32_t p = grid.order()[k];
                const MomentumStencil<decltype(shape), Dim, Real> stencil(grid, tile.key, p, particles, model);
                const Matrix<Real, Dim> gradient = gradient_of(read_nodes<Dim>(stencil.nodes, velocity));
                const StressWork<Real> work =
                    deform<Dim, Real>(particles, p, dt * gradient, law, chosen, model.phases, dt);
                sum.total += work.total;
                sum.plastic += work.plastic;
                sum.viscous += work.viscous;
                sum.pore += work.pore;
                if (!(particles.volume(p) > Real(0))) {
                  bads[t].note(particles.id(p),
                               std::isnan(particles.volume(p)) ? Fault::volume_not_finite : Fault::volume_not_positive);
                }
              }
            },
            chosen.law);
      }
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

template <int Dim, class Real>
void take_new_positions(Particles<Dim, Real>& particles, const Vector<Real, Dim>& extent, BadParticle& bad) {
  constexpr std::size_t chunk = 1024;
  const std::size_t tasks = (particles.size() + chunk - 1) / chunk;
  std::vector<BadParticle> bads(tasks);
  parallel_for(tasks, [&](std::size_t task) {
    const std::size_t last = std::min(particles.size(), (task + 1) * chunk);
    for (std::size_t p = task * chunk; p < last; ++p) {
      const auto step = particles.step_displacement.template get<Vector<Real, Dim>>(p);
      const Vector<Real, Dim> position = particles.position.template get<Vector<Real, Dim>>(p) + step;
      if (!position.allFinite() || !std::isfinite(particles.temperature(p)) ||
          !std::isfinite(particles.pore_pressure(p)) || !std::isfinite(particles.stress(p, 0))) {
        bads[task].note(particles.id(p), Fault::state_not_finite);
        continue;
      }
      if ((position.array() < Real(0)).any() || (position.array() > extent.array()).any()) {
        bads[task].note(particles.id(p), Fault::left_domain);
        continue;
      }
      particles.position.set(p, position);
      particles.path_length(p) += step.norm();
      for (int a = 0; a < Dim; ++a) {
        particles.displacement(p, a) += step[a];
      }
    }
  });
  for (const BadParticle& one : bads) {
    bad.note(one.id, one.fault);
  }
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template void split_total_stress<Dim, Real>(Particles<Dim, Real>&);                                                  \
  template void momentum_to_grid<Dim, Real>(const SparseGrid<Dim, Real>&, const Particles<Dim, Real>&,                 \
                                            const MotionModel<Dim, Real>&, Nodes<Dim, Real>&);                         \
  template MoveWork<Real> move_particles<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&,               \
                                                    const MotionModel<Dim, Real>&, Real, Nodes<Dim, Real>&);           \
  template StressWork<Real> update_stress_and_porosity<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&, \
                                                                  const MotionModel<Dim, Real>&, Real,                 \
                                                                  const Nodes<Dim, Real>&, BadParticle&);              \
  template void take_new_positions<Dim, Real>(Particles<Dim, Real>&, const Vector<Real, Dim>&, BadParticle&);
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
