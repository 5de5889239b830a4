// What the processor keeps of an erodible bed below a slide whose steps a device takes.
#pragma once

#include <cstddef>
#include <vector>

#include "terrain/bed.hpp"

namespace thawslide::sim {

template <int Dim, class Real>
struct BedOfDevice {
  std::vector<std::size_t> columns;  // that the active blocks stand over, by their numbers in the bed
  std::vector<typename terrain::Bed<Dim, Real>::Pressing> nodes;  // that may touch the ground
  std::vector<Real> available;                                    // to these [kg]
};

}  // namespace thawslide::sim
