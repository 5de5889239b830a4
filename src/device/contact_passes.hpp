// Passes of contact with the ground (terrain/contact_stage.hpp) on a device.
#pragma once

#include "device/step_passes.hpp"
#include "terrain/contact_stage.hpp"

namespace thawslide::device {

template <int Dim>
struct GroundOfNodes {
  const terrain::GroundAtNode<Dim>* known;  // by node; null if there is none

  [[nodiscard]] THAWSLIDE_HD const terrain::GroundAtNode<Dim>& operator()(std::size_t node) const {
    return known[node];
  }
};

// Prescribed motion at nodes, and held bodies.
template <int Dim>
struct WallsOfNodes {
  mpm::PrescribedMotion<Dim> motion;
  const std::uint64_t* block_keys;
  std::uint64_t first_held_layer;  // of the grid, and those after it
  double cell, time;

  [[nodiscard]] THAWSLIDE_HD mpm::NodeConstraints<Dim> operator()(std::size_t node) const {
    constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    const bool held = mpm::Tile<Dim>::layer(block_keys[node / block_nodes]) >= first_held_layer;
    const Vector<double, Dim> position = position_of_node<Dim>(block_keys, node, cell);
    return {motion, position, time, held, motion.may_apply(position, position, time)};
  }
};

template <int Dim>
using NodesInStep = terrain::NodesInStep<ContactNodes<Dim>, GroundOfNodes<Dim>, WallsOfNodes<Dim>, Dim>;

template <class Kernel, int Dim>
struct AtCandidates {
  NodesInStep<Dim> step;
  const std::uint32_t* candidates;
  Kernel kernel;

  THAWSLIDE_HD void operator()(std::size_t k) const { kernel(step, static_cast<std::size_t>(candidates[k]), k); }
};

// Work of a block pass (device/step_passes.hpp).
template <class Kernel, int Dim>
struct AddNodes {
  using Sum = typename Kernel::Sum;
  struct Part {
    Sum contact{}, motion{};
    bool touches = false;
  };

  NodesInStep<Dim> step;
  const std::int32_t* number;  // by node, index among candidates; null: no ground
  Kernel kernel;

  THAWSLIDE_HD void visit(std::size_t node, Part& part) const {
    const std::int32_t candidate = number != nullptr ? number[node] : absent;
    part.touches = kernel.touches(candidate);
    kernel(step, node, candidate, part.contact, part.motion);
  }
  THAWSLIDE_HD void add(const Part* parts, std::size_t count, Sum& sum) const {
    for (std::size_t k = 0; k < count; ++k) {
      if (!parts[k].touches) {
        sum += parts[k].motion;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (parts[k].touches) {
        sum += parts[k].contact;
        sum += parts[k].motion;
      }
    }
  }
};

template <class Backend, class Shape, int Dim>
class ContactPasses {
 public:
  static constexpr bool is_queued = true;

  ContactPasses(StepPasses<Backend, Shape, Dim>& passes, double time, double dt)
      : passes_(passes),
        sees_candidates_{passes.cells.tables().tile_keys},
        step_{passes.contact_nodes(),
              {passes.ground.exists() ? passes.ground.known() : nullptr},
              {passes.prescribed_motion(), passes.cells.tables().block_keys,
               passes.model.between_bodies.first_held_layer(), passes.model.cell, time},
              passes.block_tables(),
              passes.width(),
              passes.model.contact,
              passes.model.cell,
              time,
              dt} {}

  [[nodiscard]] bool has_ground() const { return passes_.ground.exists(); }
  [[nodiscard]] std::size_t candidate_count() const { return passes_.ground.candidate_count(); }
  [[nodiscard]] double time() const { return step_.time; }
  [[nodiscard]] double dt() const { return step_.dt; }
  [[nodiscard]] double cell() const { return step_.cell; }
  [[nodiscard]] std::size_t particle_count() const { return passes_.particles.size(); }
  [[nodiscard]] mpm::ParticleView<Dim> particles() const { return passes_.particles.view(); }
  [[nodiscard]] mpm::SizesOfBodies body_sizes() const { return passes_.body_sizes(); }

  // Always with the state.
  void near_ground_to_grid(bool /*with_state*/) {
    const mpm::MotionParameters<Dim>& motion = passes_.model.motion;
    passes_.run(passes_.momentum(sees_candidates_), terrain::AddNearGround<Dim>{motion.phases, motion.lubrication});
    passes_.template sum<mpm::NearGround, mpm::Clearance>(sees_candidates_);
  }
  template <class Kernel>
  void for_candidates(const Kernel& kernel) {
    passes_.backend.for_each(candidate_count(), AtCandidates<Kernel, Dim>{step_, passes_.ground.candidates(), kernel});
  }
  template <class Kernel>
  void add_nodes(const Kernel& kernel, typename Kernel::Sum* to) {
    const std::size_t blocks = step_.blocks.blocks;
    passes_.keep(block_pass<Dim>(passes_.backend, blocks,
                                 AddNodes<Kernel, Dim>{step_, has_ground() ? passes_.ground.number() : nullptr, kernel},
                                 passes_.memory.template sums<typename Kernel::Sum>(partial_sum_count(blocks))),
                 to);
  }
  template <class Kernel>
  void visit_particles(const Kernel& kernel) {
    passes_.backend.for_each(particle_count(), VisitInMemory<Dim, Kernel>{particles(), kernel});
  }
  template <class Kernel>
  void linear_near_ground(const Kernel& kernel) {
    passes_.run(passes_.linear(sees_candidates_), kernel);
  }

 private:
  StepPasses<Backend, Shape, Dim>& passes_;
  SeesCandidates<Dim> sees_candidates_;
  NodesInStep<Dim> step_;
};

}  // namespace thawslide::device
