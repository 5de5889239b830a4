// Particles in device memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numeric>
#include <type_traits>
#include <vector>

#include "device/cell_kernels.hpp"
#include "exec/array.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// Reorders one field.
template <class T, int Components>
struct GatherField {
  mpm::FieldView<T, Components> from, to;
  const std::uint32_t* order;
  std::size_t count;  // entries beyond, in the last block, stay in place

  THAWSLIDE_HD void operator()(std::size_t k) const {
    for (int c = 0; c < Components; ++c) {
      to(k, c) = from(k < count ? order[k] : k, c);
    }
  }
};

// Inverse permutation: the new place of each particle after reordering.
struct StoreIndex {
  const std::uint32_t* order;
  std::uint32_t* index;

  THAWSLIDE_HD void operator()(std::size_t k) const { index[order[k]] = static_cast<std::uint32_t>(k); }
};
struct GatherIndex {
  const std::uint32_t* index;
  std::uint32_t* particles;

  THAWSLIDE_HD void operator()(std::size_t k) const { particles[k] = index[particles[k]]; }
};

template <class Backend, int Dim>
class Particles {
 public:
  using View = mpm::ParticleView<Dim>;

  // Copies particles from CPU memory. Fields that are absent there stay absent.
  Particles(Backend& backend, const View& from, std::size_t count) : backend_(backend), count_(count) {
    mpm::for_fields_of(view_, from, [&](auto& here, const auto& there) {
      here = {};
      if (there.is_kept()) {
        const std::size_t numbers = numbers_of(here);
        here.numbers = buffer_for(here, numbers);
        backend_.copy_in(here.numbers, there.numbers, numbers);
      }
    });
    list(from);
  }

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const View& view() const { return view_; }
  // By ascending id.
  [[nodiscard]] const std::uint32_t* by_id() const { return by_id_.data(); }

  // Copies all fields back to the same number of particles, in their original order.
  void copy_to(const View& to) {
    mpm::for_fields_of(view_, to, [&](const auto& here, const auto& there) {
      if (here.is_kept()) {
        backend_.copy_out(there.numbers, gathered(here, input_order_.data()).numbers, numbers_of(here));
      }
    });
  }

  // Moves the particle at order[k] to place k.
  void reorder(const std::uint32_t* order) {
    mpm::for_fields_of(view_, view_, [&](const auto& here, const auto& /*same*/) {
      if (here.is_kept()) {
        backend_.copy(here.numbers, gathered(here, order).numbers, numbers_of(here));
      }
    });
    index_.resize(count_);
    backend_.for_each(count_, StoreIndex{order, index_.data()});
    backend_.for_each(count_, GatherIndex{index_.data(), by_id_.data()});
    backend_.for_each(count_, GatherIndex{index_.data(), input_order_.data()});
  }

 private:
  template <class T, int Components>
  [[nodiscard]] std::size_t numbers_of(const mpm::FieldView<T, Components>& /*field*/) const {
    constexpr std::size_t block = mpm::particles_of_block;
    return (count_ + block - 1) / block * block * Components;
  }
  template <class T, int Components>
  T* buffer_for(const mpm::FieldView<T, Components>& /*field*/, std::size_t numbers) {
    fields_.emplace_back(backend_, numbers * sizeof(T));
    return reinterpret_cast<T*>(fields_.back().data());
  }
  template <class T, int Components>
  [[nodiscard]] mpm::FieldView<T, Components> gathered(const mpm::FieldView<T, Components>& field,
                                                       const std::uint32_t* order) {
    gathered_.resize(numbers_of(field) * sizeof(T));
    const mpm::FieldView<T, Components> to{reinterpret_cast<T*>(gathered_.data())};
    backend_.for_each(numbers_of(field) / Components, GatherField<T, Components>{field, to, order, count_});
    return to;
  }

  void list(const View& from) {
    std::vector<std::uint32_t> indices(count_);
    std::iota(indices.begin(), indices.end(), 0u);
    input_order_.set(indices);
    std::sort(indices.begin(), indices.end(),
              [&](std::uint32_t p, std::uint32_t q) { return from.id(p) < from.id(q); });
    by_id_.set(indices);
  }

  Backend& backend_;
  std::size_t count_;
  View view_{};
  std::vector<exec::Array<std::byte, Backend>> fields_;  // fields that are present, in order
  exec::Array<std::byte, Backend> gathered_{backend_};
  exec::Array<std::uint32_t, Backend> by_id_{backend_}, input_order_{backend_}, index_{backend_};
};

}  // namespace thawslide::device
