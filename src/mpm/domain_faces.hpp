// Condition at nodes: faces of the domain (Sec. 3.2), which hold all components of velocity or the one across them.
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "physics/options.hpp"

namespace thawslide::mpm {

using physics::BoundaryKind;

template <int Dim>
struct DomainFaces {
  static constexpr bool moves = false;

  Vector<double, Dim> extent;        // upper corner of the domain [m]; the lower corner is the origin
  BoundaryKind faces[2 * Dim] = {};  // lower and upper face of each axis

  [[nodiscard]] THAWSLIDE_HD bool at_lower(double along, int a) const { return along <= round_off * extent[a]; }
  [[nodiscard]] THAWSLIDE_HD bool at_upper(double along, int a) const { return along >= extent[a] * (1.0 - round_off); }

  [[nodiscard]] THAWSLIDE_HD bool may_apply(const Vector<double, Dim>& lower, const Vector<double, Dim>& upper,
                                            double /*time*/) const {
    for (int a = 0; a < Dim; ++a) {
      if ((at_lower(lower[a], a) && faces[2 * a] != BoundaryKind::open) ||
          (at_upper(upper[a], a) && faces[2 * a + 1] != BoundaryKind::open)) {
        return true;
      }
    }
    return false;
  }
  THAWSLIDE_HD void apply(const Vector<double, Dim>& position, double /*mass*/, double /*time*/,
                          Vector<double, Dim>& momentum) const {
    for (int a = 0; a < Dim; ++a) {
      const BoundaryKind kind = at_lower(position[a], a)   ? faces[2 * a]
                                : at_upper(position[a], a) ? faces[2 * a + 1]
                                                           : BoundaryKind::open;
      if (kind == BoundaryKind::fixed) {
        momentum.setZero();
      } else if (kind == BoundaryKind::roller) {
        momentum[a] = 0.0;
      }
    }
  }
};

}  // namespace thawslide::mpm
