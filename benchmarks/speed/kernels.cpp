// Single functions of the step, measured by Google Benchmark: speed --kernels. Formulas for one number and for lanes,
// as the step calls them; transfers for the batches of a body at random places. Items are particles.
#include "kernels.hpp"

#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <string>

#include "mpm/cell_sums.hpp"
#include "mpm/nodes.hpp"
#include "physics/heat_content.hpp"
#include "physics/kinematics.hpp"
#include "physics/mohr_coulomb.hpp"

namespace thawslide::speed {
namespace {

constexpr std::size_t states = 256;

template <class Value>
constexpr std::size_t particles_of = 1;
template <>
constexpr std::size_t particles_of<Simd<double>> = simd_width<double>;

template <class Value>
void count_particles(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(particles_of<Value>));
}

// A quantity of as many particles as Value contains, one number each.
template <class Value, class Number>
Value filled(const Number& number) {
  if constexpr (particles_of<Value> == 1) {
    return number();
  } else {
    return Value::of([&](std::size_t /*lane*/) { return number(); });
  }
}

// Random stresses [Pa] about a compression, in the plane or not.
template <class Value>
std::array<SymmetricTensor<Value>, states> stresses(double shear, bool plane) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::array<SymmetricTensor<Value>, states> all;
  for (auto& s : all) {
    for (int c = 0; c < 6; ++c) {
      const bool none = plane && c > 3;
      s[c] = filled<Value>([&] { return none ? 0.0 : (c < 3 ? -5e6 : 0.0) + shear * unit(random); });
    }
  }
  return all;
}

// shear: distance of stresses from the mean [Pa].
template <class Value, int Dim>
void mohr_coulomb(benchmark::State& state, double shear) {
  const auto elastic = physics::Elastic::from_young_poisson(5e8, 0.2);
  const auto law = physics::MohrCoulomb<>::make(elastic, physics::Strength{35.0, 0.0, 1e5, 1e5, HUGE_VAL});
  const auto all = stresses<Value>(shear, Dim == 2);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(law.template update<Dim>(all[k++ % states], Value(0.0)));
  }
  count_particles<Value>(state);
}

template <class Value, int Dim>
void strain_and_rotation(benchmark::State& state) {
  Matrix<Value, Dim> gradient;
  for (int k = 0; k < Dim * Dim; ++k) {
    gradient(k) = Value(1e-3 * (k + 1));
  }
  const auto all = stresses<Value>(1e6, Dim == 2);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(gradient);
    const auto increment = physics::strain_increment<Value, Dim>(gradient);
    benchmark::DoNotOptimize(physics::rotate<Value, Dim>(all[k++ % states], increment.rotation));
    benchmark::DoNotOptimize(increment.strain);
  }
  count_particles<Value>(state);
}

template <class Value>
void heat_content_and_back(benchmark::State& state) {
  const physics::HeatContent<physics::PowerLawCurve> content{{}, {0.0, 5.0}, true};
  Value temperature = -1.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(temperature);
    const Value heat = content.content(temperature, Value(0.375));
    benchmark::DoNotOptimize(content.temperature(heat, Value(0.375), temperature - Value(1e-3)));
  }
  count_particles<Value>(state);
}

template <class Value>
void ugimp_axis(benchmark::State& state) {
  Value offset = 0.1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(offset);
    benchmark::DoNotOptimize(mpm::ugimp_weights(offset, mpm::HalfSize<Value>(Value(0.25), Value(4.0)), 1.0));
  }
  count_particles<Value>(state);
}

// Particles at random positions with their grid, as many per cell as in a body with two per axis.
template <int Dim>
struct Body {
  mpm::Particles<Dim> particles;
  mpm::SparseGrid<Dim> grid{1.0};

  Body() {
    constexpr double edge = Dim == 2 ? 20.0 : 8.0;
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> place(4.0, 4.0 + edge);
    particles.resize(static_cast<std::size_t>(std::pow(2.0 * edge, Dim)));
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.id(p) = static_cast<std::int64_t>(p);
      for (int a = 0; a < Dim; ++a) {
        particles.position(p, a) = place(random);
      }
    }
    grid.update(particles, 64);
  }

  // Calls work(batch, stencil of uGIMP) for every batch.
  template <class Work>
  void for_batches(const Work& work) const {
    for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
      for (const auto& batch : grid.batches(t)) {
        const auto place = grid_position(grid, particles, batch);
        work(batch, mpm::make_stencil(mpm::ShapeFunction::ugimp, grid, batch, place,
                                      {Simd<double>(0.25), Simd<double>(4.0)}, mpm::PrescribedSides<Dim>()));
      }
    }
  }
};

// Nodes, weights and contributions of the momentum stage: all its values, and the stress with gradients.
template <int Dim>
void momentum_to_nodes(benchmark::State& state) {
  const Body<Dim> body;
  mpm::Patch<Dim, mpm::MomentumLayout<Dim>::size> patch;
  patch.clear();
  mpm::Contribution<Dim, mpm::MomentumLayout<Dim>::size> carried;
  for (auto _ : state) {
    auto sums = mpm::cell_sums<0, mpm::MomentumLayout<Dim>::size>(patch);
    body.for_batches([&](const auto& batch, const auto& stencil) {
      for (std::size_t c = 0; c < mpm::MomentumLayout<Dim>::size; ++c) {
        benchmark::DoNotOptimize(carried.value[c]);
      }
      for (std::size_t k = 0; k < Dim * Dim; ++k) {
        benchmark::DoNotOptimize(carried.flux[k / Dim][k % Dim]);
      }
      sums.add(stencil, batch.count, carried);
    });
    benchmark::DoNotOptimize(patch);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(body.particles.size()));
}

// Nodes, weights and input of the stress stage: the gradient of velocity.
template <int Dim>
void gradient_from_nodes(benchmark::State& state) {
  const Body<Dim> body;
  mpm::Patch<Dim, Dim> velocity;
  velocity.clear();
  for (auto _ : state) {
    benchmark::DoNotOptimize(velocity);
    body.for_batches([&](const auto& /*batch*/, const auto& stencil) {
      benchmark::DoNotOptimize(mpm::gradient_of(mpm::read_nodes<Dim>(stencil, velocity)));
    });
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(body.particles.size()));
}

template <class Value>
void add_formulas(const std::string& of) {
  const auto add = [&](const std::string& name, auto function) {
    benchmark::RegisterBenchmark((of + name).c_str(), function);
  };
  const auto add_law = [&](const std::string& name, double shear) {
    add("mohr_coulomb, plane, " + name, [shear](auto& state) { mohr_coulomb<Value, 2>(state, shear); });
    add("mohr_coulomb, space, " + name, [shear](auto& state) { mohr_coulomb<Value, 3>(state, shear); });
  };
  add_law("elastic", 5e5);
  add_law("yielding", 2e7);
  add("strain_and_rotation, plane", strain_and_rotation<Value, 2>);
  add("strain_and_rotation, space", strain_and_rotation<Value, 3>);
  add("heat_content_and_back", heat_content_and_back<Value>);
  add("ugimp_axis", ugimp_axis<Value>);
}

}  // namespace

void add_kernels() {
  add_formulas<double>("one number: ");
  add_formulas<Simd<double>>("lanes: ");
  benchmark::RegisterBenchmark("momentum_to_nodes, plane", momentum_to_nodes<2>);
  benchmark::RegisterBenchmark("momentum_to_nodes, space", momentum_to_nodes<3>);
  benchmark::RegisterBenchmark("gradient_from_nodes, plane", gradient_from_nodes<2>);
  benchmark::RegisterBenchmark("gradient_from_nodes, space", gradient_from_nodes<3>);
}

}  // namespace thawslide::speed
