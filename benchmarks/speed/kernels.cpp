// Single functions of the step, by Google Benchmark: speed --kernels.
#include <benchmark/benchmark.h>

#include <array>
#include <random>

#include "mpm/shape.hpp"
#include "physics/heat_content.hpp"
#include "physics/kinematics.hpp"
#include "physics/mohr_coulomb.hpp"

namespace thawslide::speed {
namespace {

using Tensor = SymmetricTensor<double>;
constexpr std::size_t states = 256;

// Random stresses [Pa] about a compression, in the plane or not.
std::array<Tensor, states> stresses(double shear, bool plane) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::array<Tensor, states> all;
  for (Tensor& s : all) {
    for (int c = 0; c < 6; ++c) {
      s[c] = (c < 3 ? -5e6 : 0.0) + shear * unit(random);
    }
    if (plane) {
      s[4] = s[5] = 0.0;
    }
  }
  return all;
}

void mohr_coulomb(benchmark::State& state, double shear, bool plane) {
  const auto elastic = physics::Elastic<double>::from_young_poisson(5e8, 0.2);
  const auto law = physics::MohrCoulomb<double>::make(elastic, 35.0, 0.0, 1e5, 1e5, HUGE_VAL);
  const auto all = stresses(shear, plane);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(law.update(all[k++ % states], 0.0));
  }
}
BENCHMARK_CAPTURE(mohr_coulomb, plane_elastic, 5e5, true);
BENCHMARK_CAPTURE(mohr_coulomb, plane_yielding, 2e7, true);
BENCHMARK_CAPTURE(mohr_coulomb, space_elastic, 5e5, false);
BENCHMARK_CAPTURE(mohr_coulomb, space_yielding, 2e7, false);

template <int Dim>
void strain_and_rotation(benchmark::State& state) {
  Matrix<double, Dim> gradient = Matrix<double, Dim>::Random() * 1e-3;
  const auto all = stresses(1e6, Dim == 2);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(gradient);
    const auto increment = physics::strain_increment<double, Dim>(gradient);
    benchmark::DoNotOptimize(physics::rotate<double, Dim>(all[k++ % states], increment.rotation));
    benchmark::DoNotOptimize(increment.strain);
  }
}
BENCHMARK_TEMPLATE(strain_and_rotation, 2);
BENCHMARK_TEMPLATE(strain_and_rotation, 3);

void heat_content_and_back(benchmark::State& state) {
  const physics::HeatContent<double, physics::PowerLawCurve<double>> content{{}, {0.0, 5.0}, true};
  double temperature = -1.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(temperature);
    const double heat = content.content(temperature, 0.375);
    benchmark::DoNotOptimize(content.temperature(heat, 0.375, temperature - 1e-3));
  }
}
BENCHMARK(heat_content_and_back);

void ugimp_axis(benchmark::State& state) {
  double offset = 0.1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(offset);
    benchmark::DoNotOptimize(mpm::ugimp_weights(offset, 0.25, 1.0));
  }
}
BENCHMARK(ugimp_axis);

}  // namespace
}  // namespace thawslide::speed
