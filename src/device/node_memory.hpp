// Records of all nodes of active blocks in device memory, by name.
#pragma once

#include "device/node_access.hpp"
#include "device/passes.hpp"
#include "exec/array.hpp"

namespace thawslide::device {

template <class Backend, int Dim>
class NodeMemory {
 public:
  explicit NodeMemory(Backend& backend) : records_(backend) {}

  // Resizes records to a number of nodes. Reallocation discards the contents.
  template <class... Names>
  void resize_for(std::size_t nodes) {
    (of<Names>().resize(nodes * mpm::record_size(mpm::components_of<Names, Dim>)), ...);
  }
  template <class Name>
  [[nodiscard]] exec::Array<double, Backend>& of() {
    return records_.template of<Name>();
  }
  template <class Name>
  [[nodiscard]] const exec::Array<double, Backend>& of() const {
    return records_.template of<Name>();
  }
  template <class... Names>
  [[nodiscard]] NodeAccess<Dim, Names...> access(const std::uint64_t* block_keys, double cell) {
    return {{{of<Names>().data()}...}, block_keys, cell};
  }

 private:
  NodeArrays<Backend, mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::NearGround, mpm::BaseLoad, mpm::Contact,
             mpm::Motion, mpm::Velocity, mpm::HeatRates, mpm::SecantRates, mpm::UnreachedHeat, mpm::Seepage,
             mpm::SeepingWater, mpm::FilterMoments, mpm::FilterMomentum, mpm::FilterIncrement, mpm::FilterTotal>
      records_;
};

}  // namespace thawslide::device
