#include "sim/solver/device_solver.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "device/solver.hpp"
#include "sim/solver/step_model.hpp"

namespace thawslide::sim {

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

}  // namespace

template <int Dim>
struct DeviceSolver<Dim>::Session {
  std::unique_ptr<device::Solver<Dim>> solver;  // null while the next step begins with the particles of the host
  StepSums<Dim> sums;                           // of the last step
  device::MapSample map_sample;                 // of the last step
  double time = 0;                              // at the beginning of the step [s]
  MomentumOfNodes nodes;                        // as last fetched
  bool has_stepped = false;                     // since the solver was created
  bool host_particles_valid = true, host_grid_valid = true, host_columns_valid = true, has_failed = false;
};

template <int Dim>
DeviceSolver<Dim>::DeviceSolver(const Setup<Dim>& setup, Slide<Dim>& slide, Base<Dim>& base, const Clock& clock,
                                Stopwatch& stopwatch, const Solver<Dim>& host, std::string name,
                                device::SolverFactory<Dim> make)
    : setup_(setup),
      slide_(slide),
      base_(base),
      clock_(clock),
      stopwatch_(stopwatch),
      host_(host),
      name_(std::move(name)),
      make_(std::move(make)),
      session_(std::make_unique<Session>()) {}

template <int Dim>
DeviceSolver<Dim>::~DeviceSolver() = default;

template <int Dim>
bool DeviceSolver<Dim>::has_failed() const {
  return session_->has_failed;
}

template <int Dim>
void DeviceSolver<Dim>::call(const std::function<void()>& work) const {
  try {
    work();
  } catch (const device::Failure& error) {
    Session& session = *session_;
    session.host_particles_valid = session.host_grid_valid = session.host_columns_valid = session.has_failed = true;
    session.solver.reset();
    throw DeviceError(fmt::format("{} failed at step {}: {}", name_, clock_.step_number, error.what()));
  }
}

template <int Dim>
void DeviceSolver<Dim>::start() {
  if (session_->solver) {
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
    session_->solver = make_(model, mpm::view_of(slide_.particles), slide_.particles.size(), std::move(callbacks));
    session_->sums.extremes = session_->solver->extremes();
  });
}

template <int Dim>
StepSums<Dim> DeviceSolver<Dim>::step(double dt, const terrain::StrengthLaw* strength) {
  THAWSLIDE_ASSERT(!has_failed(), "a step after {} has failed", name_);
  start();
  Session& session = *session_;
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

template <int Dim>
bool DeviceSolver<Dim>::none_has_left() const {
  if (!session_->solver) {
    return false;
  }
  std::vector<Vector<double, Dim>> escapes;
  if (session_->sums.escapes > 0) {
    call([&] { escapes = session_->solver->escaped_positions(); });
  }
  return !any_has_left(setup_.model, escapes);
}

template <int Dim>
band::StepExtremes DeviceSolver<Dim>::extremes() const {
  if (session_->solver && setup_.is_adaptive()) {
    return session_->sums.extremes;
  }
  copy_particles_back();
  return host_.extremes();
}

template <int Dim>
AnySums<Dim> DeviceSolver<Dim>::reduce(const AnyReduction<Dim>& reduction) const {
  if (!session_->solver) {
    return host_.reduce(reduction);
  }
  AnySums<Dim> sums;
  call([&] { sums = session_->solver->reduce(reduction); });
  return sums;
}

template <int Dim>
mpm::PathSample DeviceSolver<Dim>::front(const mpm::Transformation<Dim>& path, double mass) const {
  if (!session_->solver) {
    return host_.front(path, mass);
  }
  mpm::PathSample found;
  call([&] { found = session_->solver->front(path, mass); });
  return found;
}

template <int Dim>
const device::MapSample* DeviceSolver<Dim>::sample_map(const mpm::MapCells& cells) const {
  if (!session_->solver) {
    return nullptr;
  }
  call([&] { session_->solver->sample_map(cells, session_->map_sample); });
  return &session_->map_sample;
}

template <int Dim>
MomentumOfNodes DeviceSolver<Dim>::momentum_of_nodes() const {
  fetch_nodes();
  return session_->nodes;
}

template <int Dim>
void DeviceSolver<Dim>::fetch_nodes() const {
  if (session_->solver && setup_.parameters.mechanics.enabled && session_->has_stepped) {
    MomentumOfNodes& nodes = session_->nodes;
    call([&] { session_->solver->copy_momentum_to(nodes.blocks, nodes.records); });
  }
}

template <int Dim>
void DeviceSolver<Dim>::copy_particles_back() const {
  if (!session_->host_particles_valid) {
    call([&] { session_->solver->copy_to(mpm::view_of(slide_.particles)); });
    session_->host_particles_valid = true;
  }
}

template <int Dim>
void DeviceSolver<Dim>::copy_columns_back() const {
  if (base_.columns && !session_->host_columns_valid) {
    call([&] { base_.columns->set(session_->solver->segments()); });
  }
  session_->host_columns_valid = true;
}

// Rebuilds the grid from the particles' positions and the layers of the last step: sums in its order then do not depend
// on the time of synchronization.
template <int Dim>
void DeviceSolver<Dim>::sync_to_host() const {
  copy_particles_back();
  if (!session_->host_grid_valid) {
    slide_.set_layers(setup_.model, session_->time);
    slide_.update_grid(setup_.model, 0);
    session_->host_grid_valid = true;
  }
}

template <int Dim>
void DeviceSolver<Dim>::release() {
  sync_to_host();
  copy_columns_back();
  fetch_nodes();
  session_->solver.reset();
  session_->has_stepped = false;
}

#define THAWSLIDE_INSTANTIATE(Dim) template class DeviceSolver<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
