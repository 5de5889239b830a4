// Stages of heat and pore pressure (band/stages.hpp) on a device, with their memory.
#pragma once

#include "band/slide_columns.hpp"
#include "band/stages.hpp"
#include "device/box_sums.hpp"
#include "device/pressure_load.hpp"
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
                 {callbacks.slope_cosine, callbacks.normal_gravity, callbacks.width}) {
    hydraulic_.set(model().hydraulic_conductivity);
  }

  // Call after blocks have changed. nodes: number of nodes in active blocks.
  void resize_for(std::size_t nodes) {
    if (model().heat) {
      passes_.nodes.template resize_for<mpm::HeatRates, mpm::SecantRates, mpm::UnreachedHeat>(nodes);
      // a pass that reads the record reads all its components
      auto& unreached = passes_.template of<mpm::UnreachedHeat>();
      passes_.backend.for_each(unreached.size(), Fill<double>{unreached.data(), 0.0});
    }
    if (model().pressure) {
      passes_.nodes.template resize_for<mpm::Seepage, mpm::SeepingWater>(nodes);
      columns_.update(passes_.cells.tables().tile_keys, passes_.cells.tables().tiles);
    }
  }

  void average() { band::stages::average_on_grid(passes_, model()); }

  void rescale(double time) {
    const double thickness = passes_.model.band_thickness(time);
    const bool follows_ground = passes_.model.mapping.has_ground;
    if (model().scaling_changes(follows_ground, thickness, band_thickness_)) {
      band::stages::rescale_band(passes_, model(), follows_ground, thickness, &sums_->band_rescale);
    }
  }

  void conduct_heat(double dt) {
    band::stages::conduct_heat(passes_, model(), hydraulic(), dt, passes_.model.starts, &sums_->heat);
    passes_.model.starts = false;
  }
  void drain_pore_pressure(double dt) {
    const auto tables = passes_.cells.tables();
    columns_.sum(tables.tile_keys,
                 [&](const auto& boxes) { add_boxes(passes_.backend, tables, passes_.particles.view(), boxes); });
    if (model().needs_normal_load()) {
      passes_.run(passes_.linear(), AddPressureLoad<Columns>{
                                        columns_.template loading_by_tile<band::NumbersOfColumns>(tables.tile_keys)});
    }
    band::stages::drain_pore_pressure(passes_, model(), hydraulic(),
                                      columns_.template by_tile<band::NumbersOfColumns>(tables.tile_keys), dt,
                                      &sums_->water);
  }
  [[nodiscard]] band::HydraulicConductivity hydraulic() const { return {hydraulic_.data(), hydraulic_.size() == 1}; }

 private:
  [[nodiscard]] const band::BandParameters<Dim>& model() const { return passes_.model.band; }

  Passes& passes_;
  StepSums<Dim>* sums_;
  BodySizes<Backend> sizes_;  // half sizes of particles [m]
  band::SlideColumns<Backend, Dim> columns_;
  exec::Array<double, Backend> hydraulic_{passes_.backend};
  double band_thickness_ = -1.0;  // of the last scaling [m]
};

}  // namespace thawslide::device
