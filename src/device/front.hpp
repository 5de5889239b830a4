// The front of the slide (mpm/front.hpp) among particles in a device's memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/ordered_bits.hpp"
#include "device/array.hpp"
#include "device/tile_tables.hpp"
#include "mpm/front.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// By rank in canonical order: how far the particle is, to be sorted, and which it is.
template <int Dim, class Real>
struct ListAlongWay {
  mpm::Way<Dim> way;
  mpm::ParticleView<Dim, Real> particles;
  const std::uint32_t* order;
  std::uint64_t* keys;

  THAWSLIDE_HD void operator()(std::size_t rank) const {
    keys[rank] = ordered_bits(way.of(particles, order[rank]).along);
  }
};

// The last ones of a list, the last one first.
template <int Dim, class Real>
struct TakeForemost {
  mpm::Way<Dim> way;
  mpm::ParticleView<Dim, Real> particles;
  const std::uint32_t* sorted;
  std::size_t count;
  mpm::OnWay* taken;

  THAWSLIDE_HD void operator()(std::size_t k) const { taken[k] = way.of(particles, sorted[count - 1 - k]); }
};

template <class Backend, int Dim, class Real>
class Front {
 public:
  explicit Front(Backend& backend) : backend_(backend) {}

  // Of so many particles, of some mass together [kg]; at least one. Of those equally far the one of the higher rank in
  // canonical order counts as further.
  mpm::OnWay find(const mpm::Way<Dim>& way, double mass, const TileTables<Dim>& tables,
                  const mpm::ParticleView<Dim, Real>& particles, std::size_t count) {
    const mpm::Way<Dim> here{copied(way.line), way.origin};
    Array<std::uint64_t, Backend> keys(backend_, count), sorted_keys(backend_, count);
    Array<std::uint32_t, Backend> sorted(backend_, count);
    backend_.for_each(count, ListAlongWay<Dim, Real>{here, particles, tables.order, keys.data()});
    backend_.sort(keys.data(), tables.order, sorted_keys.data(), sorted.data(), count);
    mpm::FrontSearch search(mass);
    std::size_t looked_at = 0;
    for (std::size_t take = std::min(count, first_look);; take = std::min(count, 2 * take)) {
      Array<mpm::OnWay, Backend> taken(backend_, take);
      backend_.for_each(take, TakeForemost<Dim, Real>{here, particles, sorted.data(), count, taken.data()});
      const std::vector<mpm::OnWay> foremost = taken.get();
      for (; looked_at < take; ++looked_at) {
        if (search.is_at(foremost[looked_at].mass) || looked_at + 1 == count) {
          return foremost[looked_at];
        }
      }
    }
  }

 private:
  static constexpr std::size_t first_look = 4096;  // particles

  LineView copied(const LineView& line) {
    if (line.segments == 0) {
      return {};
    }
    copy(corners_, line.corners, line.segments + 1);
    copy(along_, line.along, line.segments + 1);
    copy(directions_, line.directions, line.segments);
    copy(boxes_, line.boxes, line.boxes_count());
    return {corners_.data(), along_.data(), directions_.data(), boxes_.data(), line.segments};
  }
  template <class T>
  void copy(Array<T, Backend>& to, const T* from, std::size_t count) {
    to.resize(count);
    backend_.copy_in(to.data(), from, count);
  }

  Backend& backend_;
  Array<Place2, Backend> corners_{backend_}, directions_{backend_};
  Array<double, Backend> along_{backend_};
  Array<BoxOfLine, Backend> boxes_{backend_};
};

}  // namespace thawslide::device
