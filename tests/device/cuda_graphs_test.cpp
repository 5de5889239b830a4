// Tests of CUDA graphs of launches (device/cuda_graphs.hpp) with mocked CUDA functions: a kernel is a host function,
// and its argument is copied when CUDA would copy it.
#include "device/cuda_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace {

using Kernel = void(double);
struct Node {
  Kernel* kernel;
  double argument;
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

// Records the kernel's number and its argument as text.
template <int Name>
void kernel(double argument) {
  ran.push_back(std::to_string(Name) + ":" + std::to_string(static_cast<int>(argument)));
}

Node node_of(const void* function, void** arguments) {
  return {reinterpret_cast<Kernel*>(const_cast<void*>(function)), *static_cast<double*>(arguments[0])};
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
  nodes.push_back(std::make_unique<Node>(node_of(parameters->func, parameters->kernelParams)));
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
  const auto place = std::find(changed->of_graph.begin(), changed->of_graph.end(), reinterpret_cast<Node*>(node));
  if (place == changed->of_graph.end()) {
    return cudaErrorInvalidValue;
  }
  Node& known = changed->nodes[static_cast<std::size_t>(place - changed->of_graph.begin())];
  EXPECT_EQ(reinterpret_cast<void*>(known.kernel), parameters->func);
  known = node_of(parameters->func, parameters->kernelParams);
  return cudaSuccess;
}
cudaError_t cudaGraphLaunch(cudaGraphExec_t executable, cudaStream_t /*stream*/) {
  ++counts.launches;
  for (const Node& node : reinterpret_cast<Executable*>(executable)->nodes) {
    node.kernel(node.argument);
  }
  return cudaSuccess;
}
cudaError_t cudaLaunchKernel(const void* function, dim3 /*groups*/, dim3 /*threads*/, void** arguments,
                             std::size_t /*shared_bytes*/, cudaStream_t /*stream*/) {
  ++counts.single_launches;
  const Node node = node_of(function, arguments);
  node.kernel(node.argument);
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
    graphs_.add(kernel<Name>, dim3(groups), dim3(32), 0, number);
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
  for (const double a : {10.0, 20.0}) {
    const std::string first = "1:" + std::to_string(static_cast<int>(a / 10));
    Ran expected{first + "0", first + "1", first + "2", first + "3"};
    add_four(a);
    EXPECT_EQ(launch(), expected);
    add_four(a);
    add<2>(a);
    expected.push_back("2:" + expected[0].substr(2));
    EXPECT_EQ(launch(), expected);
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
      graphs.add(kernel<1>, dim3(1), dim3(32), 0, 1.0);
    }
    EXPECT_EQ(graphs.launch(), cudaSuccess);
    EXPECT_EQ(counts.left, 2);
  }
  EXPECT_EQ(counts.left, 0);
}

}  // namespace
}  // namespace thawslide::device
