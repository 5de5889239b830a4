// Particle field, declared once with name, unit, shape and output flags. Reordering, snapshots and checkpoints iterate
// over the fields in FieldList.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "base/aligned.hpp"
#include "base/error.hpp"
#include "base/linear.hpp"
#include "base/parallel.hpp"
#include "base/portability.hpp"
#include "mpm/field_view.hpp"
#include "mpm/simd_batch.hpp"

namespace thawslide::mpm {

// tensor: symmetric, order xx yy zz xy [yz xz]; matrix: by columns, never in a snapshot
enum class FieldShape { scalar, vector, tensor, matrix };

struct FieldInfo {
  const char* name;
  const char* unit;
  FieldShape shape = FieldShape::scalar;
  const char* meaning = nullptr;  // for the reference of snapshots; null: the field is not in snapshots
  bool in_checkpoint = true;
  bool snapshots_need_it_stored = false;  // snapshots omit the field if it is not stored; otherwise it is 0 there

  [[nodiscard]] bool in_snapshot() const { return meaning != nullptr; }
};

class FieldBase {
 public:
  explicit FieldBase(const FieldInfo& info) : info_(info) {}
  virtual ~FieldBase() = default;
  FieldBase(const FieldBase&) = delete;
  FieldBase& operator=(const FieldBase&) = delete;

  [[nodiscard]] const FieldInfo& info() const { return info_; }
  [[nodiscard]] virtual std::size_t components() const = 0;
  [[nodiscard]] virtual bool is_integer() const = 0;
  // Appends the first `components` components (0 beyond those of the field) of particles order[0], order[1], ...,
  // particle by particle.
  virtual void append_values(const std::vector<std::size_t>& order, std::size_t components,
                             std::vector<double>& to) const = 0;
  virtual void resize(std::size_t particles) = 0;
  // Changes the number of particles: existing values are kept, new particles have 0.
  virtual void set_size(std::size_t particles) = 0;
  // Copies the particle at `from` to `to`.
  virtual void copy(std::size_t from, std::size_t to) = 0;
  // Moves the particle at order[k] to place k, for all k of `order`.
  virtual void reorder(const std::vector<std::uint32_t>& order, ReorderBuffer& buffer) = 0;
  // Memory in blocks of particles_of_block particles, component by component (index_in_field); null if not stored.
  [[nodiscard]] virtual const void* memory() const = 0;
  [[nodiscard]] virtual std::size_t number_bytes() const = 0;
  [[nodiscard]] virtual std::vector<std::byte> bytes() const = 0;
  virtual void set_bytes(const std::vector<std::byte>& bytes) = 0;
  // Selects whether the field is stored, from the next resize on. A field that is not stored must not be accessed;
  // FieldList reads it as 0.
  void keep(bool kept) { kept_ = kept; }
  [[nodiscard]] bool is_kept() const { return kept_; }
  [[nodiscard]] bool is_in_snapshots() const {
    return info_.in_snapshot() && (kept_ || !info_.snapshots_need_it_stored);
  }

 protected:
  bool kept_ = true;

 private:
  FieldInfo info_;
};

// All fields of a set of particles, in order of declaration.
class FieldList {
 public:
  void add(FieldBase* field) { fields_.push_back(field); }
  [[nodiscard]] const std::vector<FieldBase*>& all() const { return fields_; }

 private:
  std::vector<FieldBase*> fields_;
};

template <class T, int Components>
class Field final : public FieldBase {
 public:
  static constexpr std::size_t lanes = particles_of_block;
  // Loading a batch prefetches the block this many blocks ahead, which a loop reads some batches later.
  static constexpr std::size_t prefetched_blocks = 4;
  // range of the indices in places()
  static constexpr std::size_t most_numbers = std::numeric_limits<std::int32_t>::max();
  static_assert(lanes % simd_width<double> == 0 && lanes % simd_width<float> == 0);

  Field(FieldList& list, const FieldInfo& info) : FieldBase(info) { list.add(this); }

  [[nodiscard]] T& operator()(std::size_t particle, int component = 0) { return data_[position(particle, component)]; }
  [[nodiscard]] const T& operator()(std::size_t particle, int component = 0) const {
    return data_[position(particle, component)];
  }

  // View for kernels on a device. Valid until the number of particles changes.
  [[nodiscard]] FieldView<T, Components> view() { return {kept_ ? data_.data() : nullptr}; }

  // The first components, as many as the vector has.
  template <class Vector>
  [[nodiscard]] Vector get(std::size_t particle) const {
    static_assert(Vector::SizeAtCompileTime <= Components);
    Vector v;
    for (int c = 0; c < Vector::SizeAtCompileTime; ++c) {
      v[c] = (*this)(particle, c);
    }
    return v;
  }
  template <class Vector>
  void set(std::size_t particle, const Vector& v) {
    for (int c = 0; c < Components; ++c) {
      (*this)(particle, c) = v[c];
    }
  }

  // Values of a batch, by lane.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Simd<T> load(const SimdBatch& batch, int component = 0) const {
    if (batch.contiguous) {
      const T* numbers = &(*this)(batch.particle[0], component);
      prefetch(numbers, prefetched_blocks * lanes * Components * sizeof(T));
      return Simd<T>::load(numbers);
    }
    return Simd<T>::gather(&data_[position(0, component)], positions(batch));
  }
  THAWSLIDE_ALWAYS_INLINE void store(const SimdBatch& batch, const Simd<T>& values, int component = 0) {
    if (batch.contiguous) {
      values.store(&(*this)(batch.particle[0], component));
      return;
    }
    values.scatter(&data_[position(0, component)], positions(batch), batch.count);
  }
  // Value of one particle.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE T load(const ScalarIndex& one, int component = 0) const {
    return (*this)(one.particle[0], component);
  }
  THAWSLIDE_ALWAYS_INLINE void store(const ScalarIndex& one, T value, int component = 0) {
    (*this)(one.particle[0], component) = value;
  }
  // Integers, converted from and to a real type.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE double load_whole(const ScalarIndex& one) const {
    return static_cast<double>((*this)(one.particle[0]));
  }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Simd<double> load_whole(const SimdBatch& batch) const {
    if (batch.contiguous) {
      return Simd<double>::load_whole(&(*this)(batch.particle[0]));
    }
    return Simd<double>::of([&](std::size_t lane) { return (*this)(batch.particle[lane]); });
  }
  THAWSLIDE_ALWAYS_INLINE void store_whole(const ScalarIndex& one, double value) {
    (*this)(one.particle[0]) = static_cast<T>(value);
  }
  THAWSLIDE_ALWAYS_INLINE void store_whole(const SimdBatch& batch, const Simd<double>& values) {
    if (batch.contiguous) {
      values.store_whole(&(*this)(batch.particle[0]));
      return;
    }
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      (*this)(batch.particle[lane]) = static_cast<T>(values[lane]);
    }
  }
  // All components of vectors and tensors.
  template <int Size, class At>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Vector<typename At::Value, Size> load_vector(const At& at) const {
    Vector<typename At::Value, Size> v;
    unrolled<static_cast<std::size_t>(Size)>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      constexpr int c = static_cast<int>(k());
      v[c] = c < Components ? load(at, c) : typename At::Value(T(0));
    });
    return v;
  }
  template <class At, class Values>
  THAWSLIDE_ALWAYS_INLINE void store_vector(const At& at, const Values& values) {
    unrolled<static_cast<std::size_t>(Components)>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      constexpr int c = static_cast<int>(k());
      store(at, values[c], c);
    });
  }

  [[nodiscard]] std::size_t components() const override { return static_cast<std::size_t>(Components); }
  [[nodiscard]] bool is_integer() const override { return std::is_integral_v<T>; }
  void append_values(const std::vector<std::size_t>& order, std::size_t components,
                     std::vector<double>& to) const override {
    to.reserve(to.size() + order.size() * components);
    for (const std::size_t particle : order) {
      for (std::size_t c = 0; c < components; ++c) {
        const bool known = kept_ && c < static_cast<std::size_t>(Components);
        to.push_back(known ? static_cast<double>((*this)(particle, static_cast<int>(c))) : 0.0);
      }
    }
  }

  void resize(std::size_t particles) override {
    expect_capacity(particles);
    particles_ = particles;
    data_.assign(kept_ ? (particles + lanes - 1) / lanes * lanes * Components : 0, T{});
    data_.shrink_to_fit();
  }

  // Clears all entries from the first new particle to the end of its block, because whole blocks are copied back from a
  // device.
  void set_size(std::size_t particles) override {
    expect_capacity(particles);
    const std::size_t known = std::min(particles_, particles);
    particles_ = particles;
    if (kept_) {
      data_.resize((particles + lanes - 1) / lanes * lanes * Components, T{});
      for (std::size_t p = known; p < data_.size() / Components; ++p) {
        set(p, Vector<T, Components>(Vector<T, Components>::Zero()));
      }
    }
  }

  void copy(std::size_t from, std::size_t to) override {
    for (int c = 0; kept_ && c < Components; ++c) {
      (*this)(to, c) = (*this)(from, c);
    }
  }

  void reorder(const std::vector<std::uint32_t>& order, ReorderBuffer& buffer) override {
    for (int c = 0; kept_ && c < Components; ++c) {
      thawslide::reorder<T>(
          order, buffer, [&](std::size_t k) { return (*this)(k, c); },
          [&](std::size_t k, T number) { (*this)(k, c) = number; });
    }
  }

  [[nodiscard]] const void* memory() const override { return kept_ ? data_.data() : nullptr; }
  [[nodiscard]] std::size_t number_bytes() const override { return sizeof(T); }
  [[nodiscard]] std::vector<std::byte> bytes() const override {
    std::vector<std::byte> all(particles_ * Components * sizeof(T));
    for (std::size_t k = 0; kept_ && k < particles_; ++k) {
      for (int c = 0; c < Components; ++c) {
        std::memcpy(&all[(k * Components + static_cast<std::size_t>(c)) * sizeof(T)], &(*this)(k, c), sizeof(T));
      }
    }
    return all;
  }
  void set_bytes(const std::vector<std::byte>& all) override {
    THAWSLIDE_ASSERT(all.size() == particles_ * Components * sizeof(T), "field {}: {} bytes for {} particles",
                     info().name, all.size(), particles_);
    for (std::size_t k = 0; kept_ && k < particles_; ++k) {
      for (int c = 0; c < Components; ++c) {
        std::memcpy(&(*this)(k, c), &all[(k * Components + static_cast<std::size_t>(c)) * sizeof(T)], sizeof(T));
      }
    }
  }

 private:
  void expect_capacity(std::size_t particles) const {
    THAWSLIDE_ASSERT(particles <= most_numbers / Components, "field {}: {} particles of {} numbers are too many",
                     info().name, particles, Components);
  }
  static std::size_t position(std::size_t particle, int component) {
    return index_in_field<Components>(particle, component);
  }
  // position(particle, 0), by lane.
  THAWSLIDE_ALWAYS_INLINE static typename Simd<T>::Whole positions(const SimdBatch& batch) {
    constexpr auto within = static_cast<std::int32_t>(lanes) - 1;
    const auto particle = whole_lanes<T>(batch.particle.data());
    return particle + (particle & ~within) * (Components - 1);
  }

  std::size_t particles_ = 0;
  AlignedVector<T> data_;
};

}  // namespace thawslide::mpm
