// Device stages that change heat and pore pressure (band/heat.hpp, band/pore_pressure.hpp).
#pragma once

#include <variant>

#include "band/averages_kernel.hpp"
#include "band/slide_columns.hpp"
#include "device/column_kernels.hpp"
#include "device/heat_kernels.hpp"
#include "device/pressure_kernels.hpp"
#include "device/step_passes.hpp"

namespace thawslide::device {

template <class Backend, class Shape, int Dim>
class BandStages {
  using Passes = StepPasses<Backend, Shape, Dim>;
  using Columns = band::ColumnsByTile<Dim, band::NumbersOfColumns>;

 public:
  // sums: sums of the step, in device memory.
  BandStages(Passes& passes, const HostCallbacks<Dim>& callbacks, StepSums<Dim>* sums)
      : passes_(passes),
        sums_(sums),
        sizes_(passes.backend, passes.model.half_sizes, passes.model.cell),
        columns_(passes.backend, passes.model.cell, passes.model.mapping.has_ground, sizes_.view(),
                 {callbacks.slope_cosine, callbacks.normal_gravity, {}}) {
    hydraulic_.set(passes.model.hydraulic_conductivity);
  }

  // Call after blocks have changed. nodes: number of nodes in active blocks.
  void resize_for(std::size_t nodes) {
    if (passes_.model.heat) {
      passes_.nodes.template resize_for<mpm::HeatRates, mpm::UnreachedHeat>(nodes);
      secant_rates_.resize(passes_.template of<mpm::HeatRates>().size());
    }
    if (passes_.model.pressure_changes) {
      passes_.nodes.template resize_for<mpm::Seepage, mpm::SeepingWater>(nodes);
      columns_.update(passes_.cells.tables().tile_keys, passes_.cells.tables().tiles);
    }
  }

  void average() {
    passes_.run(passes_.linear(), band::AddAverages<Dim>{});
    passes_.template sum<mpm::Averages, void>(AllTiles{});
    passes_.backend.for_each(passes_.cells.tables().blocks * Passes::block_nodes,
                             SetState<Dim>{passes_.views(), passes_.cells.tables().block_keys, passes_.model.heat_faces,
                                           passes_.model.heat_faces.any(), passes_.model.cell});
  }

  void rescale(double time) {
    const double thickness = passes_.model.band_thickness(time);
    passes_.backend.for_each(1, Fill<double>{&sums_->band_rescale, 0.0});
    const bool depends_on_position = !passes_.model.scales_all || passes_.model.mapping.has_ground;
    if (depends_on_position || thickness != band_thickness_) {
      band_thickness_ = thickness;
      std::visit([&](const auto& content) { rescale_by(content, thickness); }, passes_.model.heat_content);
    }
  }

  void conduct_heat(double dt) {
    average_seeping_water();
    if (passes_.model.heat) {
      std::visit([&](const auto& content) { conduct_heat_by(content, dt); }, passes_.model.heat_content);
      passes_.model.starts = false;
    }
  }
  void drain_pore_pressure(double dt) {
    columns_.sum([&](band::ColumnPart<Dim>* parts) {
      using InTile = SumInTile<Dim>;
      passes_.backend.for_groups(passes_.cells.tables().tiles, InTile::at_a_time, InTile::bytes,
                                 InTile{passes_.cells.tables(), passes_.particles.view(), sizes_.view(),
                                        passes_.model.cell, passes_.model.mapping, parts});
    });
    if (passes_.model.band.needs_normal_load()) {
      passes_.run(passes_.linear(), AddPressureLoad<Columns>{columns_.template loading_by_tile<band::NumbersOfColumns>(
                                        passes_.cells.tables().tile_keys)});
    }
    if (find_seepage(SeepingBefore<Dim>{{passes_.particles.view(), passes_.model.band, hydraulic()}})) {
      seep(dt);
      update_pressure<true>();
    } else {
      passes_.backend.for_each(1, Fill<double>{&sums_->vented, 0.0});
      update_pressure<false>();
    }
  }
  [[nodiscard]] band::HydraulicConductivity hydraulic() const { return {hydraulic_.data(), hydraulic_.size() == 1}; }

 private:
  template <class Content>
  void rescale_by(const Content& content, double thickness) {
    using Kernel = RescaleBand<Dim, Content>;
    const Kernel kernel{content,
                        passes_.model.band,
                        passes_.model.pressure_changes,
                        {passes_.model.scales_all, passes_.model.mapping.has_ground, passes_.model.cell, thickness}};
    passes_.keep(&passes_.run(passes_.linear(), kernel)->template of<Kernel>(), &sums_->band_rescale);
  }
  template <class Content>
  void conduct_heat_by(const Content& content, double dt) {
    using Law = band::ParticleHeat<Content, band::InitialMasses>;
    const Law law{content};
    passes_.run(passes_.linear(), band::HeatFlows<Dim, Law>{passes_.model.band, hydraulic(), law, dt,
                                                            1.0 / passes_.model.cell, !passes_.model.starts});
    passes_.template sum<mpm::HeatRates, void>(AllTiles{});
    solve_rates(nullptr, dt);
    passes_.marks.mark_tiles(passes_.cells.tables(),
                             MayChange<Dim, Content>{passes_.views(), passes_.particles.view(), content, dt});
    passes_.marks.mark_blocks(passes_.cells.tables());
    passes_.run(passes_.linear(passes_.marks.tiles()), band::SecantCapacity<Dim, Law>{law, dt});
    passes_.backend.for_each(secant_rates_.size(),
                             SumPatches<mpm::HeatRates, void, AllTiles, Dim>{
                                 passes_.cells.tables(), {}, passes_.memory.patches(0), secant_rates_.data()});
    passes_.keep(&solve_rates(passes_.marks.blocks(), dt)->gain, &sums_->heat);
    passes_.marks.mark_tiles(passes_.cells.tables(), HasHeat<Dim>{passes_.template of<mpm::UnreachedHeat>().data()});
    passes_.run(passes_.momentum(passes_.marks.tiles()), band::RedistributeUnreachedHeat<Dim>{dt});
    passes_.run(passes_.linear(), band::UpdateHeat<Dim, Law>{passes_.model.band, law, dt});
  }
  const band::NodalHeat* solve_rates(const std::uint8_t* changing_blocks, double dt) {
    const std::size_t blocks = passes_.cells.tables().blocks;
    const SolveRates<Dim> solve{passes_.views(),
                                passes_.template of<mpm::HeatRates>().data(),
                                secant_rates_.data(),
                                changing_blocks,
                                passes_.template of<mpm::UnreachedHeat>().data(),
                                dt,
                                passes_.cells.tables().block_keys,
                                passes_.model.heat_faces,
                                passes_.model.heat_faces.any(),
                                passes_.model.starts,
                                passes_.model.cell};
    return block_pass<Dim>(passes_.backend, blocks, solve,
                           passes_.memory.template sums<band::NodalHeat>(partial_sum_count(blocks)));
  }

  // Marks the blocks that water can seep to, and the tiles around them. Returns false if there are none.
  template <class Condition>
  bool find_seepage(const Condition& condition) {
    if (!passes_.model.has_seepage()) {
      return false;
    }
    passes_.marks.mark_tiles(passes_.cells.tables(), condition);
    passes_.marks.mark_blocks(passes_.cells.tables());
    return passes_.marks.mark_tiles_about(passes_.cells.tables());
  }

  void average_seeping_water() {
    if (passes_.model.band.frozen_rows == band::FrozenRows::draining ||
        !find_seepage(SeepingInState<Dim>{passes_.particles.view(), passes_.model.band, hydraulic()})) {
      return;
    }
    passes_.run(passes_.linear(passes_.marks.tiles()), band::AddSeepingWater<Dim>{passes_.model.band, hydraulic()});
    passes_.template sum<mpm::SeepingWater, void>(passes_.marks.tiles());
    passes_.backend.for_each(passes_.cells.tables().blocks * Passes::block_nodes,
                             SetSeepingPressure<Dim>{passes_.views(), passes_.template of<mpm::SeepingWater>().data(),
                                                     passes_.marks.blocks()});
  }

  void seep(double dt) {
    passes_.run(passes_.linear(passes_.marks.tiles()),
                band::SeepageFlows<Dim>{passes_.model.band, hydraulic(), dt, 1.0 / passes_.model.cell});
    passes_.template sum<mpm::Seepage, void>(passes_.marks.tiles());
    const std::size_t blocks = passes_.cells.tables().blocks;
    const double* absorbed = block_pass<Dim>(
        passes_.backend, blocks, SolveSeepage<Dim>{passes_.views(), passes_.template of<mpm::Seepage>().data(), dt},
        passes_.memory.template sums<double>(partial_sum_count(blocks)));
    passes_.backend.for_each(1, KeepVented{absorbed, passes_.model.band.phases, &sums_->vented});
  }
  template <bool Seeps>
  void update_pressure() {
    if (passes_.model.band.balances_water()) {
      update_pressure_by<band::UpdatePorePressure<Columns, Seeps, true>>();
    } else {
      update_pressure_by<band::UpdatePorePressure<Columns, Seeps, false>>();
    }
  }
  template <class Kernel>
  void update_pressure_by() {
    const Kernel kernel{passes_.model.band, hydraulic(),
                        columns_.template by_tile<band::NumbersOfColumns>(passes_.cells.tables().tile_keys)};
    passes_.keep(&passes_.run(passes_.linear(), kernel)->template of<Kernel>(), &sums_->drained);
  }

  Passes& passes_;
  StepSums<Dim>* sums_;
  BodySizes<Backend> sizes_;  // half sizes of particles [m]
  band::SlideColumns<Backend, Dim> columns_;
  exec::Array<double, Backend> secant_rates_{passes_.backend}, hydraulic_{passes_.backend};
  double band_thickness_ = -1.0;  // of the last scaling [m]
};

}  // namespace thawslide::device
