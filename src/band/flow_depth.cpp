#include "band/flow_depth.hpp"

#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "mpm/box_sums.hpp"

namespace thawslide::band {

namespace {

// Calls visit(columns of the tile, batch) for all batches.
template <int Dim, class Columns, class Visit>
void for_batches(const mpm::SparseGrid<Dim>& grid, const Columns& columns, const Visit& visit) {
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    const auto of_tile = columns.of_tile(t);
    for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
      visit(of_tile, batch);
    }
  });
}

}  // namespace

template <int Dim>
void FlowDepth<Dim>::update(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model,
                            const OfPosition<Dim>& slope_cosine, const OfPosition<Dim>& normal_gravity,
                            const mpm::Particles<Dim>& particles) {
  if (!sums_) {
    sizes_ = model.sizes.times(grid.cell());
    OfPosition<Dim> width;
    if (model.width.varies()) {
      width = [&model](const auto& position) { return model.width.at(position[0]); };
    }
    sums_.emplace(cpu_, grid.cell(), grid.mapping().has_ground, sizes_.view(),
                  typename SlideColumns<exec::Cpu, Dim>::AtColumns{
                      model.normal_thickness ? slope_cosine : OfPosition<Dim>(), normal_gravity, std::move(width)});
  }
  if (grid.copy_tile_keys(tile_keys_)) {
    sums_->update(tile_keys_.data(), tile_keys_.size());
  }
  sums_->sum(tile_keys_.data(), [&](const auto& boxes) { mpm::add_boxes(grid, particles, boxes); });
}

template <int Dim>
void FlowDepth<Dim>::depth_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles) const {
  for_batches(grid, by_tile(), [&](const auto& columns, const mpm::TileBatch<Dim>& batch) {
    particles.flow_depth.store(batch, columns.flow_depth(particles, batch));
  });
}

template <int Dim>
void FlowDepth<Dim>::load_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles,
                                       std::size_t first) const {
  const Columns loading = sums_->template loading_by_tile<NumbersOfTile<Dim>>(tile_keys_.data());
  for_batches(grid, loading, [&](const auto& columns, const mpm::TileBatch<Dim>& batch) {
    const Simd<double> load = columns.flow_depth(particles, batch);
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      if (batch.particle[lane] >= first) {
        update_load(particles, batch.particle[lane], load[lane]);
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim) template class FlowDepth<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
