// Width b(x) of a 2D section relative to the reference width, per metre of which results are given: linear between
// places, constant beyond the ends. Volumes and masses of particles, areas of the ground and forces are those of the
// section divided by the reference width. Smooth vertical walls bound the section, like planes of constant angle in
// axial symmetry, where b is 2 pi r:
//   strain rate across   D_zz = u_x b'/b
//   force of the walls   -V sigma_zz b'/b along x       (with Eq. 12)
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/select.hpp"
#include "base/table.hpp"
#include "mpm/kernel.hpp"

namespace thawslide::mpm {

class SectionWidth {
 public:
  SectionWidth() = default;  // uniform
  // table: widths > 0 [m] over strictly increasing x [m]; results are per metre of the first width. origin: x of the
  // origin of positions [m].
  SectionWidth(const Table& table, double origin) {
    for (std::size_t k = 0; k < table.abscissa.size(); ++k) {
      index_.push_back(table.abscissa[k] - origin);
      relative_.push_back(table.value[k] / table.value.front());
    }
  }

  [[nodiscard]] bool varies() const { return !index_.empty(); }

  // Relative width: b over the reference width.
  [[nodiscard]] double at(double x) const {
    const std::size_t k = after(x);
    return k == 0 ? 1.0 : k == index_.size() ? relative_.back() : relative_[k - 1] + slope(k) * (x - index_[k - 1]);
  }
  // b'/b [1/m].
  [[nodiscard]] double widening(double x) const {
    const std::size_t k = after(x);
    return k == 0 || k == index_.size() ? 0.0 : slope(k) / at(x);
  }

 private:
  // Index of the first place beyond x.
  [[nodiscard]] std::size_t after(double x) const {
    return static_cast<std::size_t>(std::upper_bound(index_.begin(), index_.end(), x) - index_.begin());
  }
  [[nodiscard]] double slope(std::size_t k) const {
    return (relative_[k] - relative_[k - 1]) / (index_[k] - index_[k - 1]);
  }

  std::vector<double> index_, relative_;
};

// Width for kernels; EvenWidth if uniform (mpm/kernel.hpp).
struct UnevenWidth {
  static constexpr bool varies = true;
  const SectionWidth& width;

  template <class Value>
  [[nodiscard]] Value at(const Value& x) const {
    return map_lanes(x, [&](double one) { return width.at(one); });
  }
  template <class Value>
  [[nodiscard]] Value widening(const Value& x) const {
    return map_lanes(x, [&](double one) { return width.widening(one); });
  }
};

// Calls work(width) with the width for kernels; only 2D sections have one.
template <int Dim, class Work>
decltype(auto) with_width(const SectionWidth& width, const Work& work) {
  if constexpr (Dim == 2) {
    if (width.varies()) {
      return work(UnevenWidth{width});
    }
  }
  return work(EvenWidth{});
}

}  // namespace thawslide::mpm
