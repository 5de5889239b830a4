// Layout of a thread group's shared memory in a particle pass (device/particle_pass.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "mpm/body_sizes.hpp"
#include "mpm/kernel.hpp"
#include "mpm/one_particle.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// Sums over particles, by kernel.
template <class... Kernels>
struct SumsOf : mpm::ByName<mpm::Named<Kernels, typename Kernels::Totals>...> {
  THAWSLIDE_HD SumsOf& operator+=([[maybe_unused]] const SumsOf& part) {
    ((this->template of<Kernels>() += part.template of<Kernels>()), ...);
    return *this;
  }
};

// Kernel of a tile; kernels that depend on the tile provide in_tile(tile).
template <class Kernel>
THAWSLIDE_HD decltype(auto) kernel_of(const Kernel& kernel, [[maybe_unused]] std::size_t tile) {
  if constexpr (requires { kernel.in_tile(tile); }) {
    return kernel.in_tile(tile);
  } else {
    return (kernel);
  }
}

template <class Functions, int Dim>
using StencilBy = mpm::OneStencil<Dim, std::is_same_v<Functions, mpm::LinearFunctions> ? 2 : 3>;

// Weights with which a particle adds.
template <class List, int Dim>
struct Stencils;
template <class... Functions, int Dim>
struct Stencils<mpm::RecordList<Functions...>, Dim> : mpm::ByName<mpm::Named<Functions, StencilBy<Functions, Dim>>...> {
  THAWSLIDE_HD void keep([[maybe_unused]] const mpm::OneWeights<Dim>& weights) {
    ((this->template of<Functions>() = weights.template of<Functions>()), ...);
  }
};

// Size of the record that a list adds to; 0 for an empty list.
template <class List>
struct OwnerOfList {
  template <int>
  static constexpr int size = 0;
};
template <class Name, class... Names>
struct OwnerOfList<mpm::RecordList<Name, Names...>> {
  template <int Dim>
  static constexpr int size = mpm::components_of<Name, Dim>;
};

// Contents with or without one number of padding.
template <class Contents, bool is_padded>
struct PaddedTo : Contents {};
template <class Contents>
struct PaddedTo<Contents, true> : Contents {
  double after;
};

// Patch that is read.
template <class Name, int Dim>
struct PatchRead {
  static constexpr std::size_t size = mpm::record_size(mpm::components_of<Name, Dim>);
  static constexpr std::size_t count = static_cast<std::size_t>(mpm::Tile<Dim>::patch_nodes) * size;
  const double* numbers;
};

template <class Reads, class Adds, int Dim, class... Kernels>
class SharedMemoryLayout;
template <class... Reads, class... Adds, int Dim, class... Kernels>
class SharedMemoryLayout<mpm::RecordList<Reads...>, mpm::RecordList<Adds...>, Dim, Kernels...> {
  using Names = mpm::RecordList<Adds...>;
  static_assert(mpm::all_apart<Names, Dim>, "particles add to these components of a record in different ways");
  static_assert(mpm::one_record<Names>, "a pass can add to one record only");
  static_assert(mpm::are_disjoint<mpm::RecordList<Reads...>, Names>,
                "no record is read in the pass that adds to it: it has no sums yet");

 public:
  // Particles per chunk, cells per chunk, and threads per group.
  static constexpr std::size_t capacity = Dim == 2 ? 64 : 128, most_cells = 16, threads = capacity;
  static constexpr std::size_t cell_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
  static constexpr std::size_t size = mpm::record_size(OwnerOfList<Names>::template size<Dim>);
  // adds_up: kernels sum over particles. accumulates: the record already has sums from an earlier pass.
  static constexpr bool adds_up = (!std::is_same_v<typename Kernels::Totals, mpm::NoTotals> || ...);
  static constexpr bool accumulates = (mpm::OfAnOwner<Adds> && ...);

  using Carried = mpm::ByName<mpm::Named<Adds, mpm::CarriedByOne<Adds, Dim>>...>;
  using PatchesRead = mpm::ByName<mpm::Named<Reads, PatchRead<Reads, Dim>>...>;

  // Data of a particle.
  struct Contents {
    Carried carried;
    Stencils<mpm::AllOf<mpm::RecordList<typename Adds::Functions>...>, Dim> stencils;
    SumsOf<Kernels...> sums;
  };
  template <class T>
  static constexpr bool has_even_numbers = alignof(T) == alignof(double) && sizeof(T) / sizeof(double) > 0 &&
                                           sizeof(T) / sizeof(double) % 2 == 0;
  // An odd size in numbers avoids bank conflicts between adjacent threads.
  struct Slot : PaddedTo<Contents, has_even_numbers<Contents>> {
    THAWSLIDE_HD void keep(const mpm::OneWeights<Dim>& weights) { this->stencils.keep(weights); }
    template <class Name>
    [[nodiscard]] THAWSLIDE_HD const auto& stencil() const {
      return this->stencils.template of<typename Name::Functions>();
    }
  };
  static_assert(!has_even_numbers<Slot>);

  THAWSLIDE_HD explicit SharedMemoryLayout(std::byte* memory) : memory_(memory) {}

  [[nodiscard]] THAWSLIDE_HD Slot* slots() const { return at<Slot>(0); }
  [[nodiscard]] THAWSLIDE_HD SumsOf<Kernels...>* sums() const { return at<SumsOf<Kernels...>>(sums_at); }
  [[nodiscard]] THAWSLIDE_HD double* patch() const { return at<double>(patch_at); }
  [[nodiscard]] THAWSLIDE_HD double* cell_sums() const { return at<double>(cell_sums_at); }
  // Partial sums, at the start of chunk `number`, of the cell that continues from the chunk before.
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD double* open(std::size_t number) const {
    return at<double>(open_at) + (2 * before<Name, Adds...>() + number % 2 * mpm::scatter_size<Name, Dim>)*cell_nodes;
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD double* read() const {
    return at<double>(reads_at) + before_read<Name, Reads...>();
  }
  [[nodiscard]] THAWSLIDE_HD PatchesRead patches_read() const { return {{{read<Reads>()}}...}; }

  template <class Name>
  [[nodiscard]] THAWSLIDE_HD static constexpr bool is_first() {
    return before<Name, Adds...>() == 0;
  }

 private:
  static constexpr std::size_t up(std::size_t bytes) { return (bytes + 15) / 16 * 16; }
  static constexpr std::size_t largest() {
    std::size_t most = 0;
    ((most = most < mpm::scatter_size<Adds, Dim> ? mpm::scatter_size<Adds, Dim> : most), ...);
    return most;
  }
  // Offsets of a name in its list: numbers that the preceding records scatter, or read in their patches.
  template <class Name, class First, class... Rest>
  THAWSLIDE_HD static constexpr std::size_t before() {
    if constexpr (std::is_same_v<Name, First>) {
      return 0;
    } else {
      return mpm::scatter_size<First, Dim> + before<Name, Rest...>();
    }
  }
  template <class Name, class First, class... Rest>
  THAWSLIDE_HD static constexpr std::size_t before_read() {
    if constexpr (std::is_same_v<Name, First>) {
      return 0;
    } else {
      return PatchRead<First, Dim>::count + before_read<Name, Rest...>();
    }
  }

  static constexpr std::size_t slots_bytes = up(capacity * sizeof(Slot));
  static constexpr std::size_t sums_at = slots_bytes;
  static constexpr std::size_t patch_at = sums_at + up(sizeof(SumsOf<Kernels...>));
  static constexpr std::size_t cell_sums_at =
      patch_at + up(static_cast<std::size_t>(mpm::Tile<Dim>::patch_nodes) * size * sizeof(double));
  static constexpr std::size_t open_at = cell_sums_at + up(most_cells * cell_nodes * largest() * sizeof(double));
  static constexpr std::size_t reads_at =
      open_at + up(2 * cell_nodes * (std::size_t{0} + ... + mpm::scatter_size<Adds, Dim>)*sizeof(double));

  template <class Type>
  [[nodiscard]] THAWSLIDE_HD Type* at(std::size_t offset) const {
    return reinterpret_cast<Type*>(memory_ + offset);
  }

  std::byte* memory_;

 public:
  static constexpr std::size_t bytes =
      reads_at + up((std::size_t{0} + ... + PatchRead<Reads, Dim>::count) * sizeof(double));
};

// Linear shape functions for all records of the pass.
struct LinearWeights {
  template <int Dim>
  [[nodiscard]] THAWSLIDE_HD static bool at_side(std::size_t /*axis*/, int /*node*/) {
    return false;
  }
  template <int Dim, class Particles>
  THAWSLIDE_HD void set(mpm::OneWeights<Dim>& weights, const mpm::OneGridPosition<Dim>& position,
                        const Particles& /*particles*/, const mpm::ScalarIndex& /*at*/, double /*cell*/,
                        double inverse_cell) const {
    weights.set_linear(position, inverse_cell);
  }
};

// Shape: shape functions of momentum. sizes: of particles, in cells, in device memory.
template <class Shape, int Dim>
struct MomentumWeights {
  mpm::SizesOfBodies sizes;
  mpm::PrescribedSides<Dim> sides;

  template <int>
  [[nodiscard]] THAWSLIDE_HD bool at_side(std::size_t axis, int node) const {
    return node == sides.lower[axis] || node == sides.upper[axis];
  }
  template <class Particles>
  THAWSLIDE_HD void set(mpm::OneWeights<Dim>& weights, const mpm::OneGridPosition<Dim>& position,
                        const Particles& particles, const mpm::ScalarIndex& at, double /*cell*/,
                        double inverse_cell) const {
    weights.set_linear(position, inverse_cell);
    weights.template set_momentum<Shape>(position, sizes.of(particles, at), inverse_cell);
  }
};

// Adds the weights of APIC.
template <class Shape, int Dim>
struct AffineWeights : MomentumWeights<Shape, Dim> {
  template <class Particles>
  THAWSLIDE_HD void set(mpm::OneWeights<Dim>& weights, const mpm::OneGridPosition<Dim>& position,
                        const Particles& particles, const mpm::ScalarIndex& at, double cell,
                        double inverse_cell) const {
    MomentumWeights<Shape, Dim>::set(weights, position, particles, at, cell, inverse_cell);
    weights.template set_affine<Shape>(position, cell, inverse_cell);
  }
};

}  // namespace thawslide::device
