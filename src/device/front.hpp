// Front of the sliding mass (mpm/front.hpp) from particles in device memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/error.hpp"
#include "base/ordered_bits.hpp"
#include "device/tile_tables.hpp"
#include "exec/array.hpp"
#include "mpm/front.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// Sort key of each particle, by rank in canonical order: its distance along the path.
template <int Dim>
struct ListAlongPath {
  mpm::Transformation<Dim> path;
  mpm::ParticleView<Dim> particles;
  const std::uint32_t* order;
  std::uint64_t* keys;

  THAWSLIDE_HD void operator()(std::size_t rank) const {
    keys[rank] = ordered_bits(path.of(particles, order[rank]).along);
  }
};

// The last particles of a sorted list, in reverse order.
template <int Dim>
struct KeepForemost {
  mpm::Transformation<Dim> path;
  mpm::ParticleView<Dim> particles;
  const std::uint32_t* end;
  mpm::PathSample* foremost;

  THAWSLIDE_HD void operator()(std::size_t k) const { foremost[k] = path.of(particles, *(end - 1 - k)); }
};

template <class Backend, int Dim>
class Front {
 public:
  explicit Front(Backend& backend) : backend_(backend) {}

  // count: number of particles, at least one. mass: their total mass [kg]. Among equal distances, the higher rank in
  // canonical order is further ahead.
  mpm::PathSample find(const mpm::Transformation<Dim>& path, double mass, const TileTables<Dim>& tables,
                       const mpm::ParticleView<Dim>& particles, std::size_t count) {
    const mpm::Transformation<Dim> here{copied(path.line), path.origin, path.all, path.bodies};
    keys_.resize(count);
    sorted_keys_.resize(count);
    sorted_.resize(count);
    backend_.for_each(count, ListAlongPath<Dim>{here, particles, tables.order, keys_.data()});
    backend_.sort(keys_.data(), tables.order, sorted_keys_.data(), sorted_.data(), count);
    mpm::FrontSearch search(mass);
    // Chunk size: slightly more particles than are ahead of the front if all masses are equal.
    const std::size_t at_a_time = count / 150 + 1024;
    for (std::size_t left = count;; left -= foremost_.size()) {
      foremost_.resize(std::min(left, at_a_time));
      backend_.for_each(foremost_.size(), KeepForemost<Dim>{here, particles, sorted_.data() + left, foremost_.data()});
      for (const mpm::PathSample& one : foremost_.get()) {
        if (search.is_at(one.mass)) {
          return one;
        }
      }
      THAWSLIDE_ASSERT(left > foremost_.size(), "no front of {} particles and {} kg", count, mass);
    }
  }

 private:
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
  void copy(exec::Array<T, Backend>& to, const T* from, std::size_t count) {
    to.resize(count);
    backend_.copy_in(to.data(), from, count);
  }

  Backend& backend_;
  // persistent buffers, to avoid reallocation for each history row
  exec::Array<std::uint64_t, Backend> keys_{backend_}, sorted_keys_{backend_};
  exec::Array<std::uint32_t, Backend> sorted_{backend_};
  exec::Array<mpm::PathSample, Backend> foremost_{backend_};
  exec::Array<Point2, Backend> corners_{backend_}, directions_{backend_};
  exec::Array<double, Backend> along_{backend_};
  exec::Array<BoxOfLine, Backend> boxes_{backend_};
};

}  // namespace thawslide::device
