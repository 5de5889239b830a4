#include "run/device_choice.hpp"

#include "base/error.hpp"
#include "device/gpu.hpp"

namespace thawslide::run {

GpuFacts detect_gpu() {
  const device::Gpu gpu = device::find_gpu();
  return {gpu.name, gpu.unavailable_reason, gpu.free, 0.0, 0.0};
}

template <int Dim>
std::string use_device(const std::string& device, sim::Simulation<Dim>& simulation) {
  if (device == "cpu") {
    return "";
  }
  if (device != "gpu" && device != "auto") {
    throw UserError("device is '{}'; allowed: cpu, gpu, auto.", device);
  }
  const device::Gpu gpu = device::find_gpu();
  if (!gpu.is_usable && device == "auto") {
    return "";
  }
  if (!gpu.is_usable) {
    throw UserError("--device gpu: {}. Run the case on the CPU: --device cpu", gpu.unavailable_reason);
  }
  simulation.use_device(gpu.name, device::on_gpu<Dim>());
  return gpu.name;
}

template std::string use_device<2>(const std::string&, sim::Simulation<2>&);
template std::string use_device<3>(const std::string&, sim::Simulation<3>&);

}  // namespace thawslide::run
