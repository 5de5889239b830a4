// Stages of heat and pore pressure as sequences of passes, for CPU and devices. Passes: mpm::StepPasses, or
// device::StepPasses. A pass may only have been queued when its call returns, and pointers to results are those of the
// device.
#pragma once

#include "band/averages_kernel.hpp"
#include "band/heat_kernels.hpp"
#include "band/nodal_heat.hpp"
#include "band/nodal_seepage.hpp"
#include "band/nodal_state.hpp"
#include "band/parameters.hpp"
#include "band/pressure_kernels.hpp"
#include "band/rescaling.hpp"
#include "band/tile_conditions.hpp"

namespace thawslide::band::stages {

template <class Passes>
using NodesOf = decltype(std::declval<Passes&>().node_access());

// Averages at nodes (Eq. 21).
template <int Dim, class Passes>
void average_on_grid(Passes& passes, const BandParameters<Dim>& model) {
  passes.run(passes.linear(), AddAverages<Dim>{});
  passes.template solve<mpm::Averages>(
      nullptr, SetState<Dim, NodesOf<Passes>>{passes.node_access(), model.at_faces, model.at_faces.any()});
}

// With sealed or vented frozen rows: replaces the mean pore pressure over all material at nodes by that of the seeping
// water. At nodes without seepage, the mean remains.
template <int Dim, class Passes>
void average_seeping_water(Passes& passes, const BandParameters<Dim>& model, const HydraulicConductivity& hydraulic) {
  if (!model.has_seepage() || model.frozen_rows == FrozenRows::draining ||
      !passes.mark_around(SeepingInState{model, hydraulic})) {
    return;
  }
  passes.run(passes.linear(passes.marked_tiles()), AddSeepingWater<Dim>{model, hydraulic});
  passes.template solve<mpm::SeepingWater>(passes.marked_blocks(),
                                           SetSeepingPressure<NodesOf<Passes>>{passes.node_access()});
}

// As RescaleBand. thickness: of the band [m]; 0: there is none. first: memory index of the first particle.
template <int Dim, class Passes>
void rescale_band(Passes& passes, const BandParameters<Dim>& model, bool follows_ground, double thickness,
                  double* added_heat, std::size_t first = 0) {
  const BandScaling<Dim> scaling{model.region == BandRegion::all, follows_ground, passes.cell(), thickness};
  with_particle_heat(model, [&](const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    passes.total(passes.linear(), RescaleBand<Dim, Law>{model, law, model.pressure, scaling, first}, added_heat);
  });
}

// Heat content, temperature and saturation of particles (Eqs. 9, 18-20). first_step: prescribed temperatures are
// applied as a jump.
template <int Dim, class Passes>
void conduct_heat(Passes& passes, const BandParameters<Dim>& model, const HydraulicConductivity& hydraulic, double dt,
                  bool first_step, HeatGain* gain) {
  average_seeping_water(passes, model, hydraulic);
  if (!model.heat) {
    return;
  }
  with_particle_heat(model, [&](const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    const bool subgrid = model.secant_capacity && !first_step;
    passes.run(passes.linear(), HeatFlows<Dim, Law>{model, hydraulic, law, dt, 1.0 / passes.cell(), subgrid});
    SolveRates<Dim, NodesOf<Passes>> solve{passes.node_access(), nullptr,   dt, passes.cell(), model.at_faces,
                                           model.at_faces.any(), first_step};
    const auto solved = passes.template solve<mpm::HeatRates>(nullptr, solve);
    passes.keep(&solved->gain, gain);
    const bool all_reached = passes.is_known_zero(&solved->unreached_nodes);
    if (model.secant_capacity) {
      passes.mark(MayChange<decltype(law.content)>{law.content, dt});
      passes.run(passes.linear(passes.marked_tiles()), SecantCapacity<Dim, Law>{law, dt});
      // Elsewhere, rates are unchanged except for face conditions.
      solve.secant_blocks = passes.marked_blocks();
      const auto again = passes.template solve<mpm::SecantRates>(solve.secant_blocks, solve, solve.has_faces);
      passes.keep(&again->gain.boundary, &gain->boundary);
    }
    if (!all_reached) {
      passes.run(passes.momentum(passes.in_reach(HasHeat{})), RedistributeUnreachedHeat<Dim>{dt});
    }
    if (model.secant_capacity) {
      passes.run(passes.linear(), UpdateHeat<Dim, Law>{model, law, dt});
    } else {
      passes.total(passes.linear(), UpdateHeatApparentCapacity<Dim, Law>{model, law, dt}, &gain->capacity);
    }
  });
}

// Pore pressure of particles (Eqs. 4, 8, 22, 23). columns: of the sliding mass, by tile.
template <int Dim, class Passes, class Columns>
void drain_pore_pressure(Passes& passes, const BandParameters<Dim>& model, const HydraulicConductivity& hydraulic,
                         const Columns& columns, double dt, WaterLoss* loss) {
  const auto update = [&](auto seeps) {
    const auto run = [&](auto balances) {
      passes.total(
          passes.linear(),
          UpdatePorePressure<Columns, decltype(seeps)::value, decltype(balances)::value>{model, hydraulic, columns},
          &loss->drained);
    };
    model.balances_water() ? run(std::true_type{}) : run(std::false_type{});
  };
  if (!model.has_seepage() || !passes.mark_around(SeepingBefore{model, hydraulic})) {
    update(std::false_type{});
    return;
  }
  passes.run(passes.linear(passes.marked_tiles()), SeepageFlows<Dim>{model, hydraulic, dt, 1.0 / passes.cell()});
  const auto absorbed = passes.template solve<mpm::Seepage>(passes.marked_blocks(),
                                                            SolveSeepage<NodesOf<Passes>>{passes.node_access(), dt});
  passes.keep(&*absorbed, &loss->absorbed);
  update(std::true_type{});
}

}  // namespace thawslide::band::stages
