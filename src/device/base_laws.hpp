// Basal friction and cohesion at candidate nodes. The CPU selects the laws.
#pragma once

#include <variant>

#include "device/ground.hpp"
#include "device/node_kernels.hpp"

namespace thawslide::device {

// cell: mesh size [m]. columns: records of BaseState by candidate node, or null. bases: by candidate node.
template <class Backend, int Dim>
void evaluate_law_at_nodes(Backend& backend, const NodeStageArgs<Dim>& step, const terrain::BasalLaw& base, Real cell,
                           const Ground<Backend, Dim>& ground, const Real* columns, ContactInput* bases) {
  const std::size_t count = ground.candidate_count();
  const std::uint32_t* candidates = ground.candidates();
  backend.for_each(count, PressOnGround<Dim>{step, candidates});
  const Real face = Dim == 2 ? cell : cell * cell;
  backend.for_each(count, GatherContactInput<Dim>{step, candidates, static_cast<Real>(terrain::smallest_area) * face,
                                                  base.gravity, columns, bases});
  for (std::size_t g = 0; g < base.grounds.size(); ++g) {
    const int substrate = static_cast<int>(g);
    std::visit(
        [&]<class Law>(const Law& law) {
          backend.for_each(count, EvaluateFriction<Law, Dim>{law, substrate, ground.known(), candidates, bases});
        },
        base.grounds[g].friction);
    std::visit(
        [&]<class Law>(const Law& law) {
          backend.for_each(count, EvaluateCohesion<Law, Dim>{law, substrate, ground.known(), candidates, bases});
        },
        base.grounds[g].cohesion);
  }
}

}  // namespace thawslide::device
