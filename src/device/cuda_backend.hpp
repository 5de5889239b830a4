// CUDA backend for NVIDIA GPUs, compiled by nvcc. Errors are thrown as GpuError.
#pragma once

#include <cuda_runtime.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <map>
#include <string>
#include <utility>

#include "base/portability.hpp"
#include "device/cuda_graphs.hpp"
#include "device/gpu.hpp"
#include "device/solver.hpp"

namespace thawslide::device {

class GpuError : public Failure {
 public:
  explicit GpuError(cudaError_t code, const char* doing)
      : Failure(std::string(doing) + ": " + cudaGetErrorString(code)), code_(code) {}
  [[nodiscard]] cudaError_t code() const { return code_; }

 private:
  cudaError_t code_;
};

inline void expect_done(cudaError_t code, const char* doing) {
  if (code != cudaSuccess) {
    static_cast<void>(cudaGetLastError());  // clear the error, or the next call would report it again
    throw GpuError(code, doing);
  }
}

// Thread group of a kernel: the threads of a CUDA block.
class CudaGroup {
 public:
  THAWSLIDE_HD explicit CudaGroup(std::byte* shared) : shared_(shared) {}

  [[nodiscard]] THAWSLIDE_HD std::byte* shared() const { return shared_; }
  template <class Work>
  THAWSLIDE_HD void each(std::size_t count, const Work& work) const {
#ifdef __CUDA_ARCH__
    for (std::size_t k = threadIdx.x; k < count; k += blockDim.x) {
      work(k);
    }
#endif
  }
  THAWSLIDE_HD void barrier() const {
#ifdef __CUDA_ARCH__
    __syncthreads();
#endif
  }

 private:
  std::byte* shared_;
};

// Argument of a kernel with one thread per item.
template <class Work>
struct Each {
  std::size_t count;
  Work work;
};
template <class Work>
__global__ void run_each(const __grid_constant__ Each<Work> each) {
  const std::size_t k = static_cast<std::size_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (k < each.count) {
    each.work(k);
  }
}
template <class Work>
__global__ void run_groups(const __grid_constant__ Work work) {
  extern __shared__ __align__(16) std::byte shared[];
  CudaGroup group(shared);
  work(group, static_cast<std::size_t>(blockIdx.x));
}

struct NoWork {
  THAWSLIDE_HD void operator()(std::size_t /*k*/) const {}
};

// Kernel launches are queued until the CPU waits for the GPU, and are then submitted as a graph (cuda_graphs.hpp).
class Cuda {
 public:
  // Uses the current CUDA device of the process. Throws if there is none, or if the program was not compiled for it.
  explicit Cuda(Launching launching = Launching::in_graphs) : launching_(launching) {
    expect_done(cudaGetDevice(&gpu_), "looking for a GPU");
    cudaFuncAttributes attributes;
    expect_done(cudaFuncGetAttributes(&attributes, run_each<NoWork>), "loading this program on the GPU");
  }
  Cuda(const Cuda&) = delete;
  Cuda& operator=(const Cuda&) = delete;
  ~Cuda() { release(working_); }

  template <class T>
  [[nodiscard]] T* allocate(std::size_t count) {
    void* memory = nullptr;
    expect_done(cudaMalloc(&memory, count * sizeof(T)), "allocating memory on the GPU");
    return static_cast<T*>(memory);
  }
  // Does not throw: earlier failures are reported at the next launch or copy.
  void release(void* memory) {
    record_failure(graphs_.launch());  // queued kernels may still use this memory
    static_cast<void>(cudaFree(memory));
  }

  template <class T>
  void copy_in(T* to, const T* from, std::size_t count) {
    launch_waiting();
    expect_done(cudaMemcpy(to, from, count * sizeof(T), cudaMemcpyHostToDevice), "copying to the GPU");
  }
  template <class T>
  void copy(T* to, const T* from, std::size_t count) {
    launch_waiting();
    expect_done(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToDevice), "copying on the GPU");
  }
  template <class T>
  void copy_out(T* to, const T* from, std::size_t count) {
    launch_waiting();
    expect_done(cudaMemcpy(to, from, count * sizeof(T), cudaMemcpyDeviceToHost), "copying from the GPU");
  }

  template <class Work>
  void for_each(std::size_t count, const Work& work) {
    constexpr std::size_t threads = 128;
    if (count > 0) {
      launch(run_each<Work>, (count + threads - 1) / threads, threads, 0, Each<Work>{count, work});
    }
  }

  template <class Work>
  void for_groups(std::size_t groups, std::size_t threads, std::size_t shared_bytes, const Work& work) {
    // shared memory [bytes] allowed for this kernel; 48 KiB is the limit without an attribute
    static std::size_t has = 48 * 1024;
    if (shared_bytes > has) {
      expect_done(cudaFuncSetAttribute(run_groups<Work>, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                       static_cast<int>(shared_bytes)),
                  "allocating shared memory on the GPU");
      has = shared_bytes;
    }
    if (groups > 0) {
      launch(run_groups<Work>, groups, threads, shared_bytes, work);
    }
  }

  void sort(const std::uint64_t* keys, const std::uint32_t* values, std::uint64_t* sorted_keys,
            std::uint32_t* sorted_values, std::size_t count) {
    with_scratch("sorting", [&](void* memory, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortPairs(memory, bytes, keys, sorted_keys, values, sorted_values,
                                             static_cast<std::uint32_t>(count));
    });
  }
  void sort(const std::uint64_t* keys, std::uint64_t* sorted_keys, std::size_t count) {
    with_scratch("sorting", [&](void* memory, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortKeys(memory, bytes, keys, sorted_keys, static_cast<std::uint32_t>(count));
    });
  }

  void sum_before(const std::uint32_t* numbers, std::uint32_t* sums, std::size_t count) {
    with_scratch("summing", [&](void* memory, std::size_t& bytes) {
      return cub::DeviceScan::ExclusiveSum(memory, bytes, numbers, sums, static_cast<int>(count));
    });
  }

  // Waits until the GPU has completed all submitted work.
  void wait() {
    launch_waiting();
    expect_done(cudaDeviceSynchronize(), "waiting for the GPU");
  }

  // Measures stages [s] from now on. Each stage then ends with a synchronization, which slows down the step.
  void time_stages() {
    wait();
    times_stages_ = true;
    last_ = Clock::now();
  }
  void end_stage(const char* stage) {
    if (times_stages_) {
      wait();
      const auto now = Clock::now();
      seconds_[stage] += std::chrono::duration<double>(now - last_).count();
      last_ = now;
    }
  }
  [[nodiscard]] const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  template <class Argument>
  void launch(void (*kernel)(Argument), std::size_t groups, std::size_t threads, std::size_t shared_bytes,
              const Argument& argument) {
    graphs_.add(kernel, dim3(static_cast<unsigned>(groups)), dim3(static_cast<unsigned>(threads)), shared_bytes,
                argument);
    if (launching_ == Launching::one_by_one) {
      launch_waiting();
    }
  }
  void launch_waiting() {
    record_failure(graphs_.launch());
    expect_done(std::exchange(failed_, cudaSuccess), "starting threads on the GPU");
  }
  void record_failure(cudaError_t code) { failed_ = failed_ == cudaSuccess ? code : failed_; }

  // Calls work(memory, bytes) twice: with null memory, it sets the number of bytes needed.
  template <class Work>
  void with_scratch(const char* doing, const Work& work) {
    launch_waiting();
    std::size_t bytes = 0;
    expect_done(work(nullptr, bytes), doing);
    if (working_ == nullptr || bytes > bytes_of_working_) {
      release(std::exchange(working_, nullptr));
      working_ = allocate<std::byte>(bytes > 0 ? bytes : 1);
      bytes_of_working_ = bytes;
    }
    expect_done(work(working_, bytes), doing);
  }

  using Clock = std::chrono::steady_clock;

  int gpu_ = 0;
  Launching launching_;
  CudaGraphs graphs_;
  cudaError_t failed_ = cudaSuccess;  // of launches, not yet reported
  bool times_stages_ = false;
  Clock::time_point last_;
  std::map<std::string, double> seconds_;
  std::byte* working_ = nullptr;  // scratch memory for sorts and prefix sums, reused
  std::size_t bytes_of_working_ = 0;
};

}  // namespace thawslide::device
