// Entrainment of the bed by one node, and bed parts covered by a particle. For host and device.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/select.hpp"
#include "mpm/records.hpp"
#include "mpm/vectors_in_records.hpp"
#include "physics/entrainment.hpp"
#include "physics/options.hpp"
#include "terrain/contact_node.hpp"

namespace thawslide::terrain {

using physics::BedLaw;

struct BedMaterial {
  BedLaw law = BedLaw::momentum;
  double cohesion = 0, tangent = 0;  // of the bed strength: c_b [Pa], tan(phi_b)
  double depth_per_slip = 0;         // [1]
  double density = 0;                // [kg/m3]
};

// Parts of a column of nodes along each axis, covered individually.
inline constexpr int bed_parts = 4;

// Parts, along one axis, whose centres the box of a particle reaches. They are counted from the domain's lower corner;
// the first part of column 0 begins half a column below it. half: of the box, in cells.
struct PartsCovered {
  int first, last;
};
inline THAWSLIDE_HD PartsCovered parts_covered(double position, double half, double cell) {
  using std::ceil, std::floor;
  const double middle = (position / cell + 0.5) * bed_parts - 0.5;
  const double reach = half * bed_parts;
  return {static_cast<int>(ceil(middle - reach)), static_cast<int>(floor(middle + reach))};
}

// Calls visit(part) for the parts whose centres a particle's box reaches; part: index along each horizontal axis. Parts
// outside the domain have negative indices or large ones. half: of the box, in cells.
template <int Dim, class Particles, class Visit>
THAWSLIDE_HD void for_covered_parts(const Particles& particles, std::uint32_t p, double half, double cell,
                                    const Visit& visit) {
  const PartsCovered x = parts_covered(particles.position(p, 0), half, cell);
  PartsCovered y{0, 0};
  if constexpr (Dim == 3) {
    y = parts_covered(particles.position(p, 1), half, cell);
  }
  for (int row = y.first; row <= y.last; ++row) {
    for (int column = x.first; column <= x.last; ++column) {
      visit(std::array<int, 2>{column, row});
    }
  }
}

// Entrainment by a node of a mass [kg] that slides at `speed` > 0 [m/s] after friction with the strength `shear` [Pa].
// available: bed mass available to it [kg].
inline THAWSLIDE_HD EntrainmentImpulse entrainment_of(const BedMaterial& material, double available, double mass,
                                                      double speed, double shear, double normal_pressure, double area,
                                                      double dt) {
  const double strength = physics::bed_strength(material.cohesion, material.tangent, normal_pressure);
  const double rate =
      material.law == BedLaw::strength
          ? physics::erosion_by_strength(shear, strength, speed, material.depth_per_slip)
          : physics::erosion_by_momentum(shear, strength, material.density, speed, material.depth_per_slip);
  const double entrained = min(available, material.density * rate * area * dt);
  if (material.law == BedLaw::momentum) {
    return {entrained, entrained * speed, entrained * speed};
  }
  return {entrained, entrained * physics::speed_after_entrainment(mass, speed, entrained), 0.0};
}

// Entrainment by a sliding node. Fills its record of BedLayout; the momentum along the slip is that after friction.
// material: null if there is no bed.
template <int Dim>
struct BedBelowNode {
  const BedMaterial* material;
  double* record;
  double area, strength, dt, mass;

  template <int>
  [[nodiscard]] THAWSLIDE_HD EntrainmentImpulse entrain(const physics::ContactImpulse& impulse, double normal_pressure,
                                                        const Vector<double, Dim>& along,
                                                        double tangential_size) const {
    using Layout = mpm::BedLayout<Dim>;
    if (material == nullptr || !impulse.slides || !(record[Layout::available] > 0.0)) {
      return {};
    }
    const double speed = (tangential_size - impulse.tangential) / mass;
    const EntrainmentImpulse entrain =
        entrainment_of(*material, record[Layout::available], mass, speed, strength, normal_pressure, area, dt);
    record[Layout::entrained] = entrain.entrained;
    for (std::size_t a = 0; a < Dim; ++a) {
      record[Layout::impulse + a] = entrain.impulse * along[static_cast<int>(a)];
    }
    return entrain;
  }
  THAWSLIDE_HD void record_work(double work) const { record[mpm::BedLayout<Dim>::work] = work; }
};

}  // namespace thawslide::terrain
