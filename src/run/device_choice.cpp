#include "run/device_choice.hpp"

#include "base/error.hpp"
#ifdef THAWSLIDE_WITH_GPU
#include "device/gpu.hpp"
#endif

namespace thawslide::run {

namespace {

#ifdef THAWSLIDE_WITH_GPU
template <int Dim>
std::string step_on_gpu(sim::Simulation<Dim>& simulation) {
  const device::Gpu gpu = device::find_gpu();
  if (!gpu.is_usable) {
    throw UserError(fmt::format("--device gpu: {}. Run the case on the CPU: --device cpu", gpu.unavailable_reason));
  }
  simulation.use_device(gpu.name, device::on_gpu<Dim>());
  return gpu.name;
}
#else
template <int Dim>
std::string step_on_gpu(sim::Simulation<Dim>& /*simulation*/) {
  throw UserError(
      "--device gpu: this program was built without CUDA. Install CUDA 12 or later and build again (./run --setup), or "
      "run the case on the CPU: --device cpu");
}
#endif

}  // namespace

GpuFacts detect_gpu() {
#ifdef THAWSLIDE_WITH_GPU
  const device::Gpu gpu = device::find_gpu();
  return {gpu.name, gpu.unavailable_reason, gpu.free, 0.0, 0.0};
#else
  return {"", "this program was built without CUDA", 0.0, 0.0, 0.0};
#endif
}

template <int Dim>
std::string use_device(const std::string& device, sim::Simulation<Dim>& simulation) {
  if (device == "cpu") {
    return "";
  }
  try {
    return step_on_gpu<Dim>(simulation);
  } catch (const UserError&) {
    if (device == "auto") {
      return "";
    }
    throw;
  }
}

template std::string use_device<2>(const std::string&, sim::Simulation<2>&);
template std::string use_device<3>(const std::string&, sim::Simulation<3>&);

}  // namespace thawslide::run
