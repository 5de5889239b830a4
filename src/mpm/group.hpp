// A group of threads that works on one tile, as on a device: work is done in phases, and between two of them a barrier
// lets all threads wait for each other. Here the threads run one after the other on the host, in any order asked for:
// what does not depend on the order of threads gives the same bits in all of them, and what a phase reads of a phase
// that no barrier ended is not there yet.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace thawslide::mpm {

enum class ThreadOrder { forward, backward, shuffled };

class HostGroup {
 public:
  static constexpr int none = -1;

  // omitted_barrier: number of the barrier, within each tile, that is left out, to show that it is needed.
  HostGroup(std::size_t threads, ThreadOrder order, int omitted_barrier = none)
      : omitted_barrier_(omitted_barrier), threads_(threads) {
    std::iota(threads_.begin(), threads_.end(), std::size_t{0});
    if (order == ThreadOrder::backward) {
      std::reverse(threads_.begin(), threads_.end());
    } else if (order == ThreadOrder::shuffled) {
      std::shuffle(threads_.begin(), threads_.end(), std::mt19937(1));
    }
  }

  // Begins a tile: barriers are counted anew.
  void begin() { barrier_ = 0; }

  // A phase: work(k) for k = 0 .. count-1, each by one thread. It has run once a barrier has been passed.
  void each(std::size_t count, std::function<void(std::size_t)> work) { phases_.push_back({count, std::move(work)}); }

  void barrier() {
    if (barrier_++ != omitted_barrier_) {
      run();
    }
  }

  // Ends the tile.
  void end() { run(); }

 private:
  struct Phase {
    std::size_t count;
    std::function<void(std::size_t)> work;
  };

  void run() {
    for (const std::size_t thread : threads_) {
      for (const Phase& phase : phases_) {
        for (std::size_t k = thread; k < phase.count; k += threads_.size()) {
          phase.work(k);
        }
      }
    }
    phases_.clear();
  }

  int omitted_barrier_, barrier_ = 0;
  std::vector<std::size_t> threads_;  // in the order in which they run
  std::vector<Phase> phases_;         // since the last barrier
};

// Memory that the threads of a group share: nothing is in it at first.
template <class Real>
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t numbers = 0) : numbers_(numbers, std::numeric_limits<Real>::signaling_NaN()) {}

  [[nodiscard]] Real& operator[](std::size_t k) { return numbers_[k]; }
  [[nodiscard]] const Real& operator[](std::size_t k) const { return numbers_[k]; }

 private:
  std::vector<Real> numbers_;
};

}  // namespace thawslide::mpm
