// Width b(x) of a 2D section relative to the reference width, per metre of which results are given: linear between
// places, constant beyond the ends. Volumes and masses of particles, areas of the ground and forces are those of the
// section divided by the reference width. Smooth vertical walls bound the section, like planes of constant angle in
// axial symmetry, where b is 2 pi r:
//   strain rate across   D_zz = u_x b'/b
//   force of the walls   -V sigma_zz b'/b along x       (with Eq. 12)
#pragma once

#include <cstddef>
#include <vector>

#include "base/select.hpp"
#include "base/table.hpp"
#include "mpm/kernel.hpp"

namespace thawslide::mpm {

// The width in the memory of an executor. For host and device.
struct WidthView {
  const double* place = nullptr;     // x from the origin of positions [m], strictly increasing
  const double* relative = nullptr;  // width over the reference width
  std::size_t count = 0;             // 0: uniform

  [[nodiscard]] THAWSLIDE_HD bool varies() const { return count > 0; }
  // Relative width: b over the reference width.
  [[nodiscard]] THAWSLIDE_HD double at(double x) const {
    const std::size_t k = after(x);
    return k == 0 ? 1.0 : k == count ? relative[count - 1] : relative[k - 1] + slope(k) * (x - place[k - 1]);
  }
  // b'/b [1/m].
  [[nodiscard]] THAWSLIDE_HD double widening(double x) const {
    const std::size_t k = after(x);
    return k == 0 || k == count ? 0.0 : slope(k) / at(x);
  }

 private:
  // Index of the first place beyond x.
  [[nodiscard]] THAWSLIDE_HD std::size_t after(double x) const {
    std::size_t first = 0, last = count;
    while (first < last) {
      const std::size_t middle = first + (last - first) / 2;
      if (place[middle] > x) {
        last = middle;
      } else {
        first = middle + 1;
      }
    }
    return first;
  }
  [[nodiscard]] THAWSLIDE_HD double slope(std::size_t k) const {
    return (relative[k] - relative[k - 1]) / (place[k] - place[k - 1]);
  }
};

class SectionWidth {
 public:
  SectionWidth() = default;  // uniform
  // table: widths > 0 [m] over strictly increasing x [m]; results are per metre of the first width. origin: x of the
  // origin of positions [m].
  SectionWidth(const Table& table, double origin) {
    for (std::size_t k = 0; k < table.abscissa.size(); ++k) {
      places_.push_back(table.abscissa[k] - origin);
      relative_.push_back(table.value[k] / table.value.front());
    }
  }

  [[nodiscard]] const std::vector<double>& places() const { return places_; }
  [[nodiscard]] const std::vector<double>& relative() const { return relative_; }
  [[nodiscard]] WidthView view() const { return {places_.data(), relative_.data(), places_.size()}; }
  [[nodiscard]] bool varies() const { return view().varies(); }
  [[nodiscard]] double at(double x) const { return view().at(x); }

 private:
  std::vector<double> places_, relative_;
};

// Width for kernels; EvenWidth if uniform (mpm/kernel.hpp).
struct UnevenWidth {
  static constexpr bool varies = true;
  WidthView width;

  template <class Value>
  [[nodiscard]] THAWSLIDE_HD Value at(const Value& x) const {
    return map_lanes(x, [this](double one) { return width.at(one); });
  }
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD Value widening(const Value& x) const {
    return map_lanes(x, [this](double one) { return width.widening(one); });
  }
};

// Calls work(width) with the width for kernels; only 2D sections have one.
template <int Dim, class Work>
decltype(auto) with_width(const WidthView& width, const Work& work) {
  if constexpr (Dim == 2) {
    if (width.varies()) {
      return work(UnevenWidth{width});
    }
  }
  return work(EvenWidth{});
}

}  // namespace thawslide::mpm
