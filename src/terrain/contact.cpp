#include "terrain/contact.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::terrain {

namespace {

using mpm::NodeAt;

// Ground at the nodes of a block; null without candidate nodes.
template <int Dim>
struct GroundOfBlock {
  const typename GroundOnGrid<Dim>::Block* nodes;

  const GroundAtNode<Dim>& operator()(const NodeAt& at) const { return (*nodes)[at.node]; }
};

// Planes of nodes, from the ground at nodes.
template <int Dim>
struct PlanesOfGround {
  using Record = std::array<double, mpm::record_size(mpm::components_of<mpm::Planes, Dim>)>;

  static Record record_of(const GroundAtNode<Dim>& known) {
    Record record{known.plane};
    mpm::set_vector<Dim>(record, mpm::Planes::normal, known.plane_scale * known.normal);
    return record;
  }

  const GroundOnGrid<Dim>& ground;
};

template <int Dim>
void load_patch(const mpm::SparseGrid<Dim>& grid, std::size_t t, const PlanesOfGround<Dim>& records,
                mpm::PatchOf<mpm::Planes, Dim>& patch) {
  const std::int32_t* blocks = grid.blocks_about_tile(t);
  mpm::for_each_direction<Dim>([&](auto d) {
    const auto& block = records.ground.block(static_cast<std::size_t>(blocks[d]));
    mpm::for_shared_nodes<Dim, d>(
        [&](std::size_t in_block, std::size_t in_patch) {
          patch.records[in_patch] = PlanesOfGround<Dim>::record_of(block[in_block]);
        },
        grid.rows_seen(t));
  });
}

// Records of a pass that reads ground data.
template <int Dim>
struct NodesOnGround {
  mpm::Nodes<Dim>& nodes;
  const GroundOnGrid<Dim>& ground;

  template <class Name>
  [[nodiscard]] decltype(auto) of() const {
    if constexpr (std::is_same_v<Name, mpm::Planes>) {
      return PlanesOfGround<Dim>{ground};
    } else {
      return nodes.template of<Name>();
    }
  }
};

// Filter for tiles, batches and particles that reach candidate nodes with any shape function.
template <int Dim>
struct SeesCandidates {
  const GroundOnGrid<Dim>& ground;

  [[nodiscard]] bool operator()(std::size_t tile) const { return ground.any_near(tile); }
  // nodes: of a batch, or the place of the lowest node of a particle.
  template <class Nodes>
  [[nodiscard]] bool operator()(std::size_t tile, const Nodes& nodes) const {
    return ground.any_near(tile, nodes);
  }
};

// Passes of contact (terrain/contact_stage.hpp) on the CPU. One thread visits the nodes of a block.
template <int Dim>
class ContactPasses {
 public:
  static constexpr bool is_queued = false;

  ContactPasses(const SlideOnGround<Dim>& slide, double time, double dt) : slide_(slide), time_(time), dt_(dt) {}

  // Selects the blocks with records of contact. Those of BaseLoad are 0 at nodes that are no candidates.
  void allocate_records() const {
    const std::size_t blocks = slide_.grid.blocks().size();
    const auto any_candidate = [this](std::size_t b) { return candidates(b) != 0; };
    slide_.nodes.motion.resize(blocks);
    slide_.nodes.contact.allocate(blocks, any_candidate);
    slide_.nodes.base.allocate(blocks, any_candidate);
    parallel_for(blocks, [&](std::size_t b) {
      if (any_candidate(b)) {
        std::fill_n(slide_.nodes.base.of_block(b), slide_.nodes.base.nodes,
                    typename mpm::SparseRecordsOf<mpm::BaseLoad, Dim>::Record{});
      }
    });
  }

  [[nodiscard]] bool has_ground() const { return slide_.ground != nullptr; }
  [[nodiscard]] std::size_t candidate_count() const { return has_ground() ? slide_.ground->candidate_count() : 0; }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] double dt() const { return dt_; }
  [[nodiscard]] double cell() const { return slide_.grid.cell(); }
  [[nodiscard]] std::size_t particle_count() const { return slide_.particles.size(); }
  [[nodiscard]] mpm::ParticleView<Dim> particles() const { return mpm::view_of(slide_.particles); }
  [[nodiscard]] mpm::SizesOfBodies body_sizes() const { return slide_.motion.sizes.view(); }

  void near_ground_to_grid(bool with_state) const {
    if (with_state) {
      to_candidates<mpm::NearGround, mpm::Clearance>(
          AddNearGround<Dim>{slide_.motion.phases, slide_.motion.lubrication});
    } else {
      to_candidates<mpm::Clearance>(LowerClearance<Dim>{});
    }
  }
  template <class Kernel>
  void for_candidates(const Kernel& kernel) const {
    parallel_for(slide_.grid.blocks().size(), [&](std::size_t b) {
      if (const std::size_t count = candidates(b); count != 0) {
        const auto step = in_block(b);
        for (std::size_t k = 0; k < count; ++k) {
          kernel(step, NodeAt{b, k}, slide_.ground->first_candidate(b) + k);
        }
      }
    });
  }
  template <class Condition>
  [[nodiscard]] bool any_candidate(const Condition& condition) const {
    return parallel_any(slide_.grid.blocks().size(), [&](std::size_t b) {
      const auto step = in_block(b);
      for (std::size_t k = 0; k < candidates(b); ++k) {
        if (condition(step, NodeAt{b, k}, slide_.ground->first_candidate(b) + k)) {
          return true;
        }
      }
      return false;
    });
  }
  template <class Kernel>
  void add_nodes(const Kernel& kernel, typename Kernel::Sum* to) const {
    using Sum = typename Kernel::Sum;
    *to = parallel_sum<Sum>(slide_.grid.blocks().size(), [&](std::size_t b, Sum& sum) {
      const auto step = in_block(b);
      const std::size_t count = candidates(b);
      const auto first = static_cast<std::int32_t>(count != 0 ? slide_.ground->first_candidate(b) : 0);
      for (const bool touching : {false, true}) {
        for (std::size_t k = 0; k < (touching ? count : static_cast<std::size_t>(mpm::Tile<Dim>::nodes)); ++k) {
          const std::int32_t candidate = k < count ? first + static_cast<std::int32_t>(k) : absent;
          if (kernel.touches(candidate) == touching) {
            kernel(step, NodeAt{b, k}, candidate, sum, sum);
          }
        }
      }
    });
  }
  template <class Kernel>
  void visit_particles(const Kernel& kernel) const {
    mpm::for_particles_in_memory(slide_.particles, kernel);
  }
  template <class Kernel>
  void linear_near_ground(const Kernel& kernel) const {
    mpm::particle_pass(slide_.grid, mpm::LinearWeights{}, slide_.particles, slide_.nodes,
                       SeesCandidates<Dim>{*slide_.ground}, kernel);
  }

 private:
  // Number of candidate nodes of a block, its first nodes.
  [[nodiscard]] std::size_t candidates(std::size_t b) const { return has_ground() ? slide_.ground->candidates(b) : 0; }
  [[nodiscard]] auto in_block(std::size_t b) const {
    using Walls = mpm::BlockConstraints<Dim>;
    return NodesInStep<mpm::NodeAccess<Dim>, GroundOfBlock<Dim>, Walls, Dim>{
        {slide_.grid, slide_.nodes},
        {candidates(b) != 0 ? &slide_.ground->block(b) : nullptr},
        Walls(slide_.grid, slide_.constraints, b, time_),
        slide_.grid.block_tables(),
        slide_.motion.width.view(),
        slide_.contact,
        slide_.grid.cell(),
        time_,
        dt_};
  }
  // Scatters particles to the candidate nodes with a kernel, and sums the named parts of their records over tiles.
  template <class... Parts, class Kernel>
  void to_candidates(const Kernel& kernel) const {
    const SeesCandidates<Dim> sees_candidates{*slide_.ground};
    NodesOnGround<Dim> records{slide_.nodes, *slide_.ground};
    const mpm::MomentumWeights<Dim> weights{slide_.motion.shape, slide_.motion.sizes, slide_.motion.sides};
    mpm::particle_pass(slide_.grid, weights, slide_.particles, records, sees_candidates, kernel);
    const std::size_t blocks = slide_.grid.blocks().size();
    slide_.nodes.near_ground.allocate(blocks, [this](std::size_t b) { return candidates(b) != 0; });
    parallel_for(blocks, [&](std::size_t b) {
      if (candidates(b) != 0) {
        (mpm::sum_block<Parts>(slide_.grid, b, slide_.nodes, sees_candidates), ...);
      }
    });
  }

  const SlideOnGround<Dim>& slide_;
  double time_, dt_;
};

}  // namespace

template <int Dim>
void set_contact_offset(const mpm::BodySizes& sizes, double cell, mpm::Particles<Dim>& particles, std::size_t first) {
  constexpr double within_lowest_layer = 2.0 * (1.0 + round_off);  // in half sizes of a particle
  for (std::size_t p = first; p < particles.size(); ++p) {
    const double half = sizes.half(static_cast<std::size_t>(particles.body(p))) * cell;
    const double height = particles.height_above_ground(p);
    particles.contact_offset(p) = height < within_lowest_layer * half ? height : half;
  }
}

template <int Dim>
void start_contact(const SlideOnGround<Dim>& slide) {
  const ContactPasses<Dim> passes(slide, 0.0, 0.0);
  passes.allocate_records();
  if (passes.has_ground()) {
    for (std::size_t b = 0; b < slide.grid.blocks().size(); ++b) {
      for (std::size_t k = 0; slide.nodes.contact.contains(b) && k < slide.nodes.contact.nodes; ++k) {
        slide.nodes.contact.of_block(b)[k] = {k < slide.ground->candidates(b) ? 1.0 : 0.0};
      }
    }
    mark_band_and_slip<Dim>(passes, 0.0);
  }
}

template <int Dim>
ContactWork<Dim> ContactOnCpu<Dim>::resolve(const SlideOnGround<Dim>& slide, double time, double dt,
                                            const mpm::BaseStates<Dim>& columns,
                                            const std::function<void()>& average_band, Bed<Dim>* bed,
                                            const StrengthLaw* strength, double of_walls) {
  const ContactPasses<Dim> passes(slide, time, dt);
  passes.allocate_records();
  ContactWork<Dim> work;
  stage_.resolve(passes, slide.contact, columns, average_band, bed, strength, &of_walls, &work);
  return work;
}

template <int Dim>
double constrain_mapped_back(const SlideOnGround<Dim>& slide, double time, double dt) {
  sum_patches(slide.grid, slide.nodes.velocity);
  double work = 0;
  ContactPasses<Dim>(slide, time, dt).add_nodes(MapBack<Dim>{slide.motion.gravity}, &work);
  return work;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                         \
  template void set_contact_offset<Dim>(const mpm::BodySizes&, double, mpm::Particles<Dim>&, std::size_t); \
  template void start_contact<Dim>(const SlideOnGround<Dim>&);                                             \
  template class ContactOnCpu<Dim>;                                                                        \
  template double constrain_mapped_back<Dim>(const SlideOnGround<Dim>&, double, double);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
