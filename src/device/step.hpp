// A step on a device: momentum to the grid, contact, motion, stress and heat (simulation.cpp has the same stages for
// the processor). Pore pressures rest.
#pragma once

#include <variant>

#include "band/averages_kernel.hpp"
#include "device/block_pass.hpp"
#include "device/cells.hpp"
#include "device/ground.hpp"
#include "device/heat_works.hpp"
#include "device/material_stress.hpp"
#include "device/node_works.hpp"
#include "device/particles.hpp"
#include "device/passes.hpp"
#include "mpm/motion_kernels.hpp"
#include "mpm/position_kernel.hpp"
#include "terrain/band_marks_kernel.hpp"

namespace thawslide::device {

// Shape: of momentum's shape functions (mpm/shape.hpp).
template <class Backend, class Shape, int Dim, class Real>
class Step {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  template <class Name>
  using Numbers = mpm::Named<Name, Array<Real, Backend>>;
  using Sums = StepSums<Dim, Real>;

 public:
  // So many particles of the processor's memory, copied. ask_ground: none where there is no ground.
  Step(Backend& backend, const StepModel<Dim, Real>& model, const mpm::ParticleView<Dim, Real>& particles,
       std::size_t count, AskGround<Dim, Real> ask_ground)
      : backend_(backend),
        model_(model),
        particles_(backend, particles, count),
        cells_(backend, model.cell),
        ground_(backend, std::move(ask_ground)) {
    std::vector<Real> inverse;
    for (const Real half : model.half_sizes) {
      inverse.push_back(Real(1) / half);
    }
    if (model.heat) {
      hydraulic_.set(model.heat->hydraulic_conductivity);
      first_step_ = model.heat->starts;
    }
    half_sizes_.set(model.half_sizes);
    inverse_sizes_.set(inverse);
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
    if (ground_.exists() || model_.heat) {
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
    if (model_.heat) {
      conduct_heat(dt);
      backend_.end_stage("conduct_heat");
    }
    take_positions();
    backend_.end_stage("take_new_positions");
    Sums sums;
    backend_.copy_out(&sums, sums_.data(), 1);
    return sums;
  }

 private:
  // As in simulation.cpp, stage by stage.
  void find_cells() {
    cells_.update(particles_.view(), particles_.by_id(), particles_.size());
    if (!cells_.blocks_changed()) {
      return;
    }
    const std::size_t nodes = cells_.tables().blocks * block_nodes;
    make_room<mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::NearGround, mpm::Contact, mpm::Motion, mpm::Velocity>(
        nodes);
    if (model_.heat) {
      make_room<mpm::HeatRates, mpm::OrphanHeat>(nodes);
      secant_rates_.resize(of<mpm::HeatRates>().size());
      changing_tiles_.resize(cells_.tables().tiles);
      changing_blocks_.resize(cells_.tables().blocks);
    }
    if (ground_.exists()) {
      ground_.update(cells_.tables(), cells_.block_keys());
      base_.resize(nodes * NodeViews<Dim, Real>::base_size);
      backend_.for_each(base_.size(), Fill<Real>{base_.data(), Real(0)});
      bases_.resize(ground_.candidate_count());
    }
  }
  template <class... Names>
  void make_room(std::size_t nodes) {
    (of<Names>().resize(nodes * mpm::record_size(mpm::components_of<Names, Dim>)), ...);
  }

  void average() {
    run(over(LinearWeights{}, EveryTile{}), band::AddAverages<Dim, Real>{});
    sum<mpm::Averages, void>(EveryTile{});
    backend_.for_each(cells_.tables().blocks * block_nodes, SetState<Dim, Real>{views()});
  }

  void add_momentum() {
    run(over(weights(), EveryTile{}),
        mpm::AddMomentum<Dim, Real>{model_.gravity, model_.effective_stress, is_viscous()});
    sum<mpm::Momentum, void>(EveryTile{});
  }

  void resolve_contact(Real time, Real dt) {
    const NodesInStep<Dim, Real> step = nodes_in_step(time, dt);
    if (ground_.exists()) {
      const SeesCandidates<Dim> sees = ground_.sees_candidates();
      run(over(weights(), sees), terrain::AddNearGround<Dim, Real>{model_.phases, model_.lubrication});
      sum<mpm::NearGround, mpm::Clearance>(sees);
      ask_of_base(step);
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

  // The processor chooses the laws.
  void ask_of_base(const NodesInStep<Dim, Real>& step) {
    const std::size_t count = ground_.candidate_count();
    const std::uint32_t* candidates = ground_.candidates();
    backend_.for_each(count, PressOnGround<Dim, Real>{step, candidates});
    const Real face = Dim == 2 ? model_.cell : model_.cell * model_.cell;
    backend_.for_each(
        count, AskOfBase<Dim, Real>{step, candidates, static_cast<Real>(terrain::smallest_area) * face, bases_.data()});
    for (std::size_t g = 0; g < model_.base.grounds.size(); ++g) {
      const int substrate = static_cast<int>(g);
      std::visit(
          [&]<class Law>(const Law& law) {
            backend_.for_each(count,
                              AskFriction<Law, Dim, Real>{law, substrate, ground_.known(), candidates, bases_.data()});
          },
          model_.base.grounds[g].friction);
      std::visit(
          [&]<class Law>(const Law& law) {
            backend_.for_each(count,
                              AskCohesion<Law, Dim, Real>{law, substrate, ground_.known(), candidates, bases_.data()});
          },
          model_.base.grounds[g].cohesion);
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
      const mpm::MaterialModel<Real>& material = model_.materials[m];
      std::visit(
          [&]<class Law>(const Law& law) {
            using Kernel = DeformMaterial<Dim, Real, Law>;
            const Kernel kernel{law,
                                material.elastic,
                                model_.phases,
                                material.gaps_close_first,
                                material.viscosity_time,
                                model_.effective_stress,
                                dt,
                                static_cast<std::int32_t>(m),
                                model_.materials.size() == 1};
            const auto* all = run(over(weights(), EveryTile{}), kernel);
            backend_.for_each(1, Add<mpm::Deformed<Real>>{&all->template of<Kernel>(), &sums_.data()->deformed});
          },
          material.law);
    }
  }

  void conduct_heat(Real dt) {
    using Rescale = RescaleBand<Dim, Real>;
    const Rescale rescale{model_.heat->scaling_in_band, model_.heat->scales_all};
    keep(&run(over(LinearWeights{}, EveryTile{}), rescale)->template of<Rescale>(), &sums_.data()->band_rescale);
    std::visit([&](const auto& content) { conduct_heat_by(content, dt); }, model_.heat->content);
    first_step_ = false;
  }
  template <class Content>
  void conduct_heat_by(const Content& content, Real dt) {
    const TileTables<Dim> tables = cells_.tables();
    const band::HydraulicConductivity<Real> hydraulic{hydraulic_.data(), hydraulic_.size() == 1};
    run(over(LinearWeights{}, EveryTile{}), HeatFlows<Dim, Real, Content>{content, model_.heat->physics, hydraulic, dt,
                                                                          Real(1) / model_.cell, !first_step_});
    sum<mpm::HeatRates, void>(EveryTile{});
    solve_rates(nullptr, dt);
    mark_tiles(MayChange<Dim, Real, Content>{views(), particles_.view(), content, dt});
    backend_.for_each(tables.blocks, MarkBlocks<Dim>{tables, changing_tiles_.data(), changing_blocks_.data()});
    run(over(LinearWeights{}, MarkedTiles{changing_tiles_.data()}), SecantCapacity<Dim, Real, Content>{content, dt});
    backend_.for_each(secant_rates_.size(), SumPatches<mpm::HeatRates, void, EveryTile, Dim, Real>{
                                                tables, {}, memory_.patches(0), secant_rates_.data()});
    keep(&solve_rates(changing_blocks_.data(), dt)->gain, &sums_.data()->heat);
    mark_tiles(HoldsHeat<Dim, Real>{of<mpm::OrphanHeat>().data()});
    run(over(weights(), MarkedTiles{changing_tiles_.data()}), band::TakeOrphanHeat<Dim, Real>{dt});
    run(over(LinearWeights{}, EveryTile{}), TakeHeat<Dim, Real, Content>{content, model_.heat->physics, dt});
  }
  const band::NodalHeat<Real>* solve_rates(const std::uint8_t* changing_blocks, Real dt) {
    const std::size_t blocks = cells_.tables().blocks;
    const SolveRates<Dim, Real> solve{views(),         of<mpm::HeatRates>().data(),  secant_rates_.data(),
                                      changing_blocks, of<mpm::OrphanHeat>().data(), dt};
    return block_pass<Dim>(backend_, blocks, solve, memory_.template sums<band::NodalHeat<Real>>(blocks + 1));
  }
  template <class Asks>
  void mark_tiles(const Asks& asks) {
    constexpr std::size_t threads = 128;
    backend_.for_groups(cells_.tables().tiles, threads, 0,
                        MarkTiles<Asks, Dim>{cells_.tables(), asks, changing_tiles_.data()});
  }

  void take_positions() {
    using Kernel = mpm::TakePosition<Dim, Real>;
    keep(&run(over(LinearWeights{}, EveryTile{}), Kernel{model_.lower, model_.upper})->template of<Kernel>(),
         &sums_.data()->bad);
  }

  [[nodiscard]] bool is_viscous() const {
    return std::any_of(model_.materials.begin(), model_.materials.end(),
                       [](const auto& material) { return material.viscosity_time > Real(0); });
  }

  // What passes are given.
  [[nodiscard]] MomentumWeights<Shape, Dim, Real> weights() const {
    return {{half_sizes_.data(), inverse_sizes_.data(), half_sizes_.size() == 1}, model_.sides};
  }
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
  // What stands in memory that the next pass needs.
  template <class Sum>
  void keep(const Sum* from, Sum* to) {
    backend_.for_each(1, Keep<Sum>{from, to});
  }

  template <class Name>
  [[nodiscard]] Array<Real, Backend>& of() {
    return records_.template of<Name>();
  }
  [[nodiscard]] NodeViews<Dim, Real> views() {
    return {of<mpm::Averages>().data(),
            of<mpm::NodalState>().data(),
            of<mpm::Momentum>().data(),
            of<mpm::NearGround>().data(),
            base_.data(),
            of<mpm::Contact>().data(),
            of<mpm::Motion>().data(),
            of<mpm::Velocity>().data(),
            ground_.exists() ? ground_.known() : nullptr};
  }
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
  PassMemory<Backend, Real> memory_{backend_};
  Array<Real, Backend> half_sizes_{backend_}, inverse_sizes_{backend_}, base_{backend_};
  Array<BaseOfNode<Real>, Backend> bases_{backend_};
  Array<Real, Backend> secant_rates_{backend_}, hydraulic_{backend_};
  Array<std::uint8_t, Backend> changing_tiles_{backend_}, changing_blocks_{backend_};
  bool first_step_ = true;
  Array<Sums, Backend> sums_{backend_, 1};
  mpm::ByName<Numbers<mpm::Averages>, Numbers<mpm::NodalState>, Numbers<mpm::Momentum>, Numbers<mpm::NearGround>,
              Numbers<mpm::Contact>, Numbers<mpm::Motion>, Numbers<mpm::Velocity>, Numbers<mpm::HeatRates>,
              Numbers<mpm::OrphanHeat>>
      records_{{Array<Real, Backend>(backend_)}, {Array<Real, Backend>(backend_)}, {Array<Real, Backend>(backend_)},
               {Array<Real, Backend>(backend_)}, {Array<Real, Backend>(backend_)}, {Array<Real, Backend>(backend_)},
               {Array<Real, Backend>(backend_)}, {Array<Real, Backend>(backend_)}, {Array<Real, Backend>(backend_)}};

 public:
  // The records that a pass reads (device/passes.hpp).
  template <class Name>
  [[nodiscard]] const Real* numbers() const {
    if constexpr (std::is_same_v<Name, terrain::Ground>) {
      return ground_.records();
    } else {
      return records_.template of<Name>().data();
    }
  }
};

}  // namespace thawslide::device
