// Erodible bed below the candidate nodes of a step, on an executor. The bed itself (terrain/bed.hpp) is on the CPU,
// which receives the loads of the nodes and the mass that they have entrained.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "exec/array.hpp"
#include "terrain/bed.hpp"

namespace thawslide::terrain {

// Kernels with one thread per candidate node. Nodes: records of nodes (mpm/nodes.hpp, device/node_access.hpp). Node: of
// one node.
template <class Nodes, class Node>
struct PackLoad {
  Nodes nodes;
  const Node* candidates;
  double* loads;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    loads[k] = nodes.template read<mpm::BaseLoad>(candidates[k])[mpm::BaseLoad::load];
  }
};
template <int Dim>
struct OfferBed {
  const double* available;
  double* records;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    double* record = records + k * mpm::BedLayout<Dim>::size;
    for (std::size_t c = 0; c < mpm::BedLayout<Dim>::size; ++c) {
      record[c] = 0.0;
    }
    record[mpm::BedLayout<Dim>::available] = available[k];
  }
};

// Bed below all candidate nodes, by their numbers.
template <int Dim>
struct BedBelowNodes {
  BedMaterial material;
  double* records;

  [[nodiscard]] THAWSLIDE_HD BedBelowNode<Dim> below(std::size_t candidate, double area, double strength, double dt,
                                                     double mass) const {
    return {&material, records + candidate * mpm::BedLayout<Dim>::size, area, strength, dt, mass};
  }
};

template <class Executor, int Dim>
class BedStage {
 public:
  // Both must outlive the stage.
  BedStage(Executor& executor, Bed<Dim>& bed) : executor_(executor), bed_(bed) {}

  // Call after the bed has been distributed.
  [[nodiscard]] BedBelowNodes<Dim> below_nodes() { return {bed_.material(), records_.data()}; }
  // Call after contact has been resolved, in a step of dt [s].
  void collect(double dt) { bed_.collect(columns_, records_.get(), dt); }

 protected:
  // Call after the candidate nodes have changed.
  void set_columns(std::vector<std::size_t> columns) {
    columns_ = std::move(columns);
    loads_.resize(columns_.size());
    records_.resize(columns_.size() * mpm::BedLayout<Dim>::size);
  }
  // Sets the mass available to each candidate node. Call after covered parts have been marked.
  template <class Nodes, class Node>
  void distribute(const Nodes& nodes, const Node* candidates) {
    executor_.for_each(columns_.size(), PackLoad<Nodes, Node>{nodes, candidates, loads_.data()});
    available_.set(bed_.distribute(columns_, loads_.get()));
    executor_.for_each(columns_.size(), OfferBed<Dim>{available_.data(), records_.data()});
  }

  Executor& executor_;
  Bed<Dim>& bed_;
  std::vector<std::size_t> columns_;  // of the bed, by candidate

 private:
  exec::Array<double, Executor> loads_{executor_}, available_{executor_}, records_{executor_};
};

}  // namespace thawslide::terrain
