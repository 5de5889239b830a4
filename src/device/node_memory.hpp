// Records of all nodes of active blocks in device memory, by name.
#pragma once

#include "device/node_kernels.hpp"
#include "device/passes.hpp"
#include "exec/array.hpp"

namespace thawslide::device {

// Access to records of nodes by name (as mpm::NodeAccess). A node is its number over all blocks.
template <int Dim, class... Names>
struct NodeAccess {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  mpm::ByName<mpm::Named<Names, double*>...> numbers;
  const std::uint64_t* block_keys;
  double cell;

  template <class Name>
  [[nodiscard]] THAWSLIDE_HD double* write(std::size_t node) const {
    return numbers.template of<Name>() + node * mpm::record_size(mpm::components_of<Name, Dim>);
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD const double* read(std::size_t node) const {
    return write<Name>(node);
  }
  [[nodiscard]] THAWSLIDE_HD static std::size_t block(std::size_t node) { return node / block_nodes; }
  [[nodiscard]] THAWSLIDE_HD Vector<double, Dim> position(std::size_t node) const {
    return position_of_node<Dim>(block_keys, node, cell);
  }
};

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
  template <class... Names>
  [[nodiscard]] NodeAccess<Dim, Names...> access(const std::uint64_t* block_keys, double cell) {
    return {{{of<Names>().data()}...}, block_keys, cell};
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
             mpm::Velocity, mpm::HeatRates, mpm::SecantRates, mpm::UnreachedHeat, mpm::Seepage, mpm::SeepingWater,
             mpm::FilterMoments, mpm::FilterMomentum, mpm::FilterIncrement, mpm::FilterTotal>
      records_{backend_};
};

}  // namespace thawslide::device
