#include "terrain/base_pressure.hpp"

#include "base/instances.hpp"
#include "mpm/cell_sums.hpp"
#include "terrain/contact_node.hpp"

namespace thawslide::terrain {

template <int Dim>
std::array<Real, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)> base_pressure(const mpm::SparseGrid<Dim>& grid,
                                                                                const GroundOnGrid<Dim>& ground,
                                                                                const mpm::Nodes<Dim>& nodes,
                                                                                std::size_t b, Real dt,
                                                                                Real smallest_area) {
  using T = mpm::Tile<Dim>;
  using mpm::BaseLayout;
  std::array<Real, static_cast<std::size_t>(T::nodes)> pressure{};
  const auto is_loaded = [&](std::size_t k) { return nodes.base(b, k)[BaseLayout::load] > Real(0); };
  std::size_t first_loaded = 0;
  while (first_loaded < pressure.size() && !is_loaded(first_loaded)) {
    ++first_loaded;
  }
  if (first_loaded == pressure.size()) {
    return pressure;
  }
  mpm::Patch<Dim, BaseLayout::size> patch;
  patch.clear();
  const std::int32_t* blocks = grid.blocks_about_block(b);
  mpm::for_each_direction<Dim>([&](auto d) {
    if (blocks[d] != KeyIndex::absent && ground.any_candidate(static_cast<std::size_t>(blocks[d]))) {
      mpm::for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
        patch.records[in_patch] = nodes.base(static_cast<std::size_t>(blocks[d]), in_block);
      });
    }
  });
  for (int k = static_cast<int>(first_loaded); k < T::nodes; ++k) {
    if (!is_loaded(static_cast<std::size_t>(k))) {
      continue;
    }
    typename T::Index lowest = T::node({}, k);
    for (int& along : lowest) {
      --along;
    }
    const auto first = static_cast<std::size_t>(T::in_patch(lowest));
    pressure[static_cast<std::size_t>(k)] = base_pressure_of_node<Dim>(
        grid.mapping(), ground.block(b)[static_cast<std::size_t>(k)].normal, dt,
        smallest_area, [&](std::size_t node) -> const auto& {
          return patch.records[first + mpm::CellNodes<Dim>::index(node)];
        });
  }
  return pressure;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                          \
  template std::array<Real, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)> base_pressure( \
      const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&, const mpm::Nodes<Dim>&, std::size_t, Real, Real);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
