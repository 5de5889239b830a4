// Half sizes of particles by body, in device memory.
#pragma once

#include <vector>

#include "exec/array.hpp"
#include "mpm/body_sizes.hpp"

namespace thawslide::device {

template <class Backend>
class BodySizes {
 public:
  // unit: unit of half_sizes, as a factor.
  BodySizes(Backend& backend, const std::vector<double>& half_sizes, double unit) : half_(backend), inverse_(backend) {
    std::vector<double> half, inverse;
    for (const double number : half_sizes) {
      half.push_back(unit * number);
      inverse.push_back(1.0 / half.back());
    }
    half_.set(half);
    inverse_.set(inverse);
  }

  [[nodiscard]] mpm::SizesOfBodies view() const { return {half_.data(), inverse_.data(), half_.size() == 1}; }

 private:
  exec::Array<double, Backend> half_, inverse_;
};

}  // namespace thawslide::device
