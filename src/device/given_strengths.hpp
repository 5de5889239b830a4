// Basal strengths by a law of the caller (terrain/strength_law.hpp), which the CPU evaluates for a device.
#pragma once

#include <cstdint>
#include <vector>

#include "device/ground.hpp"
#include "device/node_kernels.hpp"
#include "exec/array.hpp"
#include "terrain/strength_law.hpp"

namespace thawslide::device {

// Points on the ground below candidate nodes [m, relative to the domain's lower corner]. One thread per candidate.
template <int Dim>
struct LocateOnGround {
  NodeStageArgs<Dim> step;
  const std::uint32_t* candidates;
  double* positions;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    Vector<double, Dim> position = position_of_node<Dim>(step.tables.block_keys, candidates[k], step.cell);
    position[Dim - 1] = step.ground(candidates[k]).elevation;
    for (int a = 0; a < Dim; ++a) {
      positions[k * Dim + static_cast<std::size_t>(a)] = position[a];
    }
  }
};

template <class Backend, int Dim>
class GivenStrengths {
 public:
  explicit GivenStrengths(Backend& backend) : backend_(backend) {}

  // Strengths by candidate node [Pa]. bases: by candidate, evaluated.
  [[nodiscard]] const double* by(const terrain::StrengthLaw& law, const terrain::BasalLaw& laws_of_case,
                                 const NodeStageArgs<Dim>& step, const Ground<Backend, Dim>& ground,
                                 const exec::Array<terrain::BasalNode, Backend>& bases) {
    positions_.resize(bases.size() * Dim);
    backend_.for_each(bases.size(), LocateOnGround<Dim>{step, ground.candidates(), positions_.data()});
    const std::vector<double> positions = positions_.get();
    const std::vector<terrain::BasalNode> evaluated = bases.get();
    terrain::LoadedNodes nodes;
    nodes.time = step.time;
    nodes.dt = step.dt;
    for (std::size_t k = 0; k < evaluated.size(); ++k) {
      if (evaluated[k].area > 0.0) {
        terrain::add_loaded_node<Dim>(&positions[k * Dim], evaluated[k], laws_of_case, nodes);
      }
    }
    terrain::replace_strengths(law, nodes);
    std::vector<double> strengths(evaluated.size(), 0.0);
    for (std::size_t k = 0, loaded = 0; k < evaluated.size(); ++k) {
      if (evaluated[k].area > 0.0) {
        strengths[k] = nodes.strength[loaded++];
      }
    }
    strengths_.set(strengths);
    return strengths_.data();
  }

 private:
  Backend& backend_;
  exec::Array<double, Backend> positions_{backend_}, strengths_{backend_};
};

}  // namespace thawslide::device
