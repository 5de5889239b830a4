// What a function has at columns, remembered: tiles change in nearly every step.
#pragma once

#include <functional>
#include <vector>

#include "band/columns.hpp"
#include "base/key_index.hpp"

namespace thawslide::band {

// Of a horizontal place [m].
template <int Dim, class Real>
using OfPlace = std::function<Real(const Vector<Real, Dim - 1>&)>;

template <int Dim, class Real>
class AtColumns {
 public:
  // At the middle of a column; `of` must be the same in every call.
  [[nodiscard]] Real at(std::uint64_t key, Real cell, const OfPlace<Dim, Real>& of) {
    const auto k = static_cast<std::size_t>(index_.insert(key));
    if (k == values_.size()) {
      values_.push_back(of(middle_of_column<Dim, Real>(key, cell)));
    }
    return values_[k];
  }

  // Begun anew when the slide has left most of the columns.
  void forget_if_many(std::size_t columns) {
    constexpr std::size_t held_per_column = 4;
    if (values_.size() > held_per_column * columns) {
      index_.clear();
      values_.clear();
    }
  }

 private:
  KeyIndex index_;  // column key -> place in values_
  std::vector<Real> values_;
};

}  // namespace thawslide::band
