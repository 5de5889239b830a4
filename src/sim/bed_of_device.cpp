// Erodible bed of a simulation on a device: the bed itself is computed on the CPU.
#include "sim/bed_of_device.hpp"

#include "base/instances.hpp"
#include "device/solver.hpp"
#include "device/step_model.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
device::HostBed<Dim> Simulation<Dim>::host_bed() {
  if (bed_in_reach() == nullptr) {
    return {};
  }
  using Columns = typename device::HostBed<Dim>::Columns;
  bed_of_device_ = std::make_unique<BedOfDevice<Dim>>();
  return {bed_->material(),
          [this](const Columns& of_blocks, const Columns& of_candidates) {
            bed_of_device_->columns.clear();
            for (const auto& column : of_blocks) {
              bed_of_device_->columns.push_back(bed_->number_of(column));
            }
            bed_of_device_->nodes.clear();
            for (const auto& column : of_candidates) {
              bed_of_device_->nodes.push_back({bed_->number_of(column)});
            }
          },
          [this](const std::vector<std::uint32_t>& parts, const std::vector<Real>& loads) -> const std::vector<Real>& {
            BedOfDevice<Dim>& below = *bed_of_device_;
            for (std::size_t c = 0; c < parts.size(); ++c) {
              if (below.columns[c] != terrain::Bed<Dim>::outside) {
                bed_->cover(below.columns[c], parts[c]);
              }
            }
            for (std::size_t n = 0; n < loads.size(); ++n) {
              below.nodes[n].load = loads[n];
            }
            bed_->distribute(below.nodes);
            below.available.clear();
            for (const auto& node : below.nodes) {
              below.available.push_back(node.available);
            }
            return below.available;
          },
          [this](const std::vector<Real>& nodes) {
            bed_->age(dt_);
            const Real* record = nodes.data();
            for (const auto& node : bed_of_device_->nodes) {
              if (record[mpm::BedLayout<Dim>::entrained] > Real(0)) {
                bed_->collect(node.column, record, record[mpm::BedLayout<Dim>::size]);
              }
              record += device::bed_record_size<Dim>;
            }
          }};
}

#define THAWSLIDE_INSTANTIATE(Dim) template device::HostBed<Dim> Simulation<Dim>::host_bed();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
