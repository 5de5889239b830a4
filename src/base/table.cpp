#include "base/table.hpp"

#include <algorithm>
#include <cstddef>

#include "base/error.hpp"

namespace thawslide {

double Table::at(double x) const {
  THAWSLIDE_ASSERT(!value.empty(), "a table without values was asked for its value at {}", x);
  if (is_constant() || x < abscissa.front()) {
    return value.front();
  }
  const auto after = std::upper_bound(abscissa.begin(), abscissa.end(), x);
  if (after == abscissa.end()) {
    return value.back();
  }
  const auto k = static_cast<std::size_t>(after - abscissa.begin());
  const double t = (x - abscissa[k - 1]) / (abscissa[k] - abscissa[k - 1]);
  return value[k - 1] + t * (value[k] - value[k - 1]);
}

double BandThickness::smallest() const {
  return is_given() ? *std::min_element(table.value.begin(), table.value.end()) : 0.0;
}

double BandThickness::largest() const {
  return is_given() ? *std::max_element(table.value.begin(), table.value.end()) : 0.0;
}

double InitialField::at(double depth, double x) const {
  switch (over) {
    case Over::depth:
      return table.at(depth);
    case Over::x:
      return table.at(x);
    case Over::attribute:
    case Over::raster:
      break;
    case Over::nothing:
      return table.at(0.0);
  }
  THAWSLIDE_ASSERT(false, "the field of the map '{}' was asked for its value at a depth of {}", source, depth);
  return 0.0;
}

}  // namespace thawslide
