// CPU emulation of a device. Threads of a group run one after the other in a selectable order. Results that are
// independent of thread order are bitwise identical in all orders; missing barriers become visible, because a phase
// runs only at the next barrier. As on a GPU, launches are queued until the CPU waits, and new memory is uninitialized.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace thawslide::device {

enum class ThreadOrder { forward, backward, shuffled };

// Calls visit(k) for k = 0 .. count-1 in the given order.
template <class Visit>
void in_thread_order(std::size_t count, ThreadOrder order, const Visit& visit) {
  if (order == ThreadOrder::forward) {
    for (std::size_t k = 0; k < count; ++k) {
      visit(k);
    }
  } else if (order == ThreadOrder::backward) {
    for (std::size_t k = count; k-- > 0;) {
      visit(k);
    }
  } else {
    // A stride coprime to the count visits each place once.
    std::size_t stride = count * 5 / 8 + 1;
    while (std::gcd(stride, count) > 1) {
      ++stride;
    }
    std::size_t k = count / 3;
    for (std::size_t done = 0; done < count; ++done) {
      visit(k);
      k = (k + stride) % count;
    }
  }
}

// Thread group with shared memory. Threads run in phases, separated by barriers.
class HostGroup {
 public:
  static constexpr int none = -1;

  // threads: thread numbers in execution order. omitted_barrier: number of a barrier to skip, for tests that show it is
  // needed.
  HostGroup(const std::vector<std::size_t>& threads, std::size_t shared_bytes, int omitted_barrier)
      : threads_(threads), omitted_barrier_(omitted_barrier), shared_(shared_bytes / sizeof(std::max_align_t) + 1) {
    std::memset(shared_.data(), 0xff, shared_.size() * sizeof(std::max_align_t));
  }

  // Aligned for all types.
  [[nodiscard]] std::byte* shared() { return reinterpret_cast<std::byte*>(shared_.data()); }

  // Adds a phase: work(k) for k = 0 .. count-1, distributed over the threads. It runs at the next barrier.
  void each(std::size_t count, std::function<void(std::size_t)> work) { phases_.push_back({count, std::move(work)}); }

  void barrier() {
    if (barrier_++ != omitted_barrier_) {
      end();
    }
  }

  // Runs the phases since the last barrier.
  void end() {
    for (const std::size_t thread : threads_) {
      for (const Phase& phase : phases_) {
        for (std::size_t k = thread; k < phase.count; k += threads_.size()) {
          phase.work(k);
        }
      }
    }
    phases_.clear();
  }

 private:
  struct Phase {
    std::size_t count;
    std::function<void(std::size_t)> work;
  };

  const std::vector<std::size_t>& threads_;
  int omitted_barrier_, barrier_ = 0;
  std::vector<std::max_align_t> shared_;
  std::vector<Phase> phases_;  // since the last barrier
};

class Host {
 public:
  // threads: group size that overrides the requested one; 0: as requested.
  explicit Host(ThreadOrder order = ThreadOrder::forward, std::size_t threads = 0,
                int omitted_barrier = HostGroup::none)
      : order_(order), threads_(threads), omitted_barrier_(omitted_barrier) {}

  Host(const Host& other) : order_(other.order_), threads_(other.threads_), omitted_barrier_(other.omitted_barrier_) {}
  Host& operator=(const Host&) = delete;
  ~Host() = default;

  template <class T>
  [[nodiscard]] T* allocate(std::size_t count) {
    void* memory = ::operator new(count * sizeof(T));
    std::memset(memory, 0xff, count * sizeof(T));
    return static_cast<T*>(memory);
  }
  void release(void* memory) {
    wait();
    ::operator delete(memory);
  }

  // Copies from CPU to device memory, within device memory, and from device to CPU memory.
  template <class T>
  void copy_in(T* to, const T* from, std::size_t count) {
    wait();
    std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
  }
  template <class T>
  void copy(T* to, const T* from, std::size_t count) {
    wait();
    std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
  }
  template <class T>
  void copy_out(T* to, const T* from, std::size_t count) {
    wait();
    std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
  }

  // Launches work(k) for k = 0 .. count-1, one thread each.
  template <class Work>
  void for_each(std::size_t count, const Work& work) {
    waiting_.push_back([this, count, work] { in_thread_order(count, order_, work); });
  }

  // Launches work(group, k) for k = 0 .. groups-1, one thread group each.
  template <class Work>
  void for_groups(std::size_t groups, std::size_t threads, std::size_t shared_bytes, const Work& work) {
    waiting_.push_back([this, groups, threads, shared_bytes, work] {
      std::vector<std::size_t> in_group;
      in_thread_order(threads_ != 0 ? threads_ : threads, order_, [&](std::size_t k) { in_group.push_back(k); });
      in_thread_order(groups, order_, [&](std::size_t k) {
        HostGroup group(in_group, shared_bytes, omitted_barrier_);
        work(group, k);
        group.end();
      });
    });
  }

  // Runs all queued launches.
  void wait() {
    launches_ += waiting_.size();
    waits_ += waiting_.empty() ? 0 : 1;
    for (const std::function<void()>& launch : std::exchange(waiting_, {})) {
      launch();
    }
  }
  // Number of launches, and number of waits with queued launches: the graphs submitted on a GPU.
  [[nodiscard]] std::size_t launches() const { return launches_; }
  [[nodiscard]] std::size_t waits() const { return waits_; }

  // Stable sort of keys and their values.
  void sort(const std::uint64_t* keys, const std::uint32_t* values, std::uint64_t* sorted_keys,
            std::uint32_t* sorted_values, std::size_t count) {
    wait();
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    for (std::size_t k = 0; k < count; ++k) {
      sorted_keys[k] = keys[order[k]];
      sorted_values[k] = values[order[k]];
    }
  }
  void sort(const std::uint64_t* keys, std::uint64_t* sorted_keys, std::size_t count) {
    wait();
    std::partial_sort_copy(keys, keys + count, sorted_keys, sorted_keys + count);
  }

  // Exclusive prefix sum: sums[k] = numbers[0] + ... + numbers[k-1], for k = 0 .. count-1.
  void sum_before(const std::uint32_t* numbers, std::uint32_t* sums, std::size_t count) {
    wait();
    std::exclusive_scan(numbers, numbers + count, sums, std::uint32_t{0});
  }

  // Stages are not timed in the emulation.
  void end_stage(const char* /*stage*/) {}
  void time_stages() {}
  [[nodiscard]] std::map<std::string, double> seconds() const { return {}; }

 private:
  ThreadOrder order_;
  std::size_t threads_;
  int omitted_barrier_;
  std::vector<std::function<void()>> waiting_;
  std::size_t launches_ = 0, waits_ = 0;
};

}  // namespace thawslide::device
