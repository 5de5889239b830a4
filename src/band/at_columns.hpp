// Cache of a function's values at columns, because tiles change in nearly every step.
#pragma once

#include <functional>
#include <vector>

#include "band/columns.hpp"
#include "base/key_index.hpp"

namespace thawslide::band {

// Function of a horizontal position [m].
template <int Dim>
using OfPosition = std::function<double(const Vector<double, Dim - 1>&)>;

template <int Dim>
class AtColumns {
 public:
  // Value at the middle of a column; `of` must be the same in every call.
  [[nodiscard]] double at(std::uint64_t key, double cell, const OfPosition<Dim>& of) {
    const auto k = static_cast<std::size_t>(index_.insert(key));
    if (k == values_.size()) {
      values_.push_back(of(middle_of_column<Dim>(key, cell)));
    }
    return values_[k];
  }

  // Clears the cache when the sliding mass has left most of its columns.
  void forget_if_many(std::size_t columns) {
    constexpr std::size_t stored_per_column = 4;
    if (values_.size() > stored_per_column * columns) {
      index_.clear();
      values_.clear();
    }
  }

 private:
  KeyIndex index_;  // column key -> index in values_
  std::vector<double> values_;
};

}  // namespace thawslide::band
