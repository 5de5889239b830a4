// SIMD numbers: lane k belongs to the k-th particle of a batch. A formula over a number type with the functions of
// base/select.hpp works for one number and for lanes. CPU only: nvcc does not accept the vector types of g++.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide {

// Vector register types of a real type.
template <class T, std::size_t Count>
struct LaneRegister {
  using Flag = std::conditional_t<sizeof(T) == sizeof(std::int64_t), std::int64_t, std::int32_t>;
  using Numbers [[gnu::vector_size(Count * sizeof(T))]] = T;
  // may alias single numbers in memory
  using Stored [[gnu::vector_size(Count * sizeof(T)), gnu::may_alias]] = T;
  using Flags [[gnu::vector_size(Count * sizeof(T))]] = Flag;  // results of comparisons
  using Whole [[gnu::vector_size(Count * sizeof(std::int32_t))]] = std::int32_t;
};

// Lanes of the widest register of the CPU, at most eight: the block size of fields.
#ifdef __AVX512F__
inline constexpr std::size_t register_bytes = 64;
#else
inline constexpr std::size_t register_bytes = 32;
#endif
template <class T>
inline constexpr std::size_t simd_width = std::min<std::size_t>(register_bytes / sizeof(T), 8);

// Consecutive integers in memory.
template <class T, std::size_t Count = simd_width<T>, class Number>
THAWSLIDE_ALWAYS_INLINE typename LaneRegister<T, Count>::Whole whole_lanes(const Number* numbers) {
  static_assert(sizeof(Number) == sizeof(std::int32_t));
  typename LaneRegister<T, Count>::Whole whole;
  std::memcpy(&whole, numbers, sizeof whole);
  return whole;
}

// One boolean per lane.
template <class T, std::size_t Count = simd_width<T>>
class SimdMask {
 public:
  using Native = typename LaneRegister<T, Count>::Flags;

  SimdMask() = default;
  THAWSLIDE_ALWAYS_INLINE explicit SimdMask(Native native) : native_(native) {}

  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE bool operator[](std::size_t lane) const { return native_[lane] != 0; }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Native native() const { return native_; }

  THAWSLIDE_ALWAYS_INLINE friend SimdMask operator&(SimdMask a, SimdMask b) { return SimdMask(a.native_ & b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend SimdMask operator|(SimdMask a, SimdMask b) { return SimdMask(a.native_ | b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend SimdMask operator!(SimdMask a) { return SimdMask(~a.native_); }
  THAWSLIDE_ALWAYS_INLINE friend bool any(SimdMask a) {
#ifdef __AVX512F__
    if constexpr (sizeof(Native) == 64) {
      return _mm512_test_epi64_mask(__m512i(a.native_), __m512i(a.native_)) != 0;
    }
#endif
#ifdef __AVX__
    if constexpr (sizeof(Native) == 32) {
      using Bits = long long __attribute__((vector_size(32)));
      return __builtin_ia32_ptestz256(Bits(a.native_), Bits(a.native_)) == 0;
    }
#endif
    typename LaneRegister<T, Count>::Flag flags = 0;
    for (std::size_t k = 0; k < Count; ++k) {
      flags |= a.native_[k];
    }
    return flags != 0;
  }

 private:
  Native native_;
};

template <class T, std::size_t Count = simd_width<T>>
class Simd {
 public:
  static constexpr std::size_t count = Count;
  using Native = typename LaneRegister<T, Count>::Numbers;
  using Mask = SimdMask<T, Count>;
  using Whole = typename LaneRegister<T, Count>::Whole;

  Simd() = default;
  // Broadcasts a number to all lanes.
  THAWSLIDE_ALWAYS_INLINE Simd(T number) : native_(number - Native{}) {}
  THAWSLIDE_ALWAYS_INLINE explicit Simd(Native native) : native_(native) {}

  // Loads and stores `count` consecutive numbers, aligned to their size.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Simd load(const T* numbers) {
    return Simd(Native(*reinterpret_cast<const typename LaneRegister<T, Count>::Stored*>(numbers)));
  }
  THAWSLIDE_ALWAYS_INLINE void store(T* numbers) const {
    *reinterpret_cast<typename LaneRegister<T, Count>::Stored*>(numbers) = native_;
  }

  // Loads and stores `count` consecutive numbers of any alignment.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Simd load_unaligned(const T* numbers) {
    Native native;
    std::memcpy(&native, numbers, sizeof native);
    return Simd(native);
  }
  THAWSLIDE_ALWAYS_INLINE void store_unaligned(T* numbers) const { std::memcpy(numbers, &native_, sizeof native_); }

  // Loads and stores `count` consecutive integers, with conversion.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Simd load_whole(const std::int32_t* numbers) {
    return Simd(__builtin_convertvector(whole_lanes<T, Count>(numbers), Native));
  }
  THAWSLIDE_ALWAYS_INLINE void store_whole(std::int32_t* numbers) const {
    const Whole numbers_of_lanes = whole();
    std::memcpy(numbers, &numbers_of_lanes, sizeof numbers_of_lanes);
  }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Whole whole() const { return __builtin_convertvector(native_, Whole); }

  // Lane k is number(k).
  template <class Number>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Simd of(const Number& number) {
    return [&]<std::size_t... K>(std::index_sequence<K...>) THAWSLIDE_INLINE_LAMBDA {
      return Simd(Native{static_cast<T>(number(K))...});
    }
    (std::make_index_sequence<Count>());
  }

  // Lane k is numbers[places[k]].
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE static Simd gather(const T* numbers, Whole indices) {
#ifdef __AVX512F__
    if constexpr (sizeof(Native) == 64) {
      return Simd(Native(
          _mm512_mask_i32gather_pd(_mm512_setzero_pd(), 0xff, reinterpret_cast<__m256i>(indices), numbers, sizeof(T))));
    }
#endif
    return of([&](std::size_t lane) { return numbers[indices[lane]]; });
  }
  // Inverse of gather for the lanes 0 .. lanes-1.
  THAWSLIDE_ALWAYS_INLINE void scatter(T* numbers, Whole indices, std::size_t lanes) const {
#ifdef __AVX512F__
    if constexpr (sizeof(Native) == 64) {
      const auto mask = static_cast<__mmask8>((1u << lanes) - 1u);
      _mm512_mask_i32scatter_pd(numbers, mask, reinterpret_cast<__m256i>(indices), __m512d(native_), sizeof(T));
      return;
    }
#endif
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      numbers[indices[lane]] = native_[lane];
    }
  }

  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE T operator[](std::size_t lane) const { return native_[lane]; }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Native native() const { return native_; }

  THAWSLIDE_ALWAYS_INLINE friend Simd operator+(Simd a, Simd b) { return Simd(a.native_ + b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Simd operator-(Simd a, Simd b) { return Simd(a.native_ - b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Simd operator*(Simd a, Simd b) { return Simd(a.native_ * b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Simd operator/(Simd a, Simd b) { return Simd(a.native_ / b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Simd operator-(Simd a) { return Simd(-a.native_); }
  THAWSLIDE_ALWAYS_INLINE Simd& operator+=(Simd a) { return *this = *this + a; }
  THAWSLIDE_ALWAYS_INLINE Simd& operator-=(Simd a) { return *this = *this - a; }
  THAWSLIDE_ALWAYS_INLINE Simd& operator*=(Simd a) { return *this = *this * a; }
  THAWSLIDE_ALWAYS_INLINE Simd& operator/=(Simd a) { return *this = *this / a; }

  THAWSLIDE_ALWAYS_INLINE friend Mask operator<(Simd a, Simd b) { return Mask(a.native_ < b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator<=(Simd a, Simd b) { return Mask(a.native_ <= b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator>(Simd a, Simd b) { return Mask(a.native_ > b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator>=(Simd a, Simd b) { return Mask(a.native_ >= b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator==(Simd a, Simd b) { return Mask(a.native_ == b.native_); }
  THAWSLIDE_ALWAYS_INLINE friend Mask operator!=(Simd a, Simd b) { return Mask(a.native_ != b.native_); }

  // a where the mask is true, b elsewhere.
  THAWSLIDE_ALWAYS_INLINE friend Simd select(Mask mask, Simd a, Simd b) {
    return Simd(mask.native() ? a.native_ : b.native_);
  }
  // function(number), by lane.
  template <class Function>
  THAWSLIDE_ALWAYS_INLINE friend Simd map_lanes(Simd a, const Function& function) {
    return of([&](std::size_t lane) { return function(a.native_[lane]); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Simd sqrt(Simd a) {
    return map_lanes(a, [](T number) { return std::sqrt(number); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Simd floor(Simd a) {
    return map_lanes(a, [](T number) { return std::floor(number); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Simd log(Simd a) {
    return map_lanes(a, [](T number) { return std::log(number); });
  }
  THAWSLIDE_ALWAYS_INLINE friend Simd abs(Simd a) { return select(a < Simd(T(0)), -a, a); }
  THAWSLIDE_ALWAYS_INLINE friend Simd min(Simd a, Simd b) { return select(b < a, b, a); }
  THAWSLIDE_ALWAYS_INLINE friend Simd max(Simd a, Simd b) { return select(a < b, b, a); }

 private:
  Native native_;
};

// True in the lanes 0 .. count-1.
template <class T>
THAWSLIDE_ALWAYS_INLINE SimdMask<T> lanes_before(std::size_t count) {
  return Simd<T>::of([](std::size_t lane) { return lane; }) < Simd<T>(static_cast<T>(count));
}

// Calls body(k) for the lanes k of a mask.
template <class T, class Body>
THAWSLIDE_ALWAYS_INLINE void for_each_lane(const SimdMask<T>& mask, const Body& body) {
  for (std::size_t k = 0; any(mask) && k < simd_width<T>; ++k) {
    if (mask[k]) {
      body(k);
    }
  }
}

// Number in one lane.
template <class T>
THAWSLIDE_ALWAYS_INLINE T extract(const Simd<T>& lanes, std::size_t lane) {
  return lanes[lane];
}

// Exchanges blocks between a and b: lanes whose bit Half is 1 in `a` with those whose bit Half is 0 in `b`.
template <std::size_t Half, class T, std::size_t Count, std::size_t... K>
THAWSLIDE_ALWAYS_INLINE void exchange(Simd<T, Count>& a, Simd<T, Count>& b, std::index_sequence<K...> /*lanes*/) {
  const auto kept = __builtin_shufflevector(a.native(), b.native(), ((K & Half) == 0 ? K : Count + (K ^ Half))...);
  const auto moved = __builtin_shufflevector(a.native(), b.native(), ((K & Half) == 0 ? (K | Half) : Count + K)...);
  a = Simd<T, Count>(kept);
  b = Simd<T, Count>(moved);
}

// Transposes rows and columns: lane j of rows[k] is lane k of the former rows[j]. As many rows as lanes.
template <std::size_t Half, class T, std::size_t Count>
THAWSLIDE_ALWAYS_INLINE void transpose_blocks(Simd<T, Count>* rows) {
  unrolled<Count>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    if constexpr ((k & Half) == 0) {
      exchange<Half>(rows[k], rows[k | Half], std::make_index_sequence<Count>());
    }
  });
  if constexpr (Half > 1) {
    transpose_blocks<Half / 2>(rows);
  }
}
template <class T, std::size_t Count>
THAWSLIDE_ALWAYS_INLINE void transpose(Simd<T, Count>* rows) {
  transpose_blocks<Count / 2>(rows);
}

// Lanes First, First + 1, ... of a register; concatenation of two registers.
template <std::size_t First, class T, std::size_t Count, std::size_t... K>
THAWSLIDE_ALWAYS_INLINE Simd<T, sizeof...(K)> part_of(const Simd<T, Count>& whole,
                                                      std::index_sequence<K...> /*lanes*/) {
  return Simd<T, sizeof...(K)>(__builtin_shufflevector(whole.native(), whole.native(), (First + K)...));
}
template <class T, std::size_t Count, std::size_t... K>
THAWSLIDE_ALWAYS_INLINE Simd<T, sizeof...(K)> joined(const Simd<T, Count>& a, const Simd<T, Count>& b,
                                                     std::index_sequence<K...> /*lanes*/) {
  return Simd<T, sizeof...(K)>(__builtin_shufflevector(a.native(), b.native(), K...));
}

template <class T>
THAWSLIDE_ALWAYS_INLINE Simd<T> look_up(const T* table, const Simd<T>& index) {
  return Simd<T>::gather(table, index.whole());
}

// Minimum over all lanes.
template <class T, std::size_t Count>
THAWSLIDE_ALWAYS_INLINE T smallest(const Simd<T, Count>& lanes) {
  if constexpr (Count == 2) {
    return std::min(lanes[0], lanes[1]);
  } else {
    constexpr auto half = std::make_index_sequence<Count / 2>();
    return smallest(min(part_of<0>(lanes, half), part_of<Count / 2>(lanes, half)));
  }
}

// Converts `Width` quantities, with one particle per lane, to one row of `Width` numbers per particle.
template <class T, std::size_t Width>
THAWSLIDE_ALWAYS_INLINE void transpose_to_rows(const Simd<T>* quantities, Simd<T, Width>* rows) {
  constexpr std::size_t parts = simd_width<T> / Width;
  static_assert(parts * Width == simd_width<T>);
  unrolled<parts>([&](auto part) THAWSLIDE_INLINE_LAMBDA {
    constexpr std::size_t first = part() * Width;
    unrolled<Width>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      rows[first + k] = part_of<first>(quantities[k], std::make_index_sequence<Width>());
    });
    transpose(rows + first);
  });
}

// Inverse conversion; overwrites `rows`.
template <class T, std::size_t Width>
THAWSLIDE_ALWAYS_INLINE void transpose_to_columns(Simd<T, Width>* rows, Simd<T>* quantities) {
  constexpr std::size_t parts = simd_width<T> / Width;
  static_assert(parts * Width == simd_width<T> && parts <= 2);
  unrolled<parts>([&](auto part) THAWSLIDE_INLINE_LAMBDA { transpose(rows + part * Width); });
  unrolled<Width>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    if constexpr (parts == 1) {
      quantities[k] = rows[k];
    } else {
      quantities[k] = joined(rows[k], rows[Width + k], std::make_index_sequence<2 * Width>());
    }
  });
}

}  // namespace thawslide

// Vectors and matrices of lanes.
template <class Number>
struct Eigen::NumTraits<thawslide::Simd<Number>> : Eigen::GenericNumTraits<thawslide::Simd<Number>> {
  using Real = thawslide::Simd<Number>;
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
