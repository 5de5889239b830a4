#include "terrain/near_ground.hpp"

#include <algorithm>
#include <limits>

#include "base/instances.hpp"
#include "mpm/cell_sums.hpp"

namespace thawslide::terrain {

namespace {

// The ground about a tile: distance [m], and its normal.
template <int Dim, class Real>
using DistancePatch = mpm::Patch<Dim, Real, 1 + Dim>;

template <int Dim, class Real>
void load_distances(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground, std::size_t t,
                    DistancePatch<Dim, Real>& patch) {
  const std::int32_t* blocks = grid.blocks_about_tile(t);
  mpm::for_each_direction<Dim>([&](auto d) {
    const auto b = static_cast<std::size_t>(blocks[d]);
    mpm::for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
      const auto& known = ground.block(b)[in_block];
      patch.records[in_patch][0] = known.distance;
      mpm::set_vector<Dim>(patch.records[in_patch], 1, known.normal);
    });
  });
}

// The contact offset of boxes of half size `half` [m], how far they stretch towards the ground if that lies along a
// grid axis; seen: what they read of the patch.
template <int Dim, class Real>
Lanes<Real> contact_offset_of_box(const mpm::Reading<Dim, Lanes<Real>, 1 + Dim>& seen, Lanes<Real> half) {
  using std::max, std::abs;
  Lanes<Real> largest = Real(0);
  for (std::size_t a = 0; a < Dim; ++a) {
    largest = max(largest, abs(seen.value[1 + a]));
  }
  return half * largest;
}

template <int Dim, class Real>
using NearGroundPatch = mpm::Patch<Dim, Real, mpm::NearGroundLayout::size>;

// Lowers the clearance of the nodes that particles see.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE void lower_clearance(const mpm::BatchStencil<Dim, Real>& stencil, std::size_t count,
                                             Lanes<Real> clearance, NearGroundPatch<Dim, Real>& patch) {
  constexpr Real far = std::numeric_limits<Real>::max();
  const mpm::BatchNodes<Real>& nodes = stencil.nodes;
  const auto lower = [&](std::size_t lane, std::size_t offset, Real seen) THAWSLIDE_INLINE_LAMBDA {
    Real& known = patch.records[static_cast<std::size_t>(nodes.first[lane]) + offset][mpm::NearGroundLayout::clearance];
    known = std::min(known, seen);
  };
  const auto in_first = lanes_before<Real>(nodes.runs == 1 ? lane_count<Real> : nodes.second_run);
  mpm::for_each_node<Dim>(stencil.axis, 0,
                          [&](std::size_t offset, Lanes<Real> weight, const Vector<Lanes<Real>, Dim>& /*slope*/) {
                            // A box that ends at the edge of a node's support overlaps it by round-off, or not.
                            const Lanes<Real> seen = select(weight > round_off<Real>, clearance, Lanes<Real>(far));
                            if (nodes.runs == mpm::BatchNodes<Real>::many_runs) {
                              for (std::size_t lane = 0; lane < count; ++lane) {
                                lower(lane, offset, seen[lane]);
                              }
                              return;
                            }
                            lower(0, offset, smallest(select(in_first, seen, Lanes<Real>(far))));
                            if (nodes.runs == 2) {
                              lower(lane_count<Real> - 1, offset, smallest(select(in_first, Lanes<Real>(far), seen)));
                            }
                          });
}

// Of the register that the sums by linear shape functions begin in; what else is in it gets 0.
constexpr std::size_t first_by_linear =
    mpm::NearGroundLayout::saturation_by_linear / mpm::record_step * mpm::record_step;

template <int Dim, class Real>
struct NearGroundSums {
  using Layout = mpm::NearGroundLayout;
  mpm::CellSums<mpm::no_flux, 0, Layout::by_mass, Dim, Real, Layout::size> by_mass;
  mpm::LinearCellSums<false, first_by_linear, Layout::size - first_by_linear, Dim, Real, Layout::size> by_linear;

  explicit NearGroundSums(NearGroundPatch<Dim, Real>& patch) : by_mass(patch), by_linear(patch) {}
};

// What a batch adds to the sums of NearGroundLayout, by mass with the momentum shape functions and by volume with the
// linear ones.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE void add_state(const mpm::BatchStencil<Dim, Real>& stencil,
                                       const mpm::LinearStencil<Dim, Real>& linear,
                                       const mpm::MotionModel<Dim, Real>& model,
                                       const mpm::Particles<Dim, Real>& particles, const mpm::Batch<Real>& batch,
                                       NearGroundSums<Dim, Real>& sums) {
  using Layout = mpm::NearGroundLayout;
  const Lanes<Real> mass = particles.mass.load(batch), volume = particles.volume.load(batch);
  const Lanes<Real> saturation = particles.liquid_saturation.load(batch);
  const Lanes<Real> solid_fraction = mpm::basal_solid_fraction(particles, model.phases, model.lubrication, batch);
  mpm::Contribution<Dim, Real, Layout::by_mass> by_mass;
  by_mass.value[Layout::temperature] = mass * particles.temperature.load(batch);
  by_mass.value[Layout::pore_pressure] = mass * particles.pore_pressure.load(batch);
  by_mass.value[Layout::saturation] = mass * saturation;
  by_mass.value[Layout::solid_fraction] = mass * solid_fraction;
  by_mass.value[Layout::slip] = mass * particles.slip.load(batch);
  sums.by_mass.add(stencil, batch.count, by_mass);
  mpm::Contribution<Dim, Real, Layout::size - first_by_linear> by_linear;
  by_linear.value[Layout::saturation_by_linear - first_by_linear] = volume * saturation;
  by_linear.value[Layout::solid_fraction_by_linear - first_by_linear] = volume * solid_fraction;
  sums.by_linear.add(linear, batch.count, by_linear);
}

}  // namespace

template <int Dim, class Real>
void set_contact_offset(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                        const mpm::BodySizes<Real>& sizes, mpm::Particles<Dim, Real>& particles, std::size_t first) {
  constexpr Real within_lowest_layer = Real(2) * (Real(1) + round_off<Real>);  // times a particle's contact offset
  DistancePatch<Dim, Real> patch;
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    load_distances(grid, ground, t, patch);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const auto seen = mpm::read_nodes<1 + Dim>(linear_stencil(grid, particles, batch), patch);
      const Lanes<Real> contact_offset = contact_offset_of_box(seen, sizes.of(particles, batch).half * grid.cell());
      const auto lowest = seen.value[0] < within_lowest_layer * contact_offset;
      const Lanes<Real> found = select(lowest, seen.value[0], contact_offset);
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        if (batch.particle[lane] >= first) {
          particles.contact_offset(batch.particle[lane]) = found[lane];
        }
      }
    }
  }
}

template <int Dim, class Real>
void near_ground_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                         const mpm::MotionModel<Dim, Real>& model, const mpm::Particles<Dim, Real>& particles,
                         mpm::Nodes<Dim, Real>& nodes) {
  constexpr std::size_t clearance_at = mpm::NearGroundLayout::clearance;
  constexpr Real far = std::numeric_limits<Real>::max();
  const auto patches = nodes.near_ground.patches(grid.tiles().size());
  mpm::with_shape<Real>(model.shape, [&](auto shape) {
    parallel_for(grid.tiles().size(), [&](std::size_t t) {
      if (!ground.any_candidate_about(grid, t)) {
        return;
      }
      auto& patch = patches[t];
      patch.clear();
      for (auto& record : patch.records) {
        record[clearance_at] = far;
      }
      if (!ground.any_near(t)) {
        return;
      }
      DistancePatch<Dim, Real> distances;
      load_distances(grid, ground, t, distances);
      NearGroundSums<Dim, Real> sums(patch);
      for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
        if (!ground.any_near(t, batch)) {
          sums.by_mass.skip();
          sums.by_linear.skip();
          continue;
        }
        const auto linear = linear_stencil(grid, particles, batch);
        const Lanes<Real> distance = mpm::read_nodes<1>(linear, distances).value[0];
        const auto place = place_of(grid, particles, batch);
        const auto stencil =
            mpm::make_stencil<decltype(shape)>(grid, batch, place, model.sizes.of(particles, batch), model.sides);
        add_state(stencil, linear, model, particles, batch, sums);
        lower_clearance(stencil, batch.count,
                        max(Lanes<Real>(Real(0)), distance - particles.contact_offset.load(batch)), patch);
      }
    });
  });
  nodes.near_ground.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!ground.any_candidate(b)) {
      return;
    }
    sum_patches_in_block(grid, b, patches, nodes.near_ground);
    std::array<Real, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)> clearance;
    clearance.fill(far);
    const std::int32_t* tiles = grid.tiles_about_block(b);
    mpm::for_each_direction<Dim>([&](auto d) {
      if (tiles[d] != KeyIndex::absent) {
        mpm::for_shared_nodes<Dim, mpm::opposite<Dim>(d)>([&](std::size_t in_block, std::size_t in_patch) {
          const auto& record = patches[static_cast<std::size_t>(tiles[d])].records[in_patch];
          clearance[in_block] = std::min(clearance[in_block], record[clearance_at]);
        });
      }
    });
    for (std::size_t k = 0; k < clearance.size(); ++k) {
      nodes.near_ground(b, k)[clearance_at] = clearance[k];
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                             \
  template void set_contact_offset<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,     \
                                              const mpm::BodySizes<Real>&, mpm::Particles<Dim, Real>&, std::size_t); \
  template void near_ground_to_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,    \
                                               const mpm::MotionModel<Dim, Real>&, const mpm::Particles<Dim, Real>&, \
                                               mpm::Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
