// PorePressure kernel (band/pressure_kernels.hpp) per tile, with the columns in reach of its particles.
#pragma once

#include "band/flow_depth.hpp"
#include "band/model.hpp"
#include "band/pressure_kernels.hpp"

namespace thawslide::band {

template <int Dim, bool Seeps, bool Balances>
struct UpdatePorePressure {
  using OfTile = PorePressure<ColumnsOfTile<Dim>, Seeps, Balances>;
  using Reads = typename OfTile::Reads;
  using Adds = typename OfTile::Adds;
  using Account = typename OfTile::Account;

  const mpm::SparseGrid<Dim>& grid;
  const BandModel<Dim>& model;
  const FlowDepth<Dim>& depth;

  [[nodiscard]] OfTile in_tile(std::size_t tile) const {
    return {model, model.hydraulic(), Real(0.5) * grid.cell(), depth.of_tile(grid, tile)};
  }
};

}  // namespace thawslide::band
