#include "sim/solver/device_solver.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "device/solver.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/setup/terrain_at_columns.hpp"

namespace thawslide::sim {

template <int Dim>
device::StepModel<Dim> step_model_of(const config::Case& parameters, const Model<Dim>& model, const Clock& clock) {
  device::StepModel<Dim> device;
  device.cell = parameters.grid.cell;
  device.mapping = mapping_of(model);
  if (model.ground) {
    device.columns = model.ground->columns();
  }
  for (std::size_t body = 0; body < model.body_names.size(); ++body) {
    device.half_sizes.push_back(model.motion.sizes.half(body));
  }
  device.motion = model.motion;
  device.moves = parameters.mechanics.enabled;
  device.filters_in_step = [parameters](double time, double dt) { return filters_in_step(parameters, time, dt); };
  device.free_gaps = model.free_gaps;
  device.extent = model.constraints.extent;
  device.conditions = model.constraints.conditions;
  device.width = model.motion.width;
  device.between_bodies = model.between_bodies;
  if (model.between_bodies.any()) {
    device.layers_of_bodies = [&model](double time) { return layers_of_bodies(model, time); };
  }
  // Particles that will be removed may leave the domain before the end of the step.
  const double margin = parameters.grid.leaving == config::Policy::remove ? device.cell : 0.0;
  const Vector<double, Dim> beyond = Vector<double, Dim>::Constant(margin);
  device.lower = -beyond;
  device.upper = model.constraints.extent + beyond;
  device.finds_extremes = parameters.time.stepping == config::Stepping::adaptive;
  device.counts_escaped =
      parameters.grid.leaving == config::Policy::remove || parameters.terrain.kind == config::TerrainKind::dem;
  device.contact = model.contact;
  const bool has_columns = model.contact.band_columns;  // columns carry all heat and pore pressure of the base
  device.band = model.band;
  device.band.pressure = model.band.pressure && !has_columns;
  device.band.heat = model.band.heat && !has_columns;
  device.starts = clock.step_number == 0;
  device.time = clock.time;
  device.band_thickness = [thickness = parameters.band.thickness](double time) { return thickness.at(time); };
  return device;
}

template <int Dim>
device::HostCallbacks<Dim> host_callbacks_of(const Model<Dim>& model, double cell) {
  device::HostCallbacks<Dim> callbacks;
  if (model.ground) {
    callbacks.ground = [&model, cell](std::uint64_t block, terrain::GroundAtNode<Dim>* nodes) {
      terrain::query_ground<Dim>(*model.ground, model.substrates.get(), block, cell, nodes);
      return terrain::is_ground_known<Dim>(*model.ground, block, cell);
    };
    callbacks.column_heights = [&model] { return model.ground->column_heights(); };
  }
  if (model.band.normal_thickness) {
    callbacks.slope_cosine = slope_cosine_of(model, cell);
  }
  callbacks.normal_gravity = normal_gravity_of(model, cell);
  if (model.band.width.varies()) {
    callbacks.width = [&model](const auto& position) { return model.band.width.at(position[0]); };
  }
  return callbacks;
}

namespace {

// True if a position is outside the domain or the known terrain.
template <int Dim>
bool any_has_left(const Model<Dim>& model, const std::vector<Vector<double, Dim>>& positions) {
  const Vector<double, Dim>& extent = model.constraints.extent;
  const auto left = [&](const Vector<double, Dim>& position) {
    return (position.array() < 0.0).any() || (position.array() > extent.array()).any() ||
           (model.ground && !model.ground->is_known(position.template head<Dim - 1>()));
  };
  return parallel_any(positions.size(), [&](std::size_t k) { return left(positions[k]); });
}

// Solver of one of device::SolverFactory, with the copy of the slide in host memory.
template <int Dim>
class DeviceSolver final : public Solver<Dim> {
 public:
  DeviceSolver(const Setup<Dim>& setup, Slide<Dim>& slide, Base<Dim>& base, const Clock& clock, Stopwatch& stopwatch,
               const Solver<Dim>& host, std::string name, device::SolverFactory<Dim> make)
      : setup_(setup),
        slide_(slide),
        base_(base),
        clock_(clock),
        stopwatch_(stopwatch),
        host_(host),
        name_(std::move(name)),
        make_(std::move(make)) {}

  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] bool has_failed() const override { return session_.has_failed; }

  void start() override {
    if (session_.solver) {
      return;
    }
    call([&] {
      device::HostCallbacks<Dim> callbacks = host_callbacks_of(setup_.model, setup_.cell());
      callbacks.bed = base_.bed_in_reach(setup_.model);
      device::StepModel<Dim> model = step_model_of(setup_.parameters, setup_.model, clock_);
      if (base_.columns) {
        model.band_columns = base_.columns->model();
        model.segments = base_.columns->state();
      }
      session_.solver = make_(model, mpm::view_of(slide_.particles), slide_.particles.size(), std::move(callbacks));
      session_.sums.extremes = session_.solver->extremes();
    });
  }

  StepSums<Dim> step(double dt, const terrain::StrengthLaw* strength) override {
    THAWSLIDE_ASSERT(!has_failed(), "a step after {} has failed", name_);
    start();
    Session& session = session_;
    session.time = clock_.time;
    stopwatch_.time("step_on_device", [&] {
      call([&] {
        if (slide_.sorting_interval > 0 && clock_.step_number % slide_.sorting_interval == 0) {
          session.solver->sort_in_memory();
        }
        session.host_particles_valid = session.host_grid_valid = session.host_columns_valid = false;
        session.has_stepped = true;
        session.sums = session.solver->step(clock_.time, dt, strength);
      });
    });
    return session.sums;
  }

  [[nodiscard]] bool none_has_left() const override {
    if (!session_.solver) {
      return false;
    }
    std::vector<Vector<double, Dim>> escapes;
    if (session_.sums.escapes > 0) {
      call([&] { escapes = session_.solver->escaped_positions(); });
    }
    return !any_has_left(setup_.model, escapes);
  }

  [[nodiscard]] AnySums<Dim> reduce(const AnyReduction<Dim>& reduction) const override {
    if (!session_.solver) {
      return host_.reduce(reduction);
    }
    AnySums<Dim> sums;
    call([&] { sums = session_.solver->reduce(reduction); });
    return sums;
  }

  [[nodiscard]] band::StepExtremes extremes() const override {
    if (session_.solver && setup_.is_adaptive()) {
      return session_.sums.extremes;
    }
    copy_particles_back();
    return host_.extremes();
  }

  [[nodiscard]] mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) const override {
    if (!session_.solver) {
      return host_.front(path, mass);
    }
    mpm::PathSample found;
    call([&] { found = session_.solver->front(path, mass); });
    return found;
  }

  [[nodiscard]] band::BaseTotals base_totals() const override {
    if (!session_.solver) {
      return host_.base_totals();
    }
    band::BaseTotals totals;
    call([&] { totals = session_.solver->base_totals(); });
    return totals;
  }

  [[nodiscard]] const band::MapSample* sample_map(const mpm::MapCells& cells) const override {
    if (!session_.solver) {
      return host_.sample_map(cells);
    }
    const band::MapSample* sample = nullptr;
    call([&] { sample = session_.solver->sample_map(cells); });
    return sample;
  }

  [[nodiscard]] MomentumOfNodes momentum_of_nodes() const override {
    fetch_nodes();
    return session_.nodes;
  }

  void copy_particles_back() const override {
    if (!session_.host_particles_valid) {
      call([&] { session_.solver->copy_to(mpm::view_of(slide_.particles)); });
      session_.host_particles_valid = true;
    }
  }

  void copy_columns_back() const override {
    if (base_.columns && !session_.host_columns_valid) {
      call([&] { base_.columns->set(session_.solver->segments()); });
    }
    session_.host_columns_valid = true;
  }

  void sync_to_host() const override {
    copy_particles_back();
    if (!session_.host_grid_valid) {
      slide_.set_layers(setup_.model, session_.time);
      slide_.update_grid(setup_.model, 0);
      session_.host_grid_valid = true;
    }
  }

  void release() override {
    sync_to_host();
    copy_columns_back();
    fetch_nodes();
    session_.solver.reset();
    session_.has_stepped = false;
  }

 private:
  // Solver on the device and its last results.
  struct Session {
    std::unique_ptr<device::Solver<Dim>> solver;  // null while the next step begins with the particles of the host
    StepSums<Dim> sums;                           // of the last step
    double time = 0;                              // at the beginning of the step [s]
    MomentumOfNodes nodes;                        // as last fetched
    bool has_stepped = false;                     // since the solver was created
    bool host_particles_valid = true, host_grid_valid = true, host_columns_valid = true, has_failed = false;
  };

  // Runs work on the device. If the device fails, the host keeps the particles of the last synchronization, or a
  // mixture if it fails during one. Throws DeviceError then.
  void call(const std::function<void()>& work) const {
    try {
      work();
    } catch (const device::Failure& error) {
      Session& session = session_;
      session.host_particles_valid = session.host_grid_valid = session.host_columns_valid = session.has_failed = true;
      session.solver.reset();
      throw DeviceError(fmt::format("{} failed at step {}: {}", name_, clock_.step_number, error.what()));
    }
  }

  // Copies the momentum of the nodes of the last step, if the device has it.
  void fetch_nodes() const {
    if (session_.solver && setup_.parameters.mechanics.enabled && session_.has_stepped) {
      MomentumOfNodes& nodes = session_.nodes;
      call([&] { session_.solver->copy_momentum_to(nodes.blocks, nodes.records); });
    }
  }

  const Setup<Dim>& setup_;
  Slide<Dim>& slide_;
  Base<Dim>& base_;
  const Clock& clock_;
  Stopwatch& stopwatch_;
  const Solver<Dim>& host_;
  std::string name_;
  device::SolverFactory<Dim> make_;
  mutable Session session_;
};

}  // namespace

template <int Dim>
std::unique_ptr<Solver<Dim>> make_device_solver(const Setup<Dim>& setup, Slide<Dim>& slide, Base<Dim>& base,
                                                const Clock& clock, Stopwatch& stopwatch, const Solver<Dim>& host,
                                                std::string name, device::SolverFactory<Dim> make) {
  return std::make_unique<DeviceSolver<Dim>>(setup, slide, base, clock, stopwatch, host, std::move(name),
                                             std::move(make));
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                   \
  template device::StepModel<Dim> step_model_of<Dim>(const config::Case&, const Model<Dim>&, const Clock&);          \
  template device::HostCallbacks<Dim> host_callbacks_of<Dim>(const Model<Dim>&, double);                             \
  template std::unique_ptr<Solver<Dim>> make_device_solver(const Setup<Dim>&, Slide<Dim>&, Base<Dim>&, const Clock&, \
                                                           Stopwatch&, const Solver<Dim>&, std::string,              \
                                                           device::SolverFactory<Dim>);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
