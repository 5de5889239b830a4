// Time step on the CPU, by lanes of vector registers and threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "band/flow_depth.hpp"
#include "band/map_stage.hpp"
#include "band/stages_on_cpu.hpp"
#include "base/clocks.hpp"
#include "mpm/body_contact.hpp"
#include "mpm/step_sequence.hpp"
#include "sim/solver/base.hpp"
#include "sim/solver/clock.hpp"
#include "sim/solver/slide.hpp"
#include "sim/solver/solver.hpp"
#include "terrain/contact.hpp"

namespace thawslide::sim {

template <int Dim>
class CpuSolver final : public Solver<Dim> {
 public:
  // All arguments must outlive the solver, which adds the time of its stages to the stopwatch.
  CpuSolver(const Setup<Dim>& setup, Slide<Dim>& slide, Base<Dim>& base, const Clock& clock, Stopwatch& stopwatch)
      : setup_(setup), slide_(slide), base_(base), clock_(clock), stopwatch_(stopwatch) {}

  // Initializes everything of the particles that follows from their positions and stress at t = 0.
  void begin();
  // The same for particles that join at memory index `first` and above.
  void join(std::size_t first);
  // Updates the grid, its layers and the ground at its nodes to the particles.
  void find_cells() { find_cells(clock_.time); }

  // Nodes of the last step.
  [[nodiscard]] const mpm::Nodes<Dim>& nodes() const { return nodes_; }

  void start() override {}
  StepSums<Dim> step(double dt, const terrain::StrengthLaw* strength) override;
  [[nodiscard]] bool none_has_left() const override { return false; }
  [[nodiscard]] AnySums<Dim> reduce(const AnyReduction<Dim>& reduction) const override;
  [[nodiscard]] band::StepExtremes extremes() const override;
  [[nodiscard]] mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) const override;
  [[nodiscard]] band::BaseTotals base_totals() const override { return base_.columns->totals(); }
  [[nodiscard]] const band::MapSample* sample_map(const mpm::MapCells& cells) const override;
  [[nodiscard]] MomentumOfNodes momentum_of_nodes() const override;
  void copy_particles_back() const override {}
  void copy_columns_back() const override {}
  void sync_to_host() const override {}
  void release() override {}

 private:
  template <class Stages, class StrengthLaw>
  friend void mpm::perform_step(Stages&, double, double, const StrengthLaw*);

  // The stages of mpm::perform_step, and their parts.
  template <class Work>
  void measure(const char* stage, const Work& work) {
    stopwatch_.time(stage, work);
  }
  [[nodiscard]] bool moves() const { return setup_.parameters.mechanics.enabled; }
  [[nodiscard]] bool rescaling_mixes() const { return setup_.model.band.rescaling_mixes; }
  void find_cells(double time);
  void rescale_band(double time);
  void average_band_on_grid(bool law_is_given);
  void momentum_to_grid();
  void resolve_contact(double time, double dt, const terrain::StrengthLaw* strength);
  void move_particles(double time, double dt);
  void update_stress_and_porosity(double dt);
  void conduct_heat(double dt);
  void drain_pore_pressure(double dt);
  void update_positions();

  using ContactOfBodies = mpm::BodyContactArgs<mpm::NodeAccess<Dim>, Dim>;

  [[nodiscard]] band::StagesOnCpu<Dim> band_stages() {
    return {slide_.grid, setup_.model.band, slide_.particles, nodes_};
  }
  [[nodiscard]] bool needs_normal_load() const {
    return setup_.model.band.pressure && setup_.model.band.needs_normal_load();
  }
  void update_flow_depth();
  // Updates the load on particles at memory index `first` and above: weight of the column above, normal to the ground.
  void update_normal_load(std::size_t first = 0);
  [[nodiscard]] terrain::SlideOnGround<Dim> slide_on_ground() {
    const Model<Dim>& model = setup_.model;
    return {slide_.grid,
            model.ground ? &slide_.ground : nullptr,
            model.constraints,
            model.motion,
            model.contact,
            slide_.particles,
            nodes_};
  }

  const Setup<Dim>& setup_;
  Slide<Dim>& slide_;
  Base<Dim>& base_;
  const Clock& clock_;
  Stopwatch& stopwatch_;
  StepSums<Dim> sums_;         // of the step
  double force_of_walls_ = 0;  // of a section, along x [N]
  mpm::Nodes<Dim> nodes_;
  band::FlowDepth<Dim> flow_depth_;
  exec::Cpu cpu_;
  mpm::BodyContact<exec::Cpu, Dim> body_contact_{cpu_};
  mpm::TableMemory tables_;
  terrain::ContactOnCpu<Dim> contact_;
  mutable band::MapStage<exec::Cpu> maps_{cpu_, setup_.cell()};
  mutable std::vector<std::uint64_t> tiles_of_maps_;                           // their keys
  mpm::BodySizes half_sizes_{setup_.model.motion.sizes.times(setup_.cell())};  // of particles [m]
  std::optional<ContactOfBodies> between_bodies_;                              // of the step
  std::vector<std::uint64_t> blocks_of_nodes_;
  double band_thickness_ = -1.0;  // of the last scaling [m]
  double rescaling_heat_ = 0;     // added since the last complete step [J]
};

}  // namespace thawslide::sim
