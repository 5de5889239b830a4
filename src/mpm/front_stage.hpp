// Front of the sliding mass (mpm/front.hpp) from its particles, on an executor.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/ordered_bits.hpp"
#include "exec/array.hpp"
#include "mpm/front.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::mpm {

// Sort key of each particle, by rank in canonical order: its distance along the path.
template <int Dim>
struct ListAlongPath {
  Transformation<Dim> path;
  ParticleView<Dim> particles;
  const std::uint32_t* order;
  std::uint64_t* keys;

  THAWSLIDE_HD void operator()(std::size_t rank) const {
    keys[rank] = ordered_bits(path.of(particles, order[rank]).along);
  }
};

// The last particles of a sorted list, in reverse order.
template <int Dim>
struct KeepForemost {
  Transformation<Dim> path;
  ParticleView<Dim> particles;
  const std::uint32_t* end;
  PathSample* foremost;

  THAWSLIDE_HD void operator()(std::size_t k) const { foremost[k] = path.of(particles, *(end - 1 - k)); }
};

template <class Executor, int Dim>
class Front {
 public:
  explicit Front(Executor& executor) : executor_(executor) {}

  // order: particles in canonical order. count: their number, at least one. mass: of the bodies of the path [kg]. Among
  // equal distances, the higher rank is further ahead.
  PathSample find(const Transformation<Dim>& path, double mass, const ParticleView<Dim>& particles,
                  const std::uint32_t* order, std::size_t count) {
    const Transformation<Dim> here{copied(path.line), path.origin, path.all, path.bodies};
    keys_.resize(count);
    sorted_keys_.resize(count);
    sorted_.resize(count);
    executor_.for_each(count, ListAlongPath<Dim>{here, particles, order, keys_.data()});
    executor_.sort(keys_.data(), order, sorted_keys_.data(), sorted_.data(), count);
    FrontSearch search(mass);
    // Chunk size: slightly more particles than are ahead of the front if all masses are equal.
    const std::size_t at_a_time = count / 150 + 1024;
    for (std::size_t left = count;;) {
      foremost_.resize(std::min(left, at_a_time));
      executor_.for_each(foremost_.size(), KeepForemost<Dim>{here, particles, sorted_.data() + left, foremost_.data()});
      for (const PathSample& one : foremost_.get()) {
        if (left-- == 1 || search.is_at(one.mass)) {
          return one;
        }
      }
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
  void copy(exec::Array<T, Executor>& to, const T* from, std::size_t count) {
    to.resize(count);
    executor_.copy_in(to.data(), from, count);
  }

  Executor& executor_;
  exec::Array<std::uint64_t, Executor> keys_{executor_}, sorted_keys_{executor_};
  exec::Array<std::uint32_t, Executor> sorted_{executor_};
  exec::Array<PathSample, Executor> foremost_{executor_};
  exec::Array<Point2, Executor> corners_{executor_}, directions_{executor_};
  exec::Array<double, Executor> along_{executor_};
  exec::Array<BoxOfLine, Executor> boxes_{executor_};
};

}  // namespace thawslide::mpm
