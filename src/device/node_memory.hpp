// Records of all nodes of active blocks in device memory, by name.
#pragma once

#include "device/node_kernels.hpp"
#include "device/passes.hpp"
#include "exec/array.hpp"

namespace thawslide::device {

template <class Backend, int Dim>
class NodeMemory {
 public:
  explicit NodeMemory(Backend& backend) : backend_(backend) {}

  // Resizes records to a number of nodes. Reallocation discards the contents.
  template <class... Names>
  void resize_for(std::size_t nodes) {
    (of<Names>().resize(nodes * mpm::record_size(mpm::components_of<Names, Dim>)), ...);
  }
  void clear_base(std::size_t nodes) {
    base_.resize(nodes * NodeViews<Dim>::base_size);
    backend_.for_each(base_.size(), Fill<double>{base_.data(), 0.0});
  }

  template <class Name>
  [[nodiscard]] exec::Array<double, Backend>& of() {
    return records_.template of<Name>();
  }
  template <class Name>
  [[nodiscard]] const exec::Array<double, Backend>& of() const {
    return records_.template of<Name>();
  }
  // known: ground data by node; null without ground.
  [[nodiscard]] NodeViews<Dim> views(const terrain::GroundAtNode<Dim>* known) {
    return {of<mpm::Averages>().data(),
            of<mpm::NodalState>().data(),
            of<mpm::Momentum>().data(),
            of<mpm::NearGround>().data(),
            base_.data(),
            of<mpm::Contact>().data(),
            of<mpm::Motion>().data(),
            of<mpm::Velocity>().data(),
            known};
  }

 private:
  Backend& backend_;
  exec::Array<double, Backend> base_{backend_};
  NodeArrays<Backend, mpm::Averages, mpm::NodalState, mpm::Momentum, mpm::NearGround, mpm::Contact, mpm::Motion,
             mpm::Velocity, mpm::HeatRates, mpm::UnreachedHeat, mpm::Seepage, mpm::SeepingWater, mpm::FilterMoments,
             mpm::FilterMomentum, mpm::FilterIncrement, mpm::FilterTotal>
      records_{backend_};
};

}  // namespace thawslide::device
