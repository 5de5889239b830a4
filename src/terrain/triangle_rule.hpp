// Quadrature on triangles.
#pragma once

#include <array>

namespace thawslide::terrain {

// Six-point rule on triangles, exact to the fourth degree: Dunavant (1985), Int. J. Numer. Meth. Eng. 21, table II.
// Each point has two equal barycentric coordinates.
struct RulePoint {
  double weight, twice;
};
inline constexpr std::array<RulePoint, 2> triangle_rule{RulePoint{0.22338158967801146570, 0.44594849091596488632},
                                                        RulePoint{0.10995174365532186764, 0.09157621350977074346}};

}  // namespace thawslide::terrain
