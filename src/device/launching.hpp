// How kernels go to a card.
#pragma once

namespace thawslide::device {

// Together, as a graph, when the processor next waits for the card; or each by itself, at once.
enum class Launching { in_graphs, one_by_one };

}  // namespace thawslide::device
