// Material points: all particle fields (mpm/particle_fields.hpp).
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "base/linear.hpp"
#include "mpm/field.hpp"
#include "mpm/particle_fields.hpp"

namespace thawslide::mpm {

// Largest number of particles. Limit of index arithmetic: an affine velocity has nine numbers per particle.
inline constexpr double most_particles = 2.3e8;

template <int Dim>
class Particles {
 public:
  using Scalar = Field<double, 1>;

  FieldList fields;

#define THAWSLIDE_FIELD(Type, Components, name, ...) Field<Type, Components> name{fields, {#name, __VA_ARGS__}};
  THAWSLIDE_PARTICLE_FIELDS(THAWSLIDE_FIELD)
#undef THAWSLIDE_FIELD

  Particles() = default;
  Particles(const Particles&) = delete;
  Particles& operator=(const Particles&) = delete;

  [[nodiscard]] std::size_t size() const { return size_; }

  void resize(std::size_t particles) {
    size_ = particles;
    for (FieldBase* field : fields.all()) {
      field->resize(particles);
    }
  }

  static constexpr std::uint32_t nowhere = ~std::uint32_t{0};

  // Removes the marked particles; the last ones in memory fill their places. Returns the new place of each particle.
  std::vector<std::uint32_t> remove(const std::vector<std::uint8_t>& marked) {
    THAWSLIDE_ASSERT(marked.size() == size_, "{} marks for {} particles", marked.size(), size_);
    std::vector<std::uint32_t> now_at(size_);
    std::iota(now_at.begin(), now_at.end(), 0u);
    std::size_t end = size_;
    for (std::size_t p = 0; p < end; ++p) {
      while (end > p && marked[end - 1] != 0) {
        now_at[--end] = nowhere;
      }
      if (p < end && marked[p] != 0) {
        now_at[p] = nowhere;
        now_at[--end] = static_cast<std::uint32_t>(p);
        for (FieldBase* field : fields.all()) {
          field->copy(end, p);
        }
      }
    }
    set_size(end);
    return now_at;
  }

  // Appends particles with all values 0; returns the place of the first one. The caller must assign ids that were never
  // used in the run.
  std::size_t append(std::size_t count) {
    const std::size_t first = size_;
    set_size(size_ + count);
    return first;
  }

  void reorder(const std::vector<std::uint32_t>& order) {
    for (FieldBase* field : fields.all()) {
      field->reorder(order, reorder_buffer_);
    }
  }

 private:
  void set_size(std::size_t particles) {
    size_ = particles;
    for (FieldBase* field : fields.all()) {
      field->set_size(particles);
    }
  }

  std::size_t size_ = 0;
  ReorderBuffer reorder_buffer_;  // persistent, to avoid allocation in each step
};

// Particle tensor as a full six-component tensor; plane strain has zz but no yz, xz.
template <int Dim>
SymmetricTensor<double> full_tensor(const Field<double, tensor_components<Dim>>& field, std::size_t particle) {
  SymmetricTensor<double> s = SymmetricTensor<double>::Zero();
  for (int c = 0; c < tensor_components<Dim>; ++c) {
    s[c] = field(particle, c);
  }
  return s;
}

}  // namespace thawslide::mpm
