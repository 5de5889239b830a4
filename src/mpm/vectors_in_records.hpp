// Vectors in nodal records. They are loaded and stored as a whole: assembling a vector from components in memory stalls
// its next use.
#pragma once

#include <cstddef>

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::mpm {

template <int Dim>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<double, Dim> vector_at(const double* record, std::size_t first) {
  return Eigen::Map<const Vector<double, Dim>>(record + first);
}
template <int Dim, class Record>
requires requires(const Record& record) { record.data(); }
THAWSLIDE_ALWAYS_INLINE Vector<double, Dim> vector_at(const Record& record, std::size_t first) {
  return vector_at<Dim>(record.data(), first);
}

template <int Dim, class Record, class Value>
THAWSLIDE_HD void set_vector(Record& record, std::size_t first, const Value& v) {
  for (std::size_t a = 0; a < Dim; ++a) {
    record[first + a] = v[static_cast<int>(a)];
  }
}

}  // namespace thawslide::mpm
