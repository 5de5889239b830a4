// Runs passes with CPU lanes and with the device implementation, and compares the results bitwise.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <typeinfo>

#include "../support/fields.hpp"
#include "band/pressure_kernels.hpp"
#include "device/cells.hpp"
#include "device/host_backend.hpp"
#include "device/particles.hpp"
#include "device/passes.hpp"
#include "mpm/stress_kernel.hpp"
#include "scene.hpp"

namespace thawslide::testing_support {

using device::Host, device::HostGroup, device::ThreadOrder;

// Inputs of a pass other than weights and kernels: its records, its filter of tiles, and the condition on the ground at
// a node for which its sums are compared.
template <class Records, class TileFilter, class ColumnQuery>
struct Pass {
  std::string name;
  Records& records;
  TileFilter accepts;
  ColumnQuery asked;
  bool shows_barriers = true;  // whether results differ if a barrier is missing
};
inline constexpr auto everywhere = [](const auto& /*ground*/) { return true; };

// The same filter on a device, which applies it to every particle.
template <class TileFilter, int Dim>
struct TileFilterOnDevice {
  TileFilter accepts;

  bool operator()(std::size_t tile) const { return accepts(tile); }
  bool operator()(std::size_t tile, std::size_t cell) const {
    return mpm::accepts_nodes(accepts, tile, device::lowest_about<Dim>(cell));
  }
};

// Weights of momentum with the shape function as a type, as a device needs it. Weights: MomentumWeights, AffineWeights.
template <class Shape, int Dim, template <int> class Weights = mpm::MomentumWeights>
struct ShapedWeights : Weights<Dim> {};

inline const mpm::LinearWeights& on_host(const mpm::LinearWeights& weights) { return weights; }
template <class Shape, int Dim, template <int> class Weights>
const Weights<Dim>& on_host(const ShapedWeights<Shape, Dim, Weights>& weights) {
  return weights;
}
inline device::LinearWeights on_device(const mpm::LinearWeights& /*weights*/) { return {}; }
template <class Shape, int Dim>
device::MomentumWeights<Shape, Dim> on_device(const ShapedWeights<Shape, Dim>& weights) {
  return {weights.sizes.view(), weights.sides};
}
template <class Shape, int Dim>
device::AffineWeights<Shape, Dim> on_device(const ShapedWeights<Shape, Dim, mpm::AffineWeights>& weights) {
  return {{weights.sizes.view(), weights.sides}};
}

// The records of all nodes that a pass reads, by name.
template <class Reads>
class RecordsOnDevice;
template <class... Names>
class RecordsOnDevice<mpm::RecordList<Names...>> {
 public:
  template <int Dim, class Records>
  RecordsOnDevice([[maybe_unused]] const mpm::SparseGrid<Dim>& grid, [[maybe_unused]] Records& records) {
    (copy<Names>(grid, records), ...);
  }
  template <class Name>
  [[nodiscard]] const double* numbers() const {
    return numbers_.template of<Name>().data();
  }

 private:
  template <class Name, int Dim, class Records>
  void copy(const mpm::SparseGrid<Dim>& grid, Records& records) {
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
        const auto& of_name = records.template of<Name>();
        const auto record = of_name(mpm::NodeAt{b, k});
        auto& numbers = numbers_.template of<Name>();
        numbers.insert(numbers.end(), record.begin(), record.end());
      }
    }
  }
  mpm::ByName<mpm::Named<Names, std::vector<double>>...> numbers_;
};

// Sums of kernels as numbers.
inline void append_sum(double sum, std::vector<double>& numbers) { numbers.push_back(sum); }
inline void append_sum(const mpm::NoTotals& /*sum*/, std::vector<double>& /*numbers*/) {}
inline void append_sum(const mpm::Deformed& sum, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), {sum.work.total, sum.work.plastic, sum.work.viscous, sum.work.pore,
                                 static_cast<double>(sum.invalid.id), static_cast<double>(sum.invalid.fault)});
}
inline void append_sum(const mpm::InvalidParticle& sum, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), {static_cast<double>(sum.id), static_cast<double>(sum.fault)});
}
inline void append_sum(const band::DrainedWater& sum, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), {sum.mass, sum.heat});
}

// All results of a pass: fields, patches that it adds to, and sums.
using Bits = std::map<std::string, std::vector<double>>;

// on_device: the patches of the device; null: those of the scene's nodes.
template <class Name, int Dim, class ColumnQuery>
void append_patches_of(Scene<Dim>& scene, const ColumnQuery& asked, const double* on_device, Bits& bits) {
  constexpr std::size_t size = mpm::record_size(mpm::components_of<Name, Dim>);
  auto& of_name = bits[typeid(Name).name()];
  const auto patches = scene.nodes.template of<Name>().patches(scene.grid.tiles().size());
  for (std::size_t t = 0; t < patches.size(); ++t) {
    const std::int32_t* blocks = scene.grid.blocks_about_tile(t);
    mpm::for_each_direction<Dim>([&](auto d) {
      const auto& block = scene.ground.block(static_cast<std::size_t>(blocks[d]));
      mpm::for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
        const std::size_t place = t * static_cast<std::size_t>(mpm::Tile<Dim>::patch_nodes) + in_patch;
        const double* record = on_device != nullptr ? on_device + place * size : patches[t].records[in_patch].data();
        if (asked(block[in_block])) {
          of_name.insert(of_name.end(), record, record + size);
        }
      });
    });
  }
}

inline bool are_identical(const Bits& a, const Bits& b) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const auto& item) {
           const auto& other = b.at(item.first);
           return item.second.size() == other.size() &&
                  std::memcmp(item.second.data(), other.data(), other.size() * sizeof(double)) == 0;
         });
}

template <class Adds>
struct PatchesOf;
template <class... Names>
struct PatchesOf<mpm::RecordList<Names...>> {
  template <int Dim>
  static void clear([[maybe_unused]] Scene<Dim>& scene) {
    [[maybe_unused]] const auto clear_one = [&](auto patches) {
      for (auto& patch : patches) {
        patch.clear();
      }
    };
    (clear_one(scene.nodes.template of<Names>().patches(scene.grid.tiles().size())), ...);
  }
  template <int Dim, class ColumnQuery>
  static void append([[maybe_unused]] Scene<Dim>& scene, [[maybe_unused]] const ColumnQuery& asked,
                     [[maybe_unused]] const double* on_device, [[maybe_unused]] Bits& bits) {
    (append_patches_of<Names>(scene, asked, on_device, bits), ...);
  }
  static constexpr int count = sizeof...(Names);
};

// Executes a pass by run(particles, sums) on a copy of the scene's particles; run returns the patches on the device, or
// null.
template <class Adds, int Dim, class ColumnQuery, class Run>
Bits bits_of(Scene<Dim>& scene, const ColumnQuery& asked, const Run& run) {
  mpm::Particles<Dim> particles;
  particles.affine_velocity.keep(true);
  particles.viscous_stress.keep(true);
  Scene<Dim>::copy(scene.particles, particles);
  PatchesOf<Adds>::clear(scene);
  std::vector<double> sums;
  const auto patches = run(particles, sums);
  Bits bits = fields_by_id(particles);
  bits["sums"] = sums;
  PatchesOf<Adds>::append(scene, asked, patches.empty() ? nullptr : patches.data(), bits);
  return bits;
}

template <class Adds>
struct NumbersOfPatch {
  template <int Dim>
  static constexpr std::size_t count = 0;
};
template <class Name, class... Names>
struct NumbersOfPatch<mpm::RecordList<Name, Names...>> {
  template <int Dim>
  static constexpr std::size_t count = mpm::record_size(mpm::components_of<Name, Dim>) * mpm::Tile<Dim>::patch_nodes;
};

// Executes the pass of several kernels with the device implementation; returns its patches.
template <int Dim, class Records, class TileFilter, class ColumnQuery, class Weights, class... Kernels>
std::vector<double> run_on_device(Host host, const Pass<Records, TileFilter, ColumnQuery>& pass, Scene<Dim>& scene,
                                  const Weights& weights, mpm::Particles<Dim>& particles, std::vector<double>& sums,
                                  const Kernels&... kernels) {
  using Reads = mpm::AllOf<typename Kernels::Reads...>;
  using Adds = mpm::AllOf<typename Kernels::Adds...>;
  const std::size_t tiles = scene.grid.tiles().size(), numbers = tiles * NumbersOfPatch<Adds>::template count<Dim>;
  Host in_order;
  const auto view = mpm::view_of(particles);
  device::Particles<Host, Dim> on_host(in_order, view, particles.size());
  device::Cells<Host, Dim> cells(in_order, scene.grid.cell());
  cells.update(on_host.view(), on_host.by_id(), particles.size());
  device::PassMemory<Host> memory(in_order);
  in_order.wait();
  std::fill_n(memory.patches(numbers), numbers, 0.0);
  const RecordsOnDevice<Reads> records(scene.grid, pass.records);
  const device::PassOver<decltype(on_device(weights)), TileFilterOnDevice<TileFilter, Dim>, Dim> over{
      cells.tables(), on_host.view(), on_device(weights), {pass.accepts}, scene.grid.cell()};
  const auto* all = device::particle_pass(host, memory, over, records, kernels...);
  host.wait();
  if constexpr ((!std::is_same_v<typename Kernels::Totals, mpm::NoTotals> || ...)) {
    (append_sum(all->template of<Kernels>(), sums), ...);
  }
  on_host.copy_to(view);
  const double* patches = memory.patches(numbers);
  return {patches, patches + numbers};
}

// Compares the pass of several kernels by lanes and by groups.
template <int Dim, class Records, class TileFilter, class ColumnQuery, class Weights, class... Kernels>
void expect_identical_to_lanes(const Pass<Records, TileFilter, ColumnQuery>& pass, Scene<Dim>& scene,
                               const Weights& weights, const Kernels&... kernels) {
  const std::string& name = pass.name;
  using Adds = mpm::AllOf<typename Kernels::Adds...>;
  using Reads = mpm::AllOf<typename Kernels::Reads...>;
  Bits before = fields_by_id(scene.particles);
  PatchesOf<Adds>::clear(scene);
  PatchesOf<Adds>::append(scene, pass.asked, nullptr, before);
  before["sums"] = {};
  const Bits by_lanes = bits_of<Adds>(scene, pass.asked, [&](auto& particles, auto& sums) {
    const auto all =
        mpm::particle_pass(scene.grid, on_host(weights), particles, pass.records, pass.accepts, kernels...);
    std::apply([&](const auto&... sum) { (append_sum(sum, sums), ...); },
               static_cast<const std::tuple<typename Kernels::Totals...>&>(all));
    return std::vector<double>{};
  });
  const auto by_group = [&](const Host& host) {
    return bits_of<Adds>(scene, pass.asked, [&](auto& particles, auto& sums) {
      return run_on_device(host, pass, scene, weights, particles, sums, kernels...);
    });
  };
  EXPECT_FALSE(are_identical(by_lanes, before)) << name;
  for (const auto& [field, numbers] : by_lanes) {
    EXPECT_TRUE(std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        << name << field;
  }
  for (const ThreadOrder order : {ThreadOrder::forward, ThreadOrder::backward, ThreadOrder::shuffled}) {
    for (const std::size_t threads : {std::size_t{32}, std::size_t{7}}) {
      const Bits found = by_group(Host(order, threads));
      for (const auto& [field, numbers] : by_lanes) {
        ASSERT_EQ(found.at(field).size(), numbers.size()) << name << ": " << field;
        EXPECT_EQ(std::memcmp(found.at(field).data(), numbers.data(), numbers.size() * sizeof(double)), 0)
            << name << ": " << field << ", " << threads << " threads, order " << static_cast<int>(order);
      }
    }
  }
  // Planes are read after barrier 1, when nodes sum the contributions of particles.
  constexpr bool reads =
      !std::is_same_v<Reads, mpm::RecordList<>> && !std::is_same_v<Reads, mpm::RecordList<mpm::Planes>>;
  constexpr bool adds_up = (!std::is_same_v<typename Kernels::Totals, mpm::NoTotals> || ...);
  constexpr int added = PatchesOf<Adds>::count, first = reads ? 0 : 1, last = added > 0 ? 2 * added : adds_up ? 1 : 0;
  for (int barrier = first; barrier <= last && pass.shows_barriers; ++barrier) {
    EXPECT_FALSE(are_identical(by_lanes, by_group(Host(ThreadOrder::shuffled, 7, barrier))))
        << name << ", barrier " << barrier;
  }
}
template <int Dim, class Weights, class... Kernels>
void expect_identical_to_lanes(const std::string& name, Scene<Dim>& scene, const Weights& weights,
                               const Kernels&... kernels) {
  const Pass<mpm::Nodes<Dim>, decltype(mpm::every_tile), decltype(everywhere)> pass{name, scene.nodes, mpm::every_tile,
                                                                                    everywhere};
  expect_identical_to_lanes(pass, scene, weights, kernels...);
}

}  // namespace thawslide::testing_support
