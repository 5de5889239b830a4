// Kernel launches submitted to a GPU together as a CUDA graph, compiled by nvcc. A sequence of the same kernels reuses
// its graph and updates only the arguments that have changed.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <vector>

namespace thawslide::device {

class CudaGraphs {
 public:
  CudaGraphs() = default;
  CudaGraphs(const CudaGraphs&) = delete;
  CudaGraphs& operator=(const CudaGraphs&) = delete;
  ~CudaGraphs() {
    for (auto& [kernels, graph] : graphs_) {
      static_cast<void>(cudaGraphExecDestroy(graph.executable));
      static_cast<void>(cudaGraphDestroy(graph.graph));
    }
  }

  // Queues a launch after those added before. argument: the kernel's only argument, copied bytewise.
  template <class Argument>
  void add(void (*kernel)(Argument), dim3 groups, dim3 threads, std::size_t shared_bytes, const Argument& argument) {
    const std::size_t first = waiting_.arguments.size();
    waiting_.launches.push_back(
        {reinterpret_cast<const void*>(kernel), groups.x, threads.x, shared_bytes, first, sizeof argument});
    waiting_.arguments.resize(first + sizeof argument);
    std::memcpy(waiting_.arguments.data() + first, &argument, sizeof argument);
  }

  // Submits all queued launches.
  cudaError_t launch() {
    if (waiting_.launches.empty()) {
      return cudaSuccess;
    }
    const cudaError_t code = waiting_.launches.size() < fewest ? launch_one_by_one() : launch_graph();
    waiting_.launches.clear();
    waiting_.arguments.clear();
    return code;
  }

 private:
  static constexpr std::size_t fewest = 4;  // fewest launches submitted as a graph: an estimate, not measured

  struct Launch {
    const void* kernel;
    unsigned groups, threads;
    std::size_t shared_bytes;
    std::size_t first, bytes;  // of the argument
  };
  struct Sequence {
    std::vector<Launch> launches;
    std::vector<std::byte> arguments;

    [[nodiscard]] std::byte* argument(std::size_t k) { return arguments.data() + launches[k].first; }
  };
  struct Graph {
    cudaGraph_t graph = nullptr;
    cudaGraphExec_t executable = nullptr;
    std::vector<cudaGraphNode_t> nodes;  // one per launch
    Sequence known;                      // launches that the executable currently holds
  };

  cudaError_t launch_one_by_one() {
    cudaError_t code = cudaSuccess;
    for (std::size_t k = 0; k < waiting_.launches.size() && code == cudaSuccess; ++k) {
      const Launch& launch = waiting_.launches[k];
      void* argument = waiting_.argument(k);
      code = cudaLaunchKernel(launch.kernel, launch.groups, launch.threads, &argument, launch.shared_bytes, nullptr);
    }
    return code;
  }

  cudaError_t launch_graph() {
    std::vector<const void*> kernels(waiting_.launches.size());
    std::transform(waiting_.launches.begin(), waiting_.launches.end(), kernels.begin(),
                   [](const Launch& launch) { return launch.kernel; });
    Graph& graph = graphs_[kernels];
    const cudaError_t code = graph.executable == nullptr ? make(graph) : update(graph);
    return code == cudaSuccess ? cudaGraphLaunch(graph.executable, nullptr) : code;
  }

  // Calls set(k, parameters) for launch k.
  template <class Set>
  cudaError_t with_parameters(std::size_t k, const Set& set) {
    const Launch& launch = waiting_.launches[k];
    void* argument = waiting_.argument(k);
    cudaKernelNodeParams parameters{};
    parameters.func = const_cast<void*>(launch.kernel);
    parameters.gridDim = dim3(launch.groups);
    parameters.blockDim = dim3(launch.threads);
    parameters.sharedMemBytes = static_cast<unsigned>(launch.shared_bytes);
    parameters.kernelParams = &argument;
    return set(k, parameters);
  }

  cudaError_t make(Graph& made) {
    cudaError_t code = cudaGraphCreate(&made.graph, 0);
    for (std::size_t k = 0; k < waiting_.launches.size() && code == cudaSuccess; ++k) {
      made.nodes.emplace_back();
      code = with_parameters(k, [&](std::size_t at, const cudaKernelNodeParams& parameters) {
        return cudaGraphAddKernelNode(&made.nodes[at], made.graph, at > 0 ? &made.nodes[at - 1] : nullptr,
                                      at > 0 ? 1 : 0, &parameters);
      });
    }
    if (code == cudaSuccess) {
      code = cudaGraphInstantiate(&made.executable, made.graph, 0);
    }
    if (code != cudaSuccess) {
      static_cast<void>(cudaGraphDestroy(made.graph));
      made = {};
    }
    made.known = waiting_;
    return code;
  }

  cudaError_t update(Graph& graph) {
    cudaError_t code = cudaSuccess;
    for (std::size_t k = 0; k < waiting_.launches.size() && code == cudaSuccess; ++k) {
      if (!is_known(graph, k)) {
        code = with_parameters(k, [&](std::size_t at, const cudaKernelNodeParams& parameters) {
          return cudaGraphExecKernelNodeSetParams(graph.executable, graph.nodes[at], &parameters);
        });
      }
    }
    graph.known = waiting_;
    return code;
  }
  [[nodiscard]] bool is_known(Graph& graph, std::size_t k) {
    const Launch &known = graph.known.launches[k], &now = waiting_.launches[k];
    return known.groups == now.groups && known.threads == now.threads && known.shared_bytes == now.shared_bytes &&
           known.bytes == now.bytes && std::memcmp(graph.known.argument(k), waiting_.argument(k), now.bytes) == 0;
  }

  Sequence waiting_;
  std::map<std::vector<const void*>, Graph> graphs_;  // by their kernels
};

}  // namespace thawslide::device
