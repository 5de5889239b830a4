// A step on a device: momentum to the grid, contact, motion, stress, heat and pore pressure (simulation.cpp has the
// same stages for the processor).
#pragma once

#include <variant>

#include "band/averages_kernel.hpp"
#include "device/base_laws.hpp"
#include "device/block_pass.hpp"
#include "device/body_sizes.hpp"
#include "device/cells.hpp"
#include "device/columns.hpp"
#include "device/ground.hpp"
#include "device/heat_works.hpp"
#include "device/looks.hpp"
#include "device/maps.hpp"
#include "device/marks.hpp"
#include "device/material_stress.hpp"
#include "device/node_memory.hpp"
#include "device/particles.hpp"
#include "device/pressure_works.hpp"
#include "mpm/motion_kernels.hpp"
#include "mpm/position_kernel.hpp"
#include "terrain/band_marks_kernel.hpp"

namespace thawslide::device {

// Shape: of momentum's shape functions (mpm/shape.hpp).
template <class Backend, class Shape, int Dim, class Real>
class Step {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  using Sums = StepSums<Dim, Real>;

 public:
  // So many particles of the processor's memory, copied.
  Step(Backend& backend, const StepModel<Dim, Real>& model, const mpm::ParticleView<Dim, Real>& particles,
       std::size_t count, const AskTerrain<Dim, Real>& ask)
      : backend_(backend),
        model_(model),
        particles_(backend, particles, count),
        cells_(backend, model.cell),
        ground_(backend, ask.ground),
        sizes_(backend, model.half_sizes, Real(1)),
        columns_(backend, model.cell, model.half_sizes, ask.slope_cosine, ask.normal_gravity),
        maps_(backend, model.cell, model.half_sizes) {
    hydraulic_.set(model.hydraulic_conductivity);
    sums_.set(std::vector<Sums>(1));
  }

  [[nodiscard]] const Particles<Backend, Dim, Real>& particles() const { return particles_; }
  [[nodiscard]] TileTables<Dim> tables() const { return cells_.tables(); }

  // Particles move in memory to stand in canonical order. Results do not depend on it.
  void sort_in_memory() {
    find_cells();
    particles_.reorder(cells_.tables().order);
    cells_.note_order_in_memory();
  }

  // One step of dt [s] from a time [s] on.
  Sums step(Real time, Real dt) {
    find_cells();
    backend_.end_stage("find_cells");
    if (model_.band.rescaling_mixes) {
      rescale_band(time);  // which changes temperatures
    }
    if (ground_.exists() || model_.has_band()) {
      average();
      backend_.end_stage("average_band_on_grid");
    }
    add_momentum();
    backend_.end_stage("momentum_to_grid");
    resolve_contact(time, dt);
    backend_.end_stage("resolve_contact");
    move(time, dt);
    backend_.end_stage("move_particles");
    update_stress(dt);
    backend_.end_stage("update_stress_and_porosity");
    if (model_.has_band()) {
      conduct_heat(time, dt);
      backend_.end_stage("conduct_heat");
    }
    if (model_.pressure_changes) {
      drain_pore_pressure(dt);
      backend_.end_stage("drain_pore_pressure");
    }
    take_positions();
    backend_.end_stage("take_new_positions");
    return sums_.get(0);
  }

  // Of the particles as they are after a step.
  mpm::WatchedSums<Real> watch(const mpm::LookAtParticle<Dim, Real>& look) {
    return sum_over_particles(Watch<Dim, Real>{look}, watched_);
  }
  void look_at_map([[maybe_unused]] const mpm::MapCells& cells, [[maybe_unused]] MapLook& look) {
    if constexpr (Dim == 3) {
      look.moments = sum_over_particles(SumMoments{}, moments_);
      maps_.sum(cells, cells_.tables(), particles_.view(), look);
    }
  }

 private:
  // As in simulation.cpp, stage by stage.
  void find_cells() {
    cells_.update(particles_.view(), particles_.by_id(), particles_.size());
    if (!cells_.blocks_changed()) {
      return;
    }
    const std::size_t nodes = cells_.tables().blocks * block_nodes;
    nodes_.template make_room<mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::NearGround, mpm::Contact, mpm::Motion,
                              mpm::Velocity>(nodes);
    marks_.resize(cells_.tables());
    maps_.forget_tiles();
    if (model_.heat) {
      nodes_.template make_room<mpm::HeatRates, mpm::OrphanHeat>(nodes);
      secant_rates_.resize(of<mpm::HeatRates>().size());
    }
    if (model_.pressure_changes) {
      nodes_.template make_room<mpm::Seepage, mpm::SeepingWater>(nodes);
      columns_.update(cells_.tables());
    }
    if (ground_.exists()) {
      ground_.update(cells_.tables(), cells_.block_keys());
      nodes_.clear_base(nodes);
      bases_.resize(ground_.candidate_count());
    }
  }
  void average() {
    run(over(LinearWeights{}, EveryTile{}), band::AddAverages<Dim, Real>{});
    sum<mpm::Averages, void>(EveryTile{});
    backend_.for_each(cells_.tables().blocks * block_nodes, SetState<Dim, Real>{views()});
  }

  void add_momentum() {
    run(over(weights(), EveryTile{}),
        mpm::AddMomentum<Dim, Real>{model_.gravity, model_.effective_stress, model_.is_viscous()});
    sum<mpm::Momentum, void>(EveryTile{});
  }

  void resolve_contact(Real time, Real dt) {
    const NodesInStep<Dim, Real> step = nodes_in_step(time, dt);
    if (ground_.exists()) {
      const SeesCandidates<Dim> sees = ground_.sees_candidates();
      run(over(weights(), sees), terrain::AddNearGround<Dim, Real>{model_.phases, model_.lubrication});
      sum<mpm::NearGround, mpm::Clearance>(sees);
      ask_of_base(backend_, step, model_.base, model_.cell, ground_, bases_.data());
    }
    const std::size_t blocks = step.tables.blocks;
    keep(block_pass<Dim>(
             backend_, blocks,
             ResolveContact<Dim, Real>{step, ground_.exists() ? ground_.number() : nullptr, bases_.data(),
                                       model_.base.clamp, model_.base.cap_pressure, model_.base.heat_fraction},
             memory_.template sums<terrain::ContactWork<Dim, Real>>(blocks + 1)),
         &sums_.data()->contact);
    if (ground_.exists()) {
      backend_.for_each(particles_.size(),
                        VisitInMemory<Dim, Real, terrain::LeaveBand<Dim, Real>>{particles_.view(), {}});
      run(over(LinearWeights{}, ground_.sees_candidates()), terrain::MarkBand<Dim, Real>{dt});
    }
  }

  void move(Real time, Real dt) {
    using Kernel = mpm::Move<Dim, Real>;
    keep(&run(over(weights(), EveryTile{}), Kernel{model_.pic_share, dt})->template of<Kernel>(),
         &sums_.data()->particle_kinetic);
    sum<mpm::Velocity, void>(EveryTile{});
    const std::size_t blocks = cells_.tables().blocks;
    keep(block_pass<Dim>(backend_, blocks, MapBack<Dim, Real>{nodes_in_step(time, dt)},
                         memory_.template sums<Real>(blocks + 1)),
         &sums_.data()->mapped_back);
  }

  void update_stress(Real dt) {
    backend_.for_each(1, Fill<mpm::Deformed<Real>>{&sums_.data()->deformed, {}});
    for (std::size_t m = 0; m < model_.materials.size(); ++m) {
      std::visit(
          [&]<class Law>(const Law& law) {
            using Kernel = DeformMaterial<Dim, Real, Law>;
            const auto* all = run(over(weights(), EveryTile{}), Kernel::of(law, model_, m, dt));
            backend_.for_each(1, Add<mpm::Deformed<Real>>{&all->template of<Kernel>(), &sums_.data()->deformed});
          },
          model_.materials[m].law);
    }
  }

  void rescale_band(Real time) {
    const Real scaling = model_.scaling_in_band(time);
    backend_.for_each(1, Fill<Real>{&sums_.data()->band_rescale, Real(0)});
    if (model_.scales_all && scaling == scaling_in_force_) {
      return;
    }
    scaling_in_force_ = scaling;
    std::visit(
        [&]<class Content>(const Content& content) {
          using Kernel = RescaleBand<Dim, Real, Content>;
          const Kernel kernel{content, model_.band, model_.pressure_changes, model_.scales_all, scaling};
          keep(&run(over(LinearWeights{}, EveryTile{}), kernel)->template of<Kernel>(), &sums_.data()->band_rescale);
        },
        model_.heat_content);
  }

  void conduct_heat(Real time, Real dt) {
    if (!model_.band.rescaling_mixes) {
      rescale_band(time);
    }
    average_seeping_water();
    if (model_.heat) {
      std::visit([&](const auto& content) { conduct_heat_by(content, dt); }, model_.heat_content);
      model_.starts = false;
    }
  }
  template <class Content>
  void conduct_heat_by(const Content& content, Real dt) {
    run(over(LinearWeights{}, EveryTile{}),
        HeatFlows<Dim, Real, Content>{content, model_.band, hydraulic(), dt, Real(1) / model_.cell, !model_.starts});
    sum<mpm::HeatRates, void>(EveryTile{});
    solve_rates(nullptr, dt);
    marks_.mark_tiles(cells_.tables(), MayChange<Dim, Real, Content>{views(), particles_.view(), content, dt});
    marks_.mark_blocks(cells_.tables());
    run(over(LinearWeights{}, marks_.tiles()), SecantCapacity<Dim, Real, Content>{content, dt});
    backend_.for_each(secant_rates_.size(), SumPatches<mpm::HeatRates, void, EveryTile, Dim, Real>{
                                                cells_.tables(), {}, memory_.patches(0), secant_rates_.data()});
    keep(&solve_rates(marks_.blocks(), dt)->gain, &sums_.data()->heat);
    marks_.mark_tiles(cells_.tables(), HoldsHeat<Dim, Real>{of<mpm::OrphanHeat>().data()});
    run(over(weights(), marks_.tiles()), band::TakeOrphanHeat<Dim, Real>{dt});
    run(over(LinearWeights{}, EveryTile{}), TakeHeat<Dim, Real, Content>{content, model_.band, dt});
  }
  const band::NodalHeat<Real>* solve_rates(const std::uint8_t* changing_blocks, Real dt) {
    const std::size_t blocks = cells_.tables().blocks;
    const SolveRates<Dim, Real> solve{views(),         of<mpm::HeatRates>().data(),  secant_rates_.data(),
                                      changing_blocks, of<mpm::OrphanHeat>().data(), dt};
    return block_pass<Dim>(backend_, blocks, solve, memory_.template sums<band::NodalHeat<Real>>(blocks + 1));
  }

  // Marks the blocks that water seeps to, and the tiles about them; false if there are none.
  template <class Asks>
  bool find_seepage(const Asks& asks) {
    if (!model_.lets_water_seep()) {
      return false;
    }
    marks_.mark_tiles(cells_.tables(), asks);
    marks_.mark_blocks(cells_.tables());
    return marks_.mark_tiles_about(cells_.tables());
  }

  void average_seeping_water() {
    if (model_.band.frozen_rows == band::FrozenRows::draining ||
        !find_seepage(SeepingNow<Dim, Real>{particles_.view(), model_.band, hydraulic()})) {
      return;
    }
    run(over(LinearWeights{}, marks_.tiles()), AddSeepingWater<Dim, Real>{model_.band, hydraulic()});
    sum<mpm::SeepingWater, void>(marks_.tiles());
    backend_.for_each(cells_.tables().blocks * block_nodes,
                      SetSeepingPressure<Dim, Real>{views(), of<mpm::SeepingWater>().data(), marks_.blocks()});
  }

  void drain_pore_pressure(Real dt) {
    columns_.sum(cells_.tables(), particles_.view());
    if (model_.band.needs_normal_load()) {
      run(over(LinearWeights{}, EveryTile{}), TakeLoad<Dim, Real>{columns_.loading(cells_.tables())});
    }
    if (find_seepage(SeepingBefore<Dim, Real>{{particles_.view(), model_.band, hydraulic()}})) {
      seep(dt);
      update_pressure<true>();
    } else {
      backend_.for_each(1, Fill<Real>{&sums_.data()->vented, Real(0)});
      update_pressure<false>();
    }
  }
  void seep(Real dt) {
    run(over(LinearWeights{}, marks_.tiles()),
        SeepageFlows<Dim, Real>{model_.band, hydraulic(), dt, Real(1) / model_.cell});
    sum<mpm::Seepage, void>(marks_.tiles());
    const std::size_t blocks = cells_.tables().blocks;
    const Real* taken =
        block_pass<Dim>(backend_, blocks, SolveSeepage<Dim, Real>{views(), of<mpm::Seepage>().data(), dt},
                        memory_.template sums<Real>(blocks + 1));
    backend_.for_each(1, KeepVented<Real>{taken, model_.band.phases, &sums_.data()->vented});
  }
  template <bool Seeps>
  void update_pressure() {
    if (model_.band.balances_water()) {
      update_pressure_by<UpdatePorePressure<Dim, Real, Seeps, true>>();
    } else {
      update_pressure_by<UpdatePorePressure<Dim, Real, Seeps, false>>();
    }
  }
  template <class Kernel>
  void update_pressure_by() {
    const Kernel kernel{model_.band, hydraulic(), columns_.seen(cells_.tables())};
    keep(&run(over(LinearWeights{}, EveryTile{}), kernel)->template of<Kernel>(), &sums_.data()->drained);
  }

  // And what the processor asks of the particles at their new places.
  void take_positions() {
    using Kernel = mpm::TakePosition<Dim, Real>;
    using Extremes = FindExtremes<Dim, Real>;
    using Strays = CountStrays<Dim, Real>;
    const auto all = over(LinearWeights{}, EveryTile{});
    keep(&run(all, Kernel{model_.lower, model_.upper})->template of<Kernel>(), &sums_.data()->bad);
    if (model_.tells_extremes) {
      keep(&run(all, Extremes{model_.band, hydraulic()})->template of<Extremes>(), &sums_.data()->extremes);
    }
    if (model_.tells_strays) {
      const Strays strays{cells_.tables().blocks_about_tile, ground_.exists() ? ground_.partly_unknown() : nullptr,
                          model_.faces.extent};
      keep(&run(all, strays)->template of<Strays>(), &sums_.data()->strays);
    }
  }

  [[nodiscard]] band::HydraulicConductivity<Real> hydraulic() const {
    return {hydraulic_.data(), hydraulic_.size() == 1};
  }

  // What passes are given.
  [[nodiscard]] MomentumWeights<Shape, Dim, Real> weights() const { return {sizes_.view(), model_.sides}; }
  template <class Weights, class Takes>
  [[nodiscard]] PassOver<Weights, Takes, Dim, Real> over(const Weights& weights, const Takes& takes) const {
    return {cells_.tables(), particles_.view(), weights, takes, model_.cell};
  }
  template <class Over, class... Kernels>
  SumsOf<Kernels...>* run(const Over& over, const Kernels&... kernels) {
    return particle_pass(backend_, memory_, over, *this, kernels...);
  }
  template <class Name, class Lowered, class Takes>
  void sum(const Takes& takes) {
    const std::size_t numbers = of<Name>().size();
    backend_.for_each(numbers, SumPatches<Name, Lowered, Takes, Dim, Real>{cells_.tables(), takes, memory_.patches(0),
                                                                           of<Name>().data()});
  }
  template <class Kernel, class Sum>
  Sum sum_over_particles(const Kernel& kernel, Array<Sum, Backend>& sum) {
    keep(&run(over(LinearWeights{}, EveryTile{}), kernel)->template of<Kernel>(), sum.data());
    return sum.get(0);
  }
  // What stands in memory that the next pass needs.
  template <class Sum>
  void keep(const Sum* from, Sum* to) {
    backend_.for_each(1, Keep<Sum>{from, to});
  }

  template <class Name>
  [[nodiscard]] Array<Real, Backend>& of() {
    return nodes_.template of<Name>();
  }
  [[nodiscard]] NodeViews<Dim, Real> views() { return nodes_.views(ground_.exists() ? ground_.known() : nullptr); }
  [[nodiscard]] NodesInStep<Dim, Real> nodes_in_step(Real time, Real dt) {
    return {cells_.tables(),     views(), model_.faces, model_.gravity,        model_.cell,
            model_.mass_damping, time,    dt,           model_.distance_check, model_.pore_pressure,
            model_.base_holds};
  }

  Backend& backend_;
  StepModel<Dim, Real> model_;
  Particles<Backend, Dim, Real> particles_;
  Cells<Backend, Dim, Real> cells_;
  Ground<Backend, Dim, Real> ground_;
  BodySizes<Backend, Real> sizes_;  // of particles, in cells
  Columns<Backend, Dim, Real> columns_;
  Maps<Backend, Real> maps_;
  PassMemory<Backend, Real> memory_{backend_};
  NodeMemory<Backend, Dim, Real> nodes_{backend_};
  Array<BaseOfNode<Real>, Backend> bases_{backend_};
  Array<Real, Backend> secant_rates_{backend_}, hydraulic_{backend_};
  Marks<Backend, Dim> marks_{backend_};
  Real scaling_in_force_ = 0;
  Array<Sums, Backend> sums_{backend_, 1};
  Array<mpm::WatchedSums<Real>, Backend> watched_{backend_, 1};
  Array<mpm::MassMoments, Backend> moments_{backend_, 1};

 public:
  // The records that a pass reads (device/passes.hpp).
  template <class Name>
  [[nodiscard]] const Real* numbers() const {
    if constexpr (std::is_same_v<Name, terrain::Ground>) {
      return ground_.records();
    } else {
      return nodes_.template of<Name>().data();
    }
  }
};

}  // namespace thawslide::device
