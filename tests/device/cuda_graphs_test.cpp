// Tests of CUDA graphs of launches (device/cuda_graphs.hpp) with mocked CUDA functions: a kernel is a host function,
// and its argument is copied when CUDA would copy it.
#include "device/cuda_graphs.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace {

struct Node {
  const void* kernel;
  unsigned groups;
  std::vector<std::byte> argument;
};
struct Graph {
  std::vector<std::unique_ptr<Node>> nodes;
};
struct Executable {
  std::vector<Node> nodes;
  std::vector<const Node*> of_graph;
};

struct Counts {
  int graphs = 0, executables = 0, changes = 0, launches = 0, single_launches = 0, left = 0;
};
Counts counts;
std::vector<std::string> ran;

template <int Name>
struct Argument {
  double number;
};
// Records the kernel's number and the argument's number as text.
template <int Name>
void kernel(Argument<Name> argument) {
  ran.push_back(std::to_string(Name) + ":" + std::to_string(static_cast<int>(argument.number)));
}

template <int Name>
bool run_as(const Node& node) {
  if (node.kernel != reinterpret_cast<const void*>(kernel<Name>)) {
    return false;
  }
  Argument<Name> argument;
  EXPECT_EQ(node.argument.size(), sizeof argument);
  std::memcpy(&argument, node.argument.data(), sizeof argument);
  kernel<Name>(argument);
  return true;
}
void run(const Node& node) { ASSERT_TRUE(run_as<1>(node) || run_as<2>(node) || run_as<3>(node)); }

Node node_of(const cudaKernelNodeParams& parameters) {
  const auto* argument = static_cast<const std::byte*>(parameters.kernelParams[0]);
  return {parameters.func, parameters.gridDim.x, {argument, argument + sizeof(double)}};
}

}  // namespace

extern "C" {

cudaError_t cudaGraphCreate(cudaGraph_t* graph, unsigned /*flags*/) {
  ++counts.graphs;
  ++counts.left;
  *graph = reinterpret_cast<cudaGraph_t>(new Graph);
  return cudaSuccess;
}
cudaError_t cudaGraphAddKernelNode(cudaGraphNode_t* node, cudaGraph_t graph, const cudaGraphNode_t* after,
                                   std::size_t count, const cudaKernelNodeParams* parameters) {
  auto& nodes = reinterpret_cast<Graph*>(graph)->nodes;
  // Nodes form a chain.
  EXPECT_EQ(count, nodes.empty() ? 0u : 1u);
  EXPECT_TRUE(nodes.empty() || reinterpret_cast<Node*>(*after) == nodes.back().get());
  nodes.push_back(std::make_unique<Node>(node_of(*parameters)));
  *node = reinterpret_cast<cudaGraphNode_t>(nodes.back().get());
  return cudaSuccess;
}
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* executable, cudaGraph_t graph, unsigned long long /*flags*/) {
  ++counts.executables;
  ++counts.left;
  auto* made = new Executable;
  for (const auto& node : reinterpret_cast<Graph*>(graph)->nodes) {
    made->nodes.push_back(*node);
    made->of_graph.push_back(node.get());
  }
  *executable = reinterpret_cast<cudaGraphExec_t>(made);
  return cudaSuccess;
}
cudaError_t cudaGraphExecKernelNodeSetParams(cudaGraphExec_t executable, cudaGraphNode_t node,
                                             const cudaKernelNodeParams* parameters) {
  ++counts.changes;
  auto* changed = reinterpret_cast<Executable*>(executable);
  for (std::size_t k = 0; k < changed->nodes.size(); ++k) {
    if (changed->of_graph[k] == reinterpret_cast<Node*>(node)) {
      EXPECT_EQ(changed->nodes[k].kernel, parameters->func);
      changed->nodes[k] = node_of(*parameters);
      return cudaSuccess;
    }
  }
  return cudaErrorInvalidValue;
}
cudaError_t cudaGraphLaunch(cudaGraphExec_t executable, cudaStream_t /*stream*/) {
  ++counts.launches;
  for (const Node& node : reinterpret_cast<Executable*>(executable)->nodes) {
    run(node);
  }
  return cudaSuccess;
}
cudaError_t cudaLaunchKernel(const void* kernel, dim3 groups, dim3 /*threads*/, void** arguments,
                             std::size_t /*shared_bytes*/, cudaStream_t /*stream*/) {
  ++counts.single_launches;
  const auto* argument = static_cast<const std::byte*>(arguments[0]);
  run({kernel, groups.x, {argument, argument + sizeof(double)}});
  return cudaSuccess;
}
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t executable) {
  --counts.left;
  delete reinterpret_cast<Executable*>(executable);
  return cudaSuccess;
}
cudaError_t cudaGraphDestroy(cudaGraph_t graph) {
  --counts.left;
  delete reinterpret_cast<Graph*>(graph);
  return cudaSuccess;
}

}  // extern "C"

namespace thawslide::device {
namespace {

class CudaGraphsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    counts = {};
    ran.clear();
  }

  template <int Name>
  void add(double number, unsigned groups = 5) {
    graphs_.add(kernel<Name>, dim3(groups), dim3(32), 0, Argument<Name>{number});
  }
  // Adds as many launches as make a graph, with consecutive numbers.
  void add_four(double first) {
    for (int k = 0; k < 4; ++k) {
      add<1>(first + k);
    }
  }
  std::vector<std::string> launch() {
    ran.clear();
    EXPECT_EQ(graphs_.launch(), cudaSuccess);
    return ran;
  }

  CudaGraphs graphs_;
};

using Ran = std::vector<std::string>;

TEST_F(CudaGraphsTest, NothingIsLaunchedBeforeItIsAskedFor) {
  EXPECT_EQ(launch(), Ran{});
  add_four(0);
  EXPECT_EQ(ran, Ran{});
  EXPECT_EQ(launch(), (Ran{"1:0", "1:1", "1:2", "1:3"}));
  EXPECT_EQ(launch(), Ran{});
  EXPECT_EQ(counts.launches, 1);
}

TEST_F(CudaGraphsTest, TheSameKernelsAreTheSameGraphWithItsArgumentsOfNow) {
  const auto step = [&](double a, double b, unsigned groups) {
    add<1>(a);
    add<2>(b, groups);
    add<1>(7);
    add<3>(8);
    return launch();
  };
  EXPECT_EQ(step(1, 2, 5), (Ran{"1:1", "2:2", "1:7", "3:8"}));
  EXPECT_EQ(step(1, 2, 5), (Ran{"1:1", "2:2", "1:7", "3:8"}));
  EXPECT_EQ(counts.changes, 0);
  EXPECT_EQ(step(3, 2, 5), (Ran{"1:3", "2:2", "1:7", "3:8"}));
  EXPECT_EQ(counts.changes, 1);
  EXPECT_EQ(step(3, 2, 6), (Ran{"1:3", "2:2", "1:7", "3:8"}));  // of another size
  EXPECT_EQ(counts.changes, 2);
  EXPECT_EQ(step(1, 2, 5), (Ran{"1:1", "2:2", "1:7", "3:8"}));
  EXPECT_EQ(counts.changes, 4);
  EXPECT_EQ(counts.executables, 1);
  EXPECT_EQ(counts.launches, 5);
}

TEST_F(CudaGraphsTest, OtherKernelsAreAnotherGraph) {
  const auto longer = [&](double a) {
    add_four(a);
    add<2>(a);
    return launch();
  };
  const auto shorter = [&](double a) {
    add_four(a);
    return launch();
  };
  for (const double a : {10.0, 20.0}) {
    const std::string first = std::to_string(static_cast<int>(a / 10));
    EXPECT_EQ(longer(a), (Ran{"1:" + first + "0", "1:" + first + "1", "1:" + first + "2", "1:" + first + "3",
                              "2:" + first + "0"}));
    EXPECT_EQ(shorter(a + 5), (Ran{"1:" + first + "5", "1:" + first + "6", "1:" + first + "7", "1:" + first + "8"}));
  }
  EXPECT_EQ(counts.executables, 2);
  EXPECT_EQ(counts.launches, 4);
}

TEST_F(CudaGraphsTest, FewAreLaunchedOneByOne) {
  add<1>(1);
  add<2>(2);
  EXPECT_EQ(launch(), (Ran{"1:1", "2:2"}));
  EXPECT_EQ(counts.single_launches, 2);
  EXPECT_EQ(counts.graphs, 0);
}

TEST(CudaGraphs, AreDestroyed) {
  counts = {};
  {
    CudaGraphs graphs;
    for (int k = 0; k < 4; ++k) {
      graphs.add(kernel<1>, dim3(1), dim3(32), 0, Argument<1>{1.0});
    }
    EXPECT_EQ(graphs.launch(), cudaSuccess);
    EXPECT_EQ(counts.left, 2);
  }
  EXPECT_EQ(counts.left, 0);
}

}  // namespace
}  // namespace thawslide::device
