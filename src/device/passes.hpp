// Particle passes and nodal sums on a backend.
#pragma once

#include "device/add_up.hpp"
#include "device/node_sums.hpp"
#include "device/particle_pass.hpp"
#include "exec/array.hpp"

namespace thawslide::device {

// Memory of passes, reused in all steps: patches, and sums of kernels.
template <class Backend>
class PassMemory {
 public:
  explicit PassMemory(Backend& backend) : patches_(backend), sums_(backend) {}

  [[nodiscard]] double* patches(std::size_t numbers) {
    patches_.resize(numbers > patches_.size() ? numbers : patches_.size());
    return patches_.data();
  }
  // count: number of entries.
  template <class Sums>
  [[nodiscard]] Sums* sums(std::size_t count) {
    sums_.resize(count * sizeof(Sums) > sums_.size() ? count * sizeof(Sums) : sums_.size());
    return reinterpret_cast<Sums*>(sums_.data());
  }

 private:
  exec::Array<double, Backend> patches_;
  exec::Array<std::byte, Backend> sums_;
};

// Nodal records, one array per name.
template <class Backend, class... Names>
struct NodeArrays : mpm::ByName<mpm::Named<Names, exec::Array<double, Backend>>...> {
  explicit NodeArrays(Backend& backend)
      : mpm::ByName<mpm::Named<Names, exec::Array<double, Backend>>...>{
            mpm::Named<Names, exec::Array<double, Backend>>{exec::Array<double, Backend>(backend)}...} {}
};

// Equivalent of mpm::particle_pass, with kernels that hold their parameters by value. Contributions are left in the
// patches of `memory`. Returns a pointer, in device memory, to the kernels' sums over particles, valid until the next
// pass. records: nodal records to read, by name.
template <class Backend, class Weights, class TileFilter, int Dim, class Records, class... Kernels>
SumsOf<Kernels...>* particle_pass(Backend& backend, PassMemory<Backend>& memory,
                                  const PassOver<Weights, TileFilter, Dim>& over, const Records& records,
                                  const Kernels&... kernels) {
  using Reads = mpm::AllOf<typename Kernels::Reads...>;
  using Adds = mpm::AllOf<typename Kernels::Adds...>;
  using Pass = ParticlePass<PassOver<Weights, TileFilter, Dim>, Reads, Adds, Dim, Kernels...>;
  const std::size_t tiles = over.tables.tiles;
  auto* sums = memory.template sums<SumsOf<Kernels...>>(partial_sum_count(tiles));
  const Pass pass{over,
                  RecordsRead<Reads>::from(records),
                  memory.patches(tiles * Pass::patch_nodes * Pass::size),
                  sums,
                  {{kernels}...}};
  backend.for_groups(tiles, Pass::MemoryLayout::threads, Pass::MemoryLayout::bytes, pass);
  if constexpr (Pass::adds_up) {
    return add_up(backend, sums, tiles);
  }
  return sums;
}

// Calls, for one particle in memory order, a kernel that neither accesses nodes nor sums.
template <int Dim, class Kernel>
struct VisitInMemory {
  static_assert(std::is_same_v<typename Kernel::Reads, mpm::RecordList<>> &&
                std::is_same_v<typename Kernel::Adds, mpm::RecordList<>> &&
                std::is_same_v<typename Kernel::Totals, mpm::NoTotals>);

  mpm::ParticleView<Dim> particles;
  Kernel kernel;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    mpm::ParticleView<Dim> view = particles;
    const mpm::ByName<> seen{};
    mpm::ByName<> added{};
    mpm::NoTotals totals;
    kernel(view, mpm::ScalarIndex{{static_cast<std::uint32_t>(k)}}, seen, added, totals);
  }
};

}  // namespace thawslide::device
