// Half sizes of particles, uniform within a body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "base/portability.hpp"
#include "mpm/shape.hpp"

namespace thawslide::mpm {

// Half sizes by body, as used by kernels.
struct SizesOfBodies {
  const double *half, *inverse;
  bool is_uniform;  // there is one body

  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE HalfSize<typename At::Value> of(const Particles& particles,
                                                                                     const At& at) const {
    if (is_uniform) {
      return {half[0], inverse[0]};
    }
    const auto of_body = [&](const double* by_body) {
      return at.each([&](std::uint32_t p) { return by_body[static_cast<std::size_t>(particles.body(p))]; });
    };
    return {of_body(half), of_body(inverse)};
  }
};

class BodySizes {
 public:
  BodySizes() = default;
  BodySizes(std::initializer_list<double> halves) {
    for (const double half : halves) {
      add(half);
    }
  }

  void add(double half) {
    half_.push_back(half);
    inverse_.push_back(1.0 / half);
  }
  [[nodiscard]] double half(std::size_t body) const { return half_[body]; }
  // The same in another unit.
  [[nodiscard]] BodySizes times(double factor) const {
    BodySizes other;
    for (const double half : half_) {
      other.add(factor * half);
    }
    return other;
  }

  [[nodiscard]] SizesOfBodies view() const { return {half_.data(), inverse_.data(), half_.size() == 1}; }
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE HalfSize<typename At::Value> of(const Particles& particles,
                                                                        const At& at) const {
    return view().of(particles, at);
  }

 private:
  std::vector<double> half_, inverse_;
};

}  // namespace thawslide::mpm
