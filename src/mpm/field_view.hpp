// View of a particle field's memory for kernels. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/scalar_index.hpp"

namespace thawslide::mpm {

// Particles per block. Within a block, the values of one component share a cache line, and components are consecutive.
inline constexpr std::size_t particles_of_block = 8;

template <int Components>
THAWSLIDE_HD constexpr std::size_t index_in_field(std::size_t particle, int component) {
  constexpr std::size_t block = particles_of_block;
  return (particle / block * Components + static_cast<std::size_t>(component)) * block + particle % block;
}

template <class T, int Components>
struct FieldView {
  T* numbers;  // null if the field is not stored

  [[nodiscard]] THAWSLIDE_HD bool is_kept() const { return numbers != nullptr; }
  [[nodiscard]] THAWSLIDE_HD T& operator()(std::size_t particle, int component = 0) const {
    return numbers[index_in_field<Components>(particle, component)];
  }
  [[nodiscard]] THAWSLIDE_HD T load(const ScalarIndex& one, int component = 0) const {
    return (*this)(one.particle[0], component);
  }
  THAWSLIDE_HD void store(const ScalarIndex& one, T value, int component = 0) const {
    (*this)(one.particle[0], component) = value;
  }
  // Integers, converted from and to a real type.
  [[nodiscard]] THAWSLIDE_HD double load_whole(const ScalarIndex& one) const {
    return static_cast<double>((*this)(one.particle[0]));
  }
  THAWSLIDE_HD void store_whole(const ScalarIndex& one, double value) const {
    (*this)(one.particle[0]) = static_cast<T>(value);
  }
  // All components of vectors and tensors.
  template <int Size>
  [[nodiscard]] THAWSLIDE_HD Vector<T, Size> load_vector(const ScalarIndex& one) const {
    Vector<T, Size> v;
    unrolled<static_cast<std::size_t>(Size)>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      constexpr int c = static_cast<int>(k());
      v[c] = c < Components ? load(one, c) : T(0);
    });
    return v;
  }
  template <class Values>
  THAWSLIDE_HD void store_vector(const ScalarIndex& one, const Values& values) const {
    unrolled<static_cast<std::size_t>(Components)>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      constexpr int c = static_cast<int>(k());
      store(one, values[c], c);
    });
  }
};

}  // namespace thawslide::mpm
