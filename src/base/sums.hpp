// Sums independent of the order of additions, and the order of other sums on the CPU and on a device.
#pragma once

#include <cstddef>

#include "base/portability.hpp"

namespace thawslide {

// Sum with rounding error, exact below 2^51 times the smallest part: sums of one sign are bitwise independent of the
// order. Error-free sum of two: Knuth 1998, The Art of Computer Programming, vol. 2, Section 4.2.2, Theorem B.
class ExactSum {
 public:
  ExactSum() = default;
  THAWSLIDE_HD ExactSum(double number) : sum_(number) {}  // NOLINT(google-explicit-constructor)

  THAWSLIDE_HD operator double() const { return sum_; }  // NOLINT(google-explicit-constructor)

  THAWSLIDE_HD ExactSum& operator+=(const ExactSum& part) {
    const double sum = sum_ + part.sum_, of_part = sum - sum_;
    const double rest = (sum_ - (sum - of_part)) + (part.sum_ - of_part) + (rest_ + part.rest_);
    sum_ = sum + rest;
    rest_ = rest - (sum_ - sum);
    return *this;
  }

 private:
  double sum_ = 0, rest_ = 0;
};

// Parts are added in runs of this size, and then the sums of the runs, in order. A device can add all runs in parallel.
inline constexpr std::size_t parts_of_a_run = 128;
constexpr std::size_t runs_of(std::size_t parts) { return (parts + parts_of_a_run - 1) / parts_of_a_run; }

}  // namespace thawslide
