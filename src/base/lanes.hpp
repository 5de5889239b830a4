// Several numbers worked on at once: lane k of every quantity belongs to the k-th particle of a batch. A formula that
// takes its numbers as a template parameter works for one number and for lanes alike; `select` stands in for a branch.
//
// g++ keeps an array of registers in registers only if it is never indexed by a variable: hence `unrolled`.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide {

// body(k) for k = 0 .. Count-1, k being a constant.
template <std::size_t Count, class Body>
THAWSLIDE_ALWAYS_INLINE void unrolled(const Body& body) {
  [&]<std::size_t... K>(std::index_sequence<K...>) THAWSLIDE_INLINE_LAMBDA {
    (body(std::integral_constant<std::size_t, K>()), ...);
  }
  (std::make_index_sequence<Count>());
}

// The vector register of a real type, and that of its comparisons.
template <class Real>
struct LaneRegister;
template <>
struct LaneRegister<double> {
  using Flag = std::int64_t;
  using Numbers = double __attribute__((vector_size(32)));
  using Stored = double __attribute__((vector_size(32), may_alias));  // among single numbers in memory
  using Flags = std::int64_t __attribute__((vector_size(32)));
  using Whole = std::int32_t __attribute__((vector_size(16)));
};

template <>
struct LaneRegister<float> {
  using Flag = std::int32_t;
  using Numbers = float __attribute__((vector_size(32)));
  using Stored = float __attribute__((vector_size(32), may_alias));
  using Flags = std::int32_t __attribute__((vector_size(32)));
  using Whole = std::int32_t __attribute__((vector_size(32)));
};

template <class Real>
inline constexpr std::size_t lane_count = sizeof(typename LaneRegister<Real>::Numbers) / sizeof(Real);

// One yes or no a lane.
template <class Real>
class LaneMask {
 public:
  using Native = typename LaneRegister<Real>::Flags;

  LaneMask() = default;
  THAWSLIDE_ALWAYS_INLINE explicit LaneMask(Native native) : native_(native) {}

  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE bool operator[](std::size_t lane) const { return native_[lane] != 0; }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Native native() const { return native_; }

  THAWSLIDE_ALWAYS_INLINE friend LaneMask operator&(LaneMask a, LaneMask b) { return LaneMask(a.native_ & b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend LaneMask operator|(LaneMask a, LaneMask b) { return LaneMask(a.native_ | b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend LaneMask operator!(LaneMask a) { return LaneMask(~a.native_); }
  THAWSLIDE_ALWAYS_INLINE friend bool any(LaneMask a) {
#ifdef __AVX__
    using Bits = long long __attribute__((vector_size(32)));
    return __builtin_ia32_ptestz256(Bits(a.native_), Bits(a.native_)) == 0;
#else
    typename LaneRegister<Real>::Flag flags = 0;
    for (std::size_t k = 0; k < lane_count<Real>; ++k) {
      flags |= a.native_[k];
    }
    return flags != 0;
#endif
  }

 private:
  Native native_;
};

template <class Real>
class Lanes {
 public:
  static constexpr std::size_t count = lane_count<Real>;
  using Native = typename LaneRegister<Real>::Numbers;
  using Mask = LaneMask<Real>;

  Lanes() = default;
  // The same number in all lanes.
  THAWSLIDE_ALWAYS_INLINE Lanes(Real number) : native_(number - Native{}) {}
  THAWSLIDE_ALWAYS_INLINE explicit Lanes(Native native) : native_(native) {}

  // From and to `count` numbers side by side, on a boundary of their size.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Lanes load(const Real* numbers) {
    return Lanes(Native(*reinterpret_cast<const typename LaneRegister<Real>::Stored*>(numbers)));
  }
  THAWSLIDE_ALWAYS_INLINE void store(Real* numbers) const {
    *reinterpret_cast<typename LaneRegister<Real>::Stored*>(numbers) = native_;
  }

  // Whole numbers, from and to `count` places side by side.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Lanes load_whole(const std::int32_t* numbers) {
    typename LaneRegister<Real>::Whole whole;
    std::memcpy(&whole, numbers, sizeof whole);
    return Lanes(__builtin_convertvector(whole, Native));
  }
  THAWSLIDE_ALWAYS_INLINE void store_whole(std::int32_t* numbers) const {
    const auto whole = __builtin_convertvector(native_, typename LaneRegister<Real>::Whole);
    std::memcpy(numbers, &whole, sizeof whole);
  }

  // Lane k is number(k).
  template <class Number>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Lanes of(const Number& number) {
    return [&]<std::size_t... K>(std::index_sequence<K...>) THAWSLIDE_INLINE_LAMBDA {
      return Lanes(Native{static_cast<Real>(number(K))...});
    }
    (std::make_index_sequence<count>());
  }

  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Real operator[](std::size_t lane) const { return native_[lane]; }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Native native() const { return native_; }

  THAWSLIDE_ALWAYS_INLINE friend Lanes operator+(Lanes a, Lanes b) { return Lanes(a.native_ + b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Lanes operator-(Lanes a, Lanes b) { return Lanes(a.native_ - b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Lanes operator*(Lanes a, Lanes b) { return Lanes(a.native_ * b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Lanes operator/(Lanes a, Lanes b) { return Lanes(a.native_ / b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Lanes operator-(Lanes a) { return Lanes(-a.native_); }
  THAWSLIDE_ALWAYS_INLINE Lanes& operator+=(Lanes a) { return *this = *this + a; }
  THAWSLIDE_ALWAYS_INLINE Lanes& operator-=(Lanes a) { return *this = *this - a; }
  THAWSLIDE_ALWAYS_INLINE Lanes& operator*=(Lanes a) { return *this = *this * a; }
  THAWSLIDE_ALWAYS_INLINE Lanes& operator/=(Lanes a) { return *this = *this / a; }

  THAWSLIDE_ALWAYS_INLINE friend Mask operator<(Lanes a, Lanes b) { return Mask(a.native_ < b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator<=(Lanes a, Lanes b) { return Mask(a.native_ <= b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator>(Lanes a, Lanes b) { return Mask(a.native_ > b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator>=(Lanes a, Lanes b) { return Mask(a.native_ >= b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator==(Lanes a, Lanes b) { return Mask(a.native_ == b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator!=(Lanes a, Lanes b) { return Mask(a.native_ != b.native_); }

  // a where the mask says yes, b elsewhere.
  THAWSLIDE_ALWAYS_INLINE friend Lanes select(Mask mask, Lanes a, Lanes b) {
    return Lanes(mask.native() ? a.native_ : b.native_);
  }
  // function(number), lane by lane.
  template <class Function>
  THAWSLIDE_ALWAYS_INLINE friend Lanes each_lane(Lanes a, const Function& function) {
    return of([&](std::size_t lane) { return function(a.native_[lane]); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Lanes sqrt(Lanes a) {
    return each_lane(a, [](Real number) { return std::sqrt(number); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Lanes floor(Lanes a) {
    return each_lane(a, [](Real number) { return std::floor(number); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Lanes log(Lanes a) {
    return each_lane(a, [](Real number) { return std::log(number); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Lanes abs(Lanes a) { return select(a < Lanes(Real(0)), -a, a); }
  THAWSLIDE_ALWAYS_INLINE friend Lanes min(Lanes a, Lanes b) { return select(b < a, b, a); }
  THAWSLIDE_ALWAYS_INLINE friend Lanes max(Lanes a, Lanes b) { return select(a < b, b, a); }

 private:
  Native native_;
};

// The type of a number, or of one lane.
template <class Value>
struct NumberOf {
  using Type = Value;
};
template <class Real>
struct NumberOf<Lanes<Real>> {
  using Type = Real;
};

// The same words for one number.
template <class Value>
THAWSLIDE_ALWAYS_INLINE Value select(bool condition, const Value& a, const Value& b) {
  return condition ? a : b;
}
template <class Real, class Function, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_ALWAYS_INLINE Real each_lane(Real number, const Function& function) {
  return function(number);
}
THAWSLIDE_ALWAYS_INLINE bool any(bool condition) { return condition; }

// Calls body(k) for the lanes k of a mask.
template <class Real, class Body>
THAWSLIDE_ALWAYS_INLINE void for_each_lane(const LaneMask<Real>& mask, const Body& body) {
  for (std::size_t k = 0; any(mask) && k < lane_count<Real>; ++k) {
    if (mask[k]) {
      body(k);
    }
  }
}
template <class Body>
THAWSLIDE_ALWAYS_INLINE void for_each_lane(bool condition, const Body& body) {
  if (condition) {
    body(std::size_t{0});
  }
}

// The number in one lane.
template <class Real>
THAWSLIDE_ALWAYS_INLINE Real in_lane(const Lanes<Real>& lanes, std::size_t lane) {
  return lanes[lane];
}
template <class Real, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_ALWAYS_INLINE Real in_lane(Real number, std::size_t /*lane*/) {
  return number;
}
template <class Real>
THAWSLIDE_ALWAYS_INLINE void set_lane(Lanes<Real>& lanes, std::size_t lane, Real number) {
  lanes = Lanes<Real>::of([&](std::size_t k) { return k == lane ? number : lanes[k]; });
}
template <class Real, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_ALWAYS_INLINE void set_lane(Real& number, std::size_t /*lane*/, Real other) {
  number = other;
}

// function(number), number by number and out of line: where that is the rare way.
template <class Value, class Function>
[[gnu::noinline, gnu::cold]] Value rarely(Value x, const Function& function) {
  return each_lane(x, function);
}

// Lanes of `a` where bit Half of the lane is 0 and of `b` moved up by Half elsewhere; the rest of both likewise.
template <std::size_t Half, class Real, std::size_t... K>
THAWSLIDE_ALWAYS_INLINE void exchange(Lanes<Real>& a, Lanes<Real>& b, std::index_sequence<K...> /*lanes*/) {
  constexpr std::size_t count = sizeof...(K);
  const auto kept = __builtin_shufflevector(a.native(), b.native(), ((K & Half) == 0 ? K : count + (K ^ Half))...);
  const auto moved = __builtin_shufflevector(a.native(), b.native(), ((K & Half) == 0 ? (K | Half) : count + K)...);
  a = Lanes<Real>(kept);
  b = Lanes<Real>(moved);
}

// Rows become columns: lane j of rows[k] is lane k of the former rows[j]. As many rows as lanes.
template <std::size_t Half, class Real>
THAWSLIDE_ALWAYS_INLINE void transpose_blocks(Lanes<Real>* rows) {
  constexpr std::size_t count = lane_count<Real>;
  unrolled<count>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    if constexpr ((k & Half) == 0) {
      exchange<Half>(rows[k], rows[k | Half], std::make_index_sequence<count>());
    }
  });
  if constexpr (Half > 1) {
    transpose_blocks<Half / 2>(rows);
  }
}
template <class Real>
THAWSLIDE_ALWAYS_INLINE void transpose(Lanes<Real>* rows) {
  transpose_blocks<lane_count<Real> / 2>(rows);
}

}  // namespace thawslide

// Vectors and matrices of lanes.
template <class Number>
struct Eigen::NumTraits<thawslide::Lanes<Number>> : Eigen::GenericNumTraits<thawslide::Lanes<Number>> {
  using Real = thawslide::Lanes<Number>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum {  // NOLINTBEGIN(readability-identifier-naming): Eigen's names
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };  // NOLINTEND(readability-identifier-naming)
};
