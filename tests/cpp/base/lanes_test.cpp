// Operations of lanes other than arithmetic: between memory and registers, and from rows to columns.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <numeric>

#include "base/simd.hpp"

namespace thawslide {
namespace {

template <class Real>
class LanesTest : public testing::Test {};
using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(LanesTest, Reals);

TYPED_TEST(LanesTest, GatherAndScatterUseIndices) {
  using Real = TypeParam;
  constexpr std::size_t count = simd_width<Real>;
  std::array<Real, 3 * count> numbers{};
  std::iota(numbers.begin(), numbers.end(), Real(0));
  std::array<std::int32_t, count> places{};
  for (std::size_t k = 0; k < count; ++k) {
    places[k] = static_cast<std::int32_t>((5 * k + 2) % numbers.size());
  }
  const auto whole = whole_lanes<Real>(places.data());
  const auto gathered = Simd<Real>::gather(numbers.data(), whole);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_EQ(gathered[k], static_cast<Real>(places[k]));
  }
  for (std::size_t stored = 0; stored <= count; ++stored) {
    std::array<Real, 3 * count> to{};
    (gathered + Real(100)).scatter(to.data(), whole, stored);
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_EQ(to[static_cast<std::size_t>(places[k])], k < stored ? gathered[k] + Real(100) : Real(0));
    }
    EXPECT_EQ(std::count(to.begin(), to.end(), Real(0)), static_cast<std::ptrdiff_t>(to.size() - stored));
  }
}

template <class Real, std::size_t Width>
void expect_rows_and_columns() {
  constexpr std::size_t count = simd_width<Real>;
  const auto number = [](std::size_t quantity, std::size_t particle) {
    return static_cast<Real>(10 * quantity + particle + 1);
  };
  Simd<Real> quantities[Width], back[Width];
  for (std::size_t q = 0; q < Width; ++q) {
    quantities[q] = Simd<Real>::of([&](std::size_t lane) { return number(q, lane); });
  }
  Simd<Real, Width> rows[count];
  transpose_to_rows(quantities, rows);
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t q = 0; q < Width; ++q) {
      EXPECT_EQ(rows[p][q], number(q, p));
    }
  }
  transpose_to_columns(rows, back);
  for (std::size_t q = 0; q < Width; ++q) {
    for (std::size_t p = 0; p < count; ++p) {
      EXPECT_EQ(back[q][p], number(q, p));
    }
  }
}

TYPED_TEST(LanesTest, RowsBecomeColumnsAndBack) {
  expect_rows_and_columns<TypeParam, 4>();
  expect_rows_and_columns<TypeParam, simd_width<TypeParam>>();
}

TYPED_TEST(LanesTest, MasksSelectTheirLanes) {
  using Real = TypeParam;
  EXPECT_FALSE(any(lanes_before<Real>(0)));
  for (std::size_t count = 1; count <= simd_width<Real>; ++count) {
    const auto before = lanes_before<Real>(count);
    EXPECT_TRUE(any(before));
    EXPECT_EQ(any(!before), count < simd_width<Real>);
    for (std::size_t k = 0; k < simd_width<Real>; ++k) {
      EXPECT_EQ(before[k], k < count);
    }
  }
}

// Including zeros of both signs and NaN.
TYPED_TEST(LanesTest, SmallerAndLargerAreBitwiseEqualToScalarOnes) {
  using Real = TypeParam;
  const std::array<Real, 7> numbers{Real(-2),
                                    Real(-0.0),
                                    Real(0),
                                    Real(1.5),
                                    std::numeric_limits<Real>::infinity(),
                                    -std::numeric_limits<Real>::infinity(),
                                    std::numeric_limits<Real>::quiet_NaN()};
  const auto is_same = [](Real a, Real b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  for (const Real a : numbers) {
    for (const Real b : numbers) {
      EXPECT_TRUE(is_same(min(a, b), min(Simd<Real>(a), Simd<Real>(b))[0])) << a << " " << b;
      EXPECT_TRUE(is_same(max(a, b), max(Simd<Real>(a), Simd<Real>(b))[0])) << a << " " << b;
      EXPECT_TRUE(is_same(min(a, b), std::min(a, b)) && is_same(max(a, b), std::max(a, b))) << a << " " << b;
    }
  }
}

}  // namespace
}  // namespace thawslide
