// CPU data of the erodible bed in a simulation on a device.
#pragma once

#include <cstddef>
#include <vector>

#include "terrain/bed.hpp"

namespace thawslide::sim {

template <int Dim>
struct BedOfDevice {
  std::vector<std::size_t> columns;                         // below the active blocks: column numbers in the bed
  std::vector<typename terrain::Bed<Dim>::Pressing> nodes;  // that may touch the ground
  std::vector<Real> available;                              // mass available to these nodes [kg]
};

}  // namespace thawslide::sim
