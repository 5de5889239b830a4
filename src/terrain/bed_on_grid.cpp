#include "terrain/bed_on_grid.hpp"

#include "base/instances.hpp"
#include "terrain/block_step.hpp"

namespace thawslide::terrain {

template <int Dim>
void BedOnGrid<Dim>::list_candidates(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground) {
  blocks_ = grid.blocks();
  candidates_.clear();
  first_.clear();
  std::vector<std::size_t> columns;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    first_.push_back(candidates_.size());
    for (std::size_t k = 0; k < ground.candidates(b); ++k) {
      candidates_.push_back({b, k});
      columns.push_back(this->bed_.columns().number_of(blocks_[b], k));
    }
  }
  this->set_columns(std::move(columns));
}

template <int Dim>
void BedOnGrid<Dim>::update(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                            const mpm::BodySizes& sizes, const mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes) {
  if (blocks_ != grid.blocks()) {
    list_candidates(grid, ground);
  }
  const auto cover = [this](std::size_t column, int part) { this->bed_.cover(column, 1U << part); };
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    for (std::uint32_t k = grid.tiles()[t].first; ground.any_near(t) && k < grid.tiles()[t].last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const double half = sizes.half(static_cast<std::size_t>(particles.body(p)));
      for_covered_parts(this->bed_.columns(), particles, p, half, grid.cell(), cover);
    }
  }
  this->distribute(mpm::NodeAccess<Dim>{grid, nodes}, candidates_.data());
  below_ = this->below_nodes();
}

#define THAWSLIDE_INSTANTIATE(Dim) template class BedOnGrid<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
