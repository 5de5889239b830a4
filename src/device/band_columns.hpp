// Band columns below the sliding mass (band/basal_segments.hpp). They are computed on the CPU; each step exchanges data
// with the nodes in contact.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "device/node_kernels.hpp"
#include "device/step_model.hpp"
#include "exec/array.hpp"

namespace thawslide::device {

// Packs records of the nodes in the blocks that the CPU requested. One thread per node.
template <int Dim>
struct PackColumns {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  static constexpr auto of_contact = static_cast<std::size_t>(mpm::Contact::size<Dim>);

  ContactNodes<Dim> nodes;
  const std::uint32_t* blocks;
  double* records;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t node = blocks[k / block_nodes] * block_nodes + k % block_nodes;
    double* record = records + k * column_record_size<Dim>;
    for (std::size_t c = 0; c < of_contact; ++c) {
      record[c] = nodes.template read<mpm::Contact>(node)[c];
    }
    record[of_contact] = nodes.template read<mpm::Momentum>(node)[mpm::MomentumLayout<Dim>::mass];
    for (std::size_t a = 0; a < Dim; ++a) {
      record[of_contact + 1 + a] = nodes.template read<mpm::Motion>(node)[mpm::MotionLayout<Dim>::middle_velocity + a];
    }
  }
};

template <class Backend, int Dim>
class BandColumns {
 public:
  BandColumns(Backend& backend, HostColumns processor) : backend_(backend), cpu_(std::move(processor)) {}

  [[nodiscard]] bool exist() const { return static_cast<bool>(cpu_.states); }

  // Call after blocks have changed.
  void update(const std::vector<std::uint64_t>& blocks) {
    if (exist()) {
      queried_.set(cpu_.update_blocks(blocks));
      records_.resize(queried_.size() * PackColumns<Dim>::block_nodes * column_record_size<Dim>);
    }
  }

  // Records of BaseState by candidate node; null without band columns.
  [[nodiscard]] const double* states() {
    if (!exist()) {
      return nullptr;
    }
    states_.set(cpu_.states());
    return states_.data();
  }

  // Call after contact has been resolved.
  void follow(const ContactNodes<Dim>& nodes) {
    if (exist()) {
      backend_.for_each(queried_.size() * PackColumns<Dim>::block_nodes,
                        PackColumns<Dim>{nodes, queried_.data(), records_.data()});
      cpu_.follow(records_.get());
    }
  }

 private:
  Backend& backend_;
  HostColumns cpu_;
  exec::Array<std::uint32_t, Backend> queried_{backend_};
  exec::Array<double, Backend> states_{backend_}, records_{backend_};
};

}  // namespace thawslide::device
