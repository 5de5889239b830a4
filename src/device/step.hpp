// Stages of a time step (mpm/step_sequence.hpp) on a device.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "band/map_stage.hpp"
#include "device/band_stages.hpp"
#include "device/contact_passes.hpp"
#include "device/escape_check.hpp"
#include "device/position_kernels.hpp"
#include "device/reductions.hpp"
#include "mpm/body_contact.hpp"
#include "mpm/front_stage.hpp"
#include "mpm/monitor_sums.hpp"
#include "mpm/motion_stages.hpp"
#include "mpm/step_sequence.hpp"
#include "mpm/velocity_filter.hpp"

namespace thawslide::device {

// Unit normals into the ground at nodes, for band columns.
template <int Dim>
struct NormalsAtNodes {
  const terrain::GroundAtNode<Dim>* known;  // by node

  [[nodiscard]] THAWSLIDE_HD const Vector<double, Dim>& operator()(std::size_t block, std::size_t node) const {
    return known[static_cast<std::size_t>(mpm::Tile<Dim>::nodes) * block + node].normal;
  }
};

// Shape: shape functions of momentum (mpm/shape.hpp).
template <class Backend, class Shape, int Dim>
class Step {
  using Passes = StepPasses<Backend, Shape, Dim>;
  using Sums = StepSums<Dim>;
  using FindExtremes = SumOf<band::ExtremesOfParticle<Dim>>;

 public:
  // Copies `count` particles from CPU memory.
  Step(Backend& backend, const StepModel<Dim>& model, const mpm::ParticleView<Dim>& particles, std::size_t count,
       const HostCallbacks<Dim>& callbacks)
      : passes_(backend, model, particles, count, callbacks.ground),
        sums_(backend, 1),
        band_(passes_, callbacks, sums_.data()),
        maps_(backend, model.cell),
        sizes_of_boxes_(backend, model.half_sizes, model.cell),
        bed_(callbacks.bed) {
    if (model.band_columns) {
      band_columns_.emplace(backend, *model.band_columns, model.cell, model.motion.gravity);
      band_columns_->set(model.segments);
      passes_.model.segments = {};
    }
    if (passes_.model.mapping.has_ground) {
      column_heights_.set(callbacks.column_heights());
      // Not those of the CPU, which may contract products and sums: a restart would not have the same bits.
      backend.for_each(count, VisitInMemory<Dim, terrain::LocateAboveGround<Dim, ColumnHeights<Dim>>>{
                                  passes_.particles.view(), above_ground()});
    }
    free_gaps_.set(model.free_gaps);
    set_layers(model.time);
  }

  // Copies to the same number of particles, in their original order.
  void copy_to(const mpm::ParticleView<Dim>& particles) { passes_.particles.copy_to(particles); }
  // Both require band columns.
  [[nodiscard]] band::SegmentsState<Dim> segments() const { return band_columns_->state(); }
  [[nodiscard]] band::BaseTotals base_totals() { return band_columns_->totals(); }
  void copy_momentum_to(std::vector<std::uint64_t>& blocks, std::vector<double>& records) {
    blocks = passes_.cells.block_keys();
    records = passes_.template of<mpm::Momentum>().get();
  }
  [[nodiscard]] TileTables<Dim> tables() const { return passes_.cells.tables(); }

  // Sorts particles in memory into canonical order. Does not affect results.
  void sort_in_memory() {
    find_cells();
    passes_.particles.reorder(passes_.cells.tables().order);
    passes_.cells.store_memory_order();
  }

  // Advances the solution by dt [s], from time [s]. strength: replaces the basal laws of the case; or null.
  Sums step(double time, double dt, const terrain::StrengthLaw* strength) {
    passes_.backend.for_each(1, Fill<Sums>{sums_.data(), {}});
    mpm::perform_step(*this, time, dt, strength);
    return sums_.get(0);
  }

  band::StepExtremes extremes() {
    find_cells();
    return passes_.sum_over_particles(extremes_kernel().of);
  }
  // Reductions over the particles after a step.
  AnySums<Dim> reduce(const AnyReduction<Dim>& reduction) {
    return std::visit([this](const auto& of) -> AnySums<Dim> { return passes_.sum_over_particles(of); }, reduction);
  }
  mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) {
    return front_.find(path, mass, passes_.particles.view(), passes_.cells.tables().order, passes_.particles.size());
  }
  // Positions [m, relative to the domain's lower corner] of the particles that the last step counted as escaped.
  std::vector<Vector<double, Dim>> escaped_positions() {
    return escape_check_.indices(passes_, escape_kernel(), sums_.get(0).escapes);
  }
  const band::MapSample* sample_map([[maybe_unused]] const mpm::MapCells& cells) {
    if constexpr (Dim == 3) {
      return &maps_.sample(
          cells, [this] { return passes_.cells.tile_keys(); }, sizes_of_boxes_.view(),
          band_columns_ ? &*band_columns_ : nullptr,
          [this](const auto& boxes) {
            add_boxes(passes_.backend, passes_.cells.tables(), passes_.particles.view(), boxes);
          });
    } else {
      return nullptr;
    }
  }

 private:
  using ContactOfBodies = mpm::BodyContactArgs<device::ContactNodes<Dim>, Dim>;
  template <class Stages, class StrengthLaw>
  friend void mpm::perform_step(Stages&, double, double, const StrengthLaw*);

  // The stages of mpm::perform_step.
  template <class Work>
  void measure(const char* stage, const Work& work) {
    work();
    passes_.backend.end_stage(stage);
  }
  [[nodiscard]] bool moves() const { return passes_.model.moves; }
  [[nodiscard]] bool rescaling_mixes() const { return passes_.model.band.rescaling_mixes; }
  void find_cells(double time) {
    set_layers(time);
    find_cells();
  }
  void rescale_band(double time) {
    if (!passes_.model.contact.band_columns) {
      band_.rescale(time);
    }
  }
  void average_band_on_grid(bool /*law_is_given*/) {
    if (passes_.ground.exists() || passes_.model.has_band()) {
      band_.average();
    }
  }
  void momentum_to_grid() {
    mpm::stages::momentum_to_grid<Dim>(passes_, passes_.model.motion, passes_.width(), force_of_walls_.data());
  }
  void conduct_heat(double dt) {
    if (passes_.model.has_band()) {
      band_.conduct_heat(dt);
    }
  }
  void drain_pore_pressure(double dt) {
    if (passes_.model.band.pressure) {
      band_.drain_pore_pressure(dt);
    }
  }

  void set_layers(double time) {
    if (passes_.model.layers_of_bodies) {
      passes_.cells.set_layers(passes_.model.layers_of_bodies(time));
    }
  }

  void find_cells() {
    passes_.cells.update(passes_.particles.view(), passes_.particles.by_id(), passes_.particles.size());
    if (!passes_.cells.blocks_changed()) {
      return;
    }
    const std::size_t nodes = passes_.cells.tables().blocks * Passes::block_nodes;
    passes_.nodes.template resize_for<mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::NearGround, mpm::Contact,
                                      mpm::Motion, mpm::Velocity>(nodes);
    passes_.marks.resize(passes_.cells.tables());
    maps_.forget_tiles();
    band_.resize_for(nodes);
    if (!passes_.model.moves) {
      for (exec::Array<double, Backend>* records :
           {&passes_.template of<mpm::Momentum>(), &passes_.template of<mpm::Contact>()}) {
        passes_.backend.for_each(records->size(), Fill<double>{records->data(), 0.0});
      }
    }
    const bool has_pairs = passes_.model.between_bodies.any();
    std::vector<std::uint64_t> blocks;
    if (has_pairs || passes_.ground.exists()) {
      blocks = passes_.cells.block_keys();
    }
    if (has_pairs) {
      body_contact_.update_pairs(blocks, passes_.model.between_bodies);
    }
    if (passes_.ground.exists()) {
      passes_.ground.update(blocks);
      exec::Array<double, Backend>& base = passes_.template of<mpm::BaseLoad>();
      base.resize(nodes * mpm::record_size(mpm::components_of<mpm::BaseLoad, Dim>));
      passes_.backend.for_each(base.size(), Fill<double>{base.data(), 0.0});
    }
  }
  void resolve_contact(double time, double dt, const terrain::StrengthLaw* strength) {
    if (passes_.model.between_bodies.any()) {
      body_contact_.add_forces(between_bodies(dt));
    }
    mpm::BaseStates<Dim> columns;
    if (band_columns_) {
      band_columns_->to_nodes(passes_.block_tables());
      columns = band_columns_->states();
    }
    ContactPasses<Backend, Shape, Dim> passes(passes_, time, dt);
    contact_.resolve(
        passes, passes_.model.contact, columns, [] {}, bed_, strength,
        passes_.model.width.varies() ? force_of_walls_.data() : nullptr, &sums_.data()->contact);
    update_columns(time, dt);
  }
  void update_columns(double time, double dt) {
    if (band_columns_) {
      using OfColumns = terrain::GroundAnywhere<Dim, ColumnHeights<Dim>>;
      const OfColumns ground{passes_.model.columns,
                             {passes_.model.columns, column_heights_.data()},
                             passes_.model.half_sizes.front(),
                             passes_.model.cell,
                             passes_.width()};
      band_columns_->update(
          band::BaseInStep<ContactNodes<Dim>, OfColumns, NormalsAtNodes<Dim>, Dim>{
              passes_.block_tables(), passes_.contact_nodes(), ground, {passes_.ground.known()}},
          passes_.model.band_thickness(time), dt);
    }
  }

  void move_particles(double time, double dt) {
    const mpm::MotionParameters<Dim>& motion = passes_.model.motion;
    mpm::stages::move_particles<Dim>(passes_, motion, dt, &sums_.data()->particle_kinetic);
    if (motion.filter_order > 0 && passes_.model.filters_in_step(time, dt)) {
      mpm::stages::filter_velocities<Dim>(passes_, motion.filter_order, &sums_.data()->filtered);
    }
    passes_.template sum_all<mpm::Velocity>();
    ContactPasses<Backend, Shape, Dim>(passes_, time, dt)
        .add_nodes(terrain::MapBack<Dim>{motion.gravity}, &sums_.data()->mapped_back);
    if (passes_.model.between_bodies.any()) {
      const std::size_t count = body_contact_.work_count();
      auto* works = passes_.memory.template sums<mpm::BodyContactWork>(partial_sum_count(count));
      body_contact_.constrain_mapped_back(between_bodies(dt), works);
      passes_.keep(add_up(passes_.backend, works, count), &sums_.data()->between_bodies);
    }
  }
  [[nodiscard]] ContactOfBodies between_bodies(double dt) {
    return {passes_.cells.tables(),
            passes_.particles.view(),
            passes_.body_sizes(),
            passes_.model.mapping.has_ground,
            passes_.model.cell,
            passes_.model.contact.mass_damping,
            dt,
            passes_.model.motion.gravity,
            passes_.contact_nodes()};
  }

  void update_stress_and_porosity(double dt) {
    mpm::stages::update_stress_and_porosity<Dim>(passes_, passes_.model.motion, passes_.width(), dt,
                                                 &sums_.data()->deformed);
  }

  // Updates positions and evaluates the reductions that the CPU requested.
  void update_positions() {
    const UpdatePosition<Dim> update{
        {passes_.model.lower, passes_.model.upper}, passes_.model.mapping.has_ground, above_ground()};
    const FindExtremes extremes = extremes_kernel();
    const CountEscaped<Dim> escapes = escape_kernel();
    if (passes_.model.finds_extremes && passes_.model.counts_escaped) {
      update_positions(update, extremes, escapes);
    } else if (passes_.model.finds_extremes) {
      update_positions(update, extremes);
    } else if (passes_.model.counts_escaped) {
      update_positions(update, escapes);
    } else {
      update_positions(update);
    }
  }
  [[nodiscard]] terrain::LocateAboveGround<Dim, ColumnHeights<Dim>> above_ground() const {
    return {passes_.model.columns,
            {passes_.model.columns, column_heights_.data()},
            passes_.body_sizes(),
            static_cast<double>(passes_.model.cell)};
  }
  [[nodiscard]] FindExtremes extremes_kernel() const {
    return {{passes_.model.band, band_.hydraulic(), {free_gaps_.data()}}};
  }
  [[nodiscard]] CountEscaped<Dim> escape_kernel() const {
    return {passes_.cells.tables().blocks_about_tile,
            passes_.ground.exists() ? passes_.ground.partly_unknown() : nullptr, passes_.model.extent};
  }
  template <class... Kernels>
  void update_positions(const Kernels&... kernels) {
    const auto* all = passes_.run(passes_.linear(), kernels...);
    (passes_.keep(&all->template of<Kernels>(), reduced(&all->template of<Kernels>())), ...);
  }
  // Destination, in device memory, of each sum of the last pass.
  mpm::InvalidParticle* reduced(const mpm::InvalidParticle* /*sum*/) { return &sums_.data()->invalid; }
  band::StepExtremes* reduced(const band::StepExtremes* /*sum*/) { return &sums_.data()->extremes; }
  std::uint64_t* reduced(const std::uint64_t* /*sum*/) { return &sums_.data()->escapes; }

  Passes passes_;
  mpm::BodyContact<Backend, Dim> body_contact_{passes_.backend};
  exec::Array<Sums, Backend> sums_;
  exec::Array<double, Backend> force_of_walls_{passes_.backend, 1};  // of a section, along x [N]
  BandStages<Backend, Shape, Dim> band_;
  band::MapStage<Backend> maps_;
  BodySizes<Backend> sizes_of_boxes_;                              // half sizes of particles [m]
  std::optional<band::BasalSegments<Backend, Dim>> band_columns_;  // none unless the band consists of columns
  terrain::Bed<Dim>* bed_;                                         // on the CPU; null without an erodible bed
  exec::Array<double, Backend> column_heights_{passes_.backend};
  exec::Array<double, Backend> free_gaps_{passes_.backend};
  terrain::ContactStage<Backend, Dim> contact_{passes_.backend};
  EscapeCheck<Backend, Dim> escape_check_{passes_.backend};
  mpm::Front<Backend, Dim> front_{passes_.backend};
};

}  // namespace thawslide::device
