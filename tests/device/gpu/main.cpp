// thawslide_device_test: compares steps on a GPU with those on the CPU, and measures the speed of the GPU.
// tests/device/README.md has its options and exit codes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "band/map_stage.hpp"
#include "device/gpu.hpp"
#include "measure.hpp"
#include "sim/maps/path_line.hpp"

namespace thawslide::gpu_test {
namespace {

constexpr int no_gpu = 5;
constexpr double tolerance = 1e-12;
constexpr Size in_plane{20, 1, 8}, in_space{8, 5, 4};

struct Comparison {
  std::size_t fields = 0, fields_of_same_bits = 0;
  double largest = 0;  // maximum difference, relative to the field's maximum
};

template <int Dim>
Comparison compare(const ParticleMemory<Dim>& a, const ParticleMemory<Dim>& b) {
  // Places in memory may differ, so particles are matched by id.
  std::vector<std::size_t> by_id_a(a.size()), by_id_b(a.size());
  const auto list = [](const ParticleMemory<Dim>& of, std::vector<std::size_t>& by_id) {
    for (std::size_t k = 0; k < by_id.size(); ++k) {
      by_id[static_cast<std::size_t>(of.view().id(k) / 3)] = k;
    }
  };
  list(a, by_id_a);
  list(b, by_id_b);
  Comparison all;
  mpm::for_fields_of(a.view(), b.view(),
                     [&]<class T, int Components>(const mpm::FieldView<T, Components>& of_a,
                                                  const mpm::FieldView<T, Components>& of_b) {
                       bool same = true;
                       double scale = 0, difference = 0;
                       for (std::size_t k = 0; k < a.size(); ++k) {
                         for (int c = 0; c < Components; ++c) {
                           const T x = of_a(by_id_a[k], c), y = of_b(by_id_b[k], c);
                           same = same && std::memcmp(&x, &y, sizeof x) == 0;
                           scale = std::max(scale, std::abs(static_cast<double>(x)));
                           const double apart = std::abs(static_cast<double>(x) - static_cast<double>(y));
                           difference = apart <= difference ? difference : apart;  // NaN counts as the maximum
                         }
                       }
                       ++all.fields;
                       all.fields_of_same_bits += same ? 1 : 0;
                       const double fraction = difference == 0 ? 0 : difference / scale;
                       all.largest = fraction <= all.largest ? all.largest : fraction;
                     });
  return all;
}

// Returns the sums of the last step.
template <int Dim>
device::StepSums<Dim> take_steps(Steps<Dim>& steps, int from, int to) {
  device::StepSums<Dim> sums;
  for (int k = from; k < to; ++k) {
    sums = steps.step(k * time_step, time_step, nullptr);
  }
  return sums;
}

bool report_line(const char* what, const Comparison& found, bool bits_are_asked_for) {
  const bool is_well = bits_are_asked_for ? found.fields_of_same_bits == found.fields : found.largest <= tolerance;
  std::printf("%-60s %zu of %zu fields have the same bits, largest difference %.3g: %s\n", what,
              found.fields_of_same_bits, found.fields, found.largest, is_well ? "well" : "beyond what is allowed");
  return is_well;
}

// True if all processes to be tested act on the slide.
template <int Dim>
bool print_work(const device::StepSums<Dim>& sums) {
  const bool works = sums.contact.friction_work > 0 && sums.deformed.work.plastic > 0 && sums.heat.friction > 0 &&
                     sums.water.drained.mass > 0 && sums.water.drained.heat > 0 && sums.water.absorbed != 0;
  std::printf(
      "%s: friction work %.4g J, plastic work %.4g J, friction heat %.4g J, water drained %.4g kg and vented %.4g kg "
      "in the last step: %s\n",
      Dim == 2 ? "2D" : "3D", sums.contact.friction_work, sums.deformed.work.plastic, sums.heat.friction,
      sums.water.drained.mass, sums.water.vented(phases()), works ? "well" : "WRONG");
  return works;
}

// More segments than one kernel launch processes.
sim::PathLine bent_line() {
  sim::PathLine line;
  for (int k = 0; k < 40; ++k) {
    line.add({16.0 + 0.7 * k, 8.0 * std::sin(0.2 * k)});
  }
  return line;
}

// Non-integer results that a run reduces from its particles after a step.
template <int Dim>
std::vector<double> looks(Steps<Dim>& steps, const device::StepSums<Dim>& sums) {
  mpm::MonitorKernel<Dim> kernel;
  kernel.gravity = model_of_slide<Dim>().motion.gravity;
  kernel.origin.setZero();
  kernel.fast_distance = 6.0 * time_step;
  kernel.smallest_volume = 0.1;
  kernel.largest_volume = 10.0;
  const auto seen = std::get<mpm::MonitorSums>(steps.reduce(kernel));
  const band::StepExtremes& extremes = sums.extremes;
  std::vector<double> numbers{extremes.density.value,
                              extremes.elastic_density.value,
                              extremes.speed.value,
                              extremes.diffusivity.value,
                              extremes.seepage.value,
                              extremes.pore_stiffness,
                              static_cast<double>(sums.escapes),
                              seen.kinetic,
                              seen.potential,
                              seen.mass,
                              seen.fast_mass};
  const auto body = std::get<band::BodySums<Dim>>(steps.reduce(sums_of_particle<Dim>()));
  numbers.insert(numbers.end(), {body.mass, body.kinetic, body.sensible, body.latent, body.water, body.gas,
                                 body.momentum[0], body.displacement, body.band_temperature});
  const sim::PathLine line = bent_line();
  for (const LineView& path : {LineView{}, line.view()}) {
    const mpm::PathSample front = steps.front({path, {5.0, 7.0}}, body.mass);
    numbers.insert(numbers.end(), {front.along, front.mass, front.position[0], front.position[1]});
  }
  std::vector<std::array<double, 2>> escapes;  // their order is that of device memory
  for (const Vector<double, Dim>& place : steps.escaped_positions()) {
    escapes.push_back({place[0], place[Dim - 1]});
  }
  std::sort(escapes.begin(), escapes.end());
  for (const auto& [along, height] : escapes) {
    numbers.insert(numbers.end(), {along, height});
  }
  const band::MapSample* map = steps.sample_map({-0.3, -0.2, 1.4, 0.7, 1.0 / 1.4, 1.0 / 0.7, 100, 100, 0.25 * cell});
  const auto moments = std::get<mpm::MassMoments>(steps.reduce(mpm::MomentsOfParticle{}));
  numbers.insert(numbers.end(), {moments.mass, moments.mass_x, moments.mass_y});
  for (const mpm::MapSums& of_cell : map != nullptr ? map->sums : std::vector<mpm::MapSums>()) {
    numbers.insert(numbers.end(), {of_cell.column.volume, of_cell.column.mass, of_cell.column.momentum_x,
                                   of_cell.column.water, of_cell.band.volume, of_cell.band.volume_temperature});
  }
  return numbers;
}
bool print_numbers(const std::string& what, const std::vector<double>& of_cpu, const std::vector<double>& of_gpu) {
  std::size_t same = 0;
  bool well = of_gpu.size() == of_cpu.size();
  for (std::size_t k = 0; well && k < of_gpu.size(); ++k) {
    same += std::memcmp(&of_gpu[k], &of_cpu[k], sizeof of_gpu[k]) == 0 ? 1 : 0;
    well = std::abs(of_gpu[k] - of_cpu[k]) <= tolerance * std::max(1.0, std::abs(of_cpu[k]));
  }
  std::printf("%-60s %zu of %zu numbers have the same bits: %s\n", what.c_str(), same, of_cpu.size(),
              well ? "well" : "beyond what is allowed");
  return well;
}

template <int Dim>
bool compare_slides(const device::SolverFactory<Dim>& make, const device::SolverFactory<Dim>& make_again,
                    const Size& size) {
  ParticleMemory<Dim> start(size.particles(Dim));
  seed(size, start);
  bool well = true;
  const std::string dim = Dim == 2 ? "2D, " : "3D, ";
  const auto processor = steps_of(device::emulated<Dim>(), start);
  const auto gpu = steps_of(make, start), again = steps_of(make_again, start);
  ParticleMemory<Dim> of_cpu(start.size()), of_gpu(start.size()), of_second(start.size());
  int done = 0;
  for (const int steps : {1, 20, 60}) {
    const auto sums = take_steps(*processor, done, steps), of_this_gpu = take_steps(*gpu, done, steps);
    if (steps == 20) {
      again->sort_in_memory();  // must not change results
    }
    take_steps(*again, done, steps);
    done = steps;
    well = (steps < 60 || print_work(sums)) && well;
    processor->copy_to(of_cpu.view());
    gpu->copy_to(of_gpu.view());
    again->copy_to(of_second.view());
    const std::string when = dim + std::to_string(start.size()) + " particles, " + std::to_string(steps) + " steps, ";
    well =
        (steps > 1 || print_numbers(when + "looks at particles", looks(*processor, sums), looks(*gpu, of_this_gpu))) &&
        well;
    // Round-off grows from step to step, so the tolerance applies only after the first one.
    const Comparison found = compare(of_cpu, of_gpu);
    well = report_line((when + "GPU against CPU").c_str(), found, false) || steps > 1 ? well : false;
    well = report_line((when + "GPU against GPU").c_str(), compare(of_gpu, of_second), true) && well;
  }
  return well;
}

// Other model options: particles, reductions, bed and band columns must be bitwise identical on both.
template <int Dim>
bool compare_variant(const device::SolverFactory<Dim>& make, const Size& size, const NamedVariant& of) {
  ParticleMemory<Dim> start(size.particles(Dim)), of_cpu(start.size()), of_gpu(start.size());
  seed(size, start);
  seed_bodies(of.variant, size, start);
  const auto specified = std::make_shared<Reported>(), reported_by_gpu = std::make_shared<Reported>();
  const auto processor = steps_of(device::emulated<Dim>(), start, of.variant, specified);
  const auto gpu = steps_of(make, start, of.variant, reported_by_gpu);
  bool well = true;
  int done = 0;
  for (const int steps : {1, 12}) {
    const auto sums = take_steps(*processor, done, steps), of_this_gpu = take_steps(*gpu, done, steps);
    done = steps;
    processor->copy_to(of_cpu.view());
    gpu->copy_to(of_gpu.view());
    const std::string when =
        (Dim == 2 ? "2D, " : "3D, ") + std::string(of.name) + ", " + std::to_string(steps) + " steps, ";
    well = (report_line((when + "GPU against CPU").c_str(), compare(of_cpu, of_gpu), false) || steps > 1) && well;
    if (steps == 1) {
      well = print_numbers(when + "looks at particles", looks(*processor, sums), looks(*gpu, of_this_gpu)) && well;
      const std::vector<double> base = state_of_base<Dim>(of.variant, *specified, *processor);
      well = (base.empty() || print_numbers(when + "bed or band columns", base,
                                            state_of_base<Dim>(of.variant, *reported_by_gpu, *gpu))) &&
             well;
    }
  }
  return well;
}

double free_memory() { return device::find_gpu().free; }

void measure(std::size_t particles) {
  std::map<std::string, double> stages;
  const auto keep = [&](const std::string& stage, double seconds) { stages[stage] = seconds; };
  const Measured found = measured(device::on_gpu<3>(), particles, Variant::plain, 5.0, free_memory, keep);
  const Measured one_by_one =
      measured(device::on_gpu<3>(device::Launching::one_by_one), particles, Variant::plain, 5.0, free_memory);
  std::printf("3D, %zu particles, %.0f %% yielding: %.4g million particle-steps a second, %.4g ms a step\n",
              found.particles, 100 * found.yielding, static_cast<double>(found.particles) / found.seconds_a_step / 1e6,
              1e3 * found.seconds_a_step);
  std::printf("  %.4g ms a step where each kernel is launched by itself, not in graphs\n",
              1e3 * one_by_one.seconds_a_step);
  for (const auto& [stage, seconds] : stages) {
    std::printf("  %-28s %.4g ms\n", stage.c_str(), 1e3 * seconds);
  }
}

// make: replaces `on a GPU`; make_again: the same by another method, which must give bitwise identical results.
template <int Dim>
bool compare_all(const device::SolverFactory<Dim>& make, const device::SolverFactory<Dim>& make_again,
                 const Size& size) {
  bool well = compare_slides<Dim>(make, make_again, size);
  for (const NamedVariant& variant : variants) {
    well = (variant.variant == Variant::plain || compare_variant<Dim>(make, size, variant)) && well;
  }
  return well;
}

// Compares a run that launches its kernels as graphs with one that launches them individually.
bool compare_gpus() {
  constexpr auto one_by_one = device::Launching::one_by_one;
  const bool well = compare_all<2>(device::on_gpu<2>(), device::on_gpu<2>(one_by_one), in_plane);
  return compare_all<3>(device::on_gpu<3>(), device::on_gpu<3>(one_by_one), in_space) && well;
}

int run(const std::string& what, std::size_t particles) {
  if (what == "--rehearse") {
    constexpr auto order = device::ThreadOrder::shuffled;
    constexpr auto other = device::ThreadOrder::backward;
    const bool well_2d = compare_all<2>(device::emulated<2>(order), device::emulated<2>(other), in_plane);
    const bool well = compare_all<3>(device::emulated<3>(order), device::emulated<3>(other), in_space) && well_2d;
    print_table(device::emulated<3>(order), {2000}, 0.0, [] { return 0.0; });
    return well ? 0 : 1;
  }
  const device::Gpu gpu = device::find_gpu();
  if (!gpu.is_usable) {
    std::fprintf(stderr, "nothing was run: %s\n", gpu.unavailable_reason.c_str());
    return no_gpu;
  }
  std::printf("%s\n", gpu.name.c_str());
  if (what == "--table") {
    print_table(device::on_gpu<3>(),
                {100'000, 1'000'000, 10'000'000, 50'000'000, 100'000'000, 150'000'000, 200'000'000, 300'000'000}, 5.0,
                free_memory);
    return 0;
  }
  const bool well = what == "--speed" || compare_gpus();
  if (what.empty()) {
    measure(100'000);
    measure(10'000'000);
  } else if (what == "--speed") {
    measure(particles);
  }
  return well ? 0 : 1;
}

}  // namespace
}  // namespace thawslide::gpu_test

int main(int count, char** arguments) {
  const std::string what = count > 1 ? arguments[1] : "";
  const bool is_speed = what == "--speed" && count == 3;
  const long long particles = is_speed ? std::atoll(arguments[2]) : 0;
  const bool has_no_number = what == "--compare" || what == "--rehearse" || what == "--table";
  if (!(count == 1 || (has_no_number && count == 2) || (is_speed && particles > 0))) {
    std::fprintf(stderr, "usage: thawslide_device_test [--compare | --rehearse | --table | --speed PARTICLES]\n");
    return 2;
  }
  try {
    return thawslide::gpu_test::run(what, static_cast<std::size_t>(particles));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "the GPU failed: %s\n", error.what());
    return 1;
  }
}
