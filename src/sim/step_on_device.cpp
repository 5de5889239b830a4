// Steps on a device (src/device), and synchronization of its particles.
#include <algorithm>

#include "band/basal_segments.hpp"
#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "device/solver.hpp"
#include "sim/bed_of_device.hpp"
#include "sim/device_model.hpp"
#include "sim/grid_of_device.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
void Simulation<Dim>::use_device(const std::string& device, device::SolverFactory<Dim> make) {
  const std::string missing = not_on_devices(model_);
  if (!missing.empty()) {
    throw UserError(fmt::format("{}: {} is not supported on {}. Run the case on the CPU: --device cpu",
                                parameters_.name, missing, device));
  }
  release_device();
  device_name_ = device;
  make_solver_ = std::move(make);
  device_sums_ = std::make_unique<device::StepSums<Dim>>();
  map_sample_ = std::make_unique<device::MapSample>();
}

// Runs work on the device. If the device fails, the host keeps the particles of the last synchronization, or a mixture
// if it fails during one.
template <int Dim>
void Simulation<Dim>::on_device(const std::function<void()>& work) const {
  try {
    work();
  } catch (const device::Failure& error) {
    host_particles_valid_ = host_grid_valid_ = device_has_failed_ = true;
    device_solver_.reset();
    throw DeviceError(fmt::format("{} failed at step {}: {}", device_name_, step_number_, error.what()));
  }
}

template <int Dim>
void Simulation<Dim>::start_on_device() {
  if (!make_solver_ || device_solver_) {
    return;
  }
  on_device([&] {
    device::HostCallbacks<Dim> callbacks = terrain_for_device(model_, parameters_.grid.cell);
    callbacks.columns = host_columns();
    callbacks.bed = host_bed();
    device_solver_ = make_solver_(device_model_of(parameters_, model_, step_number_ == 0), mpm::view_of(particles_),
                                  particles_.size(), std::move(callbacks));
    device_sums_->extremes = device_solver_->extremes();
  });
}

template <int Dim>
device::StepSums<Dim> Simulation<Dim>::step_on_device() {
  if (sorting_interval_ > 0 && step_number_ % sorting_interval_ == 0) {
    device_solver_->sort_in_memory();
  }
  host_particles_valid_ = host_grid_valid_ = false;
  return device_solver_->step(static_cast<Real>(time_), dt_);
}

template <int Dim>
void Simulation<Dim>::advance_on_device() {
  start_on_device();
  on_device([&] { *device_sums_ = step_on_device(); });
  const device::StepSums<Dim>& sums = *device_sums_;
  if (parameters_.mechanics.enabled) {
    contact_ = sums.contact;
    add_contact_energy();
    add_bed_energy();
  }
  budget_.numerical += sums.particle_kinetic - contact_.node_kinetic;
  budget_.numerical += sums.filtered;
  budget_.numerical += sums.mapped_back;
  add_stress_work(sums.deformed.work);
  budget_.band_rescale += model_.band.heat ? sums.band_rescale : Real(0);
  if (band_columns_) {  // the body's temperature is constant
    budget_.friction_heat += contact_.friction_work - contact_.converted;
  } else {
    add_heat_gain(sums.heat);
  }
  budget_.drained_water += sums.drained.mass;
  budget_.drained_heat += sums.drained.heat;
  budget_.vented_water += sums.vented;
  invalid_ += sums.deformed.invalid;
  invalid_ += sums.invalid;
}

template <int Dim>
bool Simulation<Dim>::needs_no_host_check() const {
  if (!device_solver_ || invalid_.id >= 0) {
    return false;
  }
  std::vector<Vector<Real, Dim>> escapes;
  if (device_sums_->escapes > 0) {
    on_device([&] { escapes = device_solver_->escaped_positions(); });
  }
  return !any_has_left(escapes);
}

template <int Dim>
bool Simulation<Dim>::any_has_left(const std::vector<Vector<Real, Dim>>& positions) const {
  const Vector<Real, Dim>& extent = model_.constraints.extent;
  const auto left = [&](const Vector<Real, Dim>& position) {
    return (position.array() < Real(0)).any() || (position.array() > extent.array()).any() ||
           (model_.ground && !model_.ground->is_known(position.template head<Dim - 1>().template cast<double>()));
  };
  constexpr std::size_t of_a_task = 1024;
  return parallel_sum<std::size_t>(
             (positions.size() + of_a_task - 1) / of_a_task, [&](std::size_t task, std::size_t& sum) {
               for (std::size_t k = task * of_a_task; k < std::min(positions.size(), (task + 1) * of_a_task); ++k) {
                 sum += left(positions[k]) ? 1 : 0;
               }
             }) > 0;
}

template <int Dim>
void Simulation<Dim>::copy_particles_back() const {
  if (!host_particles_valid_) {
    on_device([&] { device_solver_->copy_to(mpm::view_of(particles_)); });
    host_particles_valid_ = true;
  }
}

// Rebuilds the grid from the particles' positions: sums in its order then do not depend on the time of synchronization.
template <int Dim>
void Simulation<Dim>::sync_to_host() const {
  copy_particles_back();
  if (!host_grid_valid_) {
    grid_.update(particles_, 0);
    update_ground();
    host_grid_valid_ = true;
  }
}

template <int Dim>
const device::MapSample* Simulation<Dim>::sample_map(const mpm::MapCells& cells) const {
  if (!device_solver_) {
    return nullptr;
  }
  on_device([&] { device_solver_->sample_map(cells, *map_sample_); });
  return map_sample_.get();
}

template <int Dim>
void Simulation<Dim>::release_device() {
  sync_to_host();
  device_solver_.reset();
  grid_of_device_.reset();
  bed_of_device_.reset();
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                           \
  template void Simulation<Dim>::use_device(const std::string&, device::SolverFactory<Dim>); \
  template void Simulation<Dim>::on_device(const std::function<void()>&) const;              \
  template void Simulation<Dim>::start_on_device();                                          \
  template device::StepSums<Dim> Simulation<Dim>::step_on_device();                          \
  template void Simulation<Dim>::advance_on_device();                                        \
  template bool Simulation<Dim>::needs_no_host_check() const;                                \
  template bool Simulation<Dim>::any_has_left(const std::vector<Vector<Real, Dim>>&) const;  \
  template void Simulation<Dim>::copy_particles_back() const;                                \
  template void Simulation<Dim>::sync_to_host() const;                                       \
  template const device::MapSample* Simulation<Dim>::sample_map(const mpm::MapCells&) const; \
  template void Simulation<Dim>::release_device();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
