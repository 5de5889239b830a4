// Entrainment of the bed by one node, and bed parts covered by a particle. For host and device.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/records.hpp"
#include "mpm/tile.hpp"
#include "physics/contact.hpp"
#include "physics/entrainment.hpp"
#include "physics/options.hpp"

namespace thawslide::terrain {

using physics::BedLaw;

struct BedMaterial {
  BedLaw law = BedLaw::momentum;
  double cohesion = 0, tangent = 0;  // of the bed strength: c_b [Pa], tan(phi_b)
  double depth_per_slip = 0;         // [1]
  double density = 0;                // [kg/m3]
};

// Columns of nodes of the domain: nodes with the same indices along the horizontal axes. The first column is at the
// domain's lower corner.
template <int Dim>
struct BedColumns {
  using Column = std::array<int, Dim - 1>;
  static constexpr std::size_t outside = ~std::size_t{0};

  Column count{};  // along each axis

  // Number of a column, x fastest; `outside` if it is outside the domain.
  [[nodiscard]] THAWSLIDE_HD std::size_t number_of(const Column& column) const {
    std::size_t number = 0;
    for (std::size_t a = Dim - 1; a-- > 0;) {
      if (column[a] < 0 || column[a] >= count[a]) {
        return outside;
      }
      number = number * static_cast<std::size_t>(count[a]) + static_cast<std::size_t>(column[a]);
    }
    return number;
  }
  // The same for the column of a node of a block.
  [[nodiscard]] THAWSLIDE_HD std::size_t number_of(std::uint64_t block, std::size_t node) const {
    using T = mpm::Tile<Dim>;
    const typename T::Index index = T::node(T::index(block), static_cast<int>(node));
    Column column{};
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      column[a] = index[a];
    }
    return number_of(column);
  }
};

// Parts of a column of nodes along each axis, covered individually, and their number.
inline constexpr int bed_parts = 4;
template <int Dim>
inline constexpr int parts_of_column = mpm::power(bed_parts, Dim - 1);

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

// Calls visit(number of the column, part) for the parts of the domain whose centres a particle's box reaches. half: of
// the box, in cells.
template <int Dim, class Particles, class Visit>
THAWSLIDE_HD void for_covered_parts(const BedColumns<Dim>& columns, const Particles& particles, std::uint32_t p,
                                    double half, double cell, const Visit& visit) {
  const PartsCovered x = parts_covered(particles.position(p, 0), half, cell);
  PartsCovered y{0, 0};
  if constexpr (Dim == 3) {
    y = parts_covered(particles.position(p, 1), half, cell);
  }
  for (int row = y.first; row <= y.last; ++row) {
    for (int along_x = x.first; along_x <= x.last; ++along_x) {
      const int index[] = {along_x, row};
      typename BedColumns<Dim>::Column column{};
      int part = 0;
      for (std::size_t a = Dim - 1; a-- > 0;) {
        column[a] = index[a] >= 0 ? index[a] / bed_parts : -1;
        part = part * bed_parts + index[a] % bed_parts;
      }
      if (const std::size_t number = columns.number_of(column); number != BedColumns<Dim>::outside) {
        visit(number, part);
      }
    }
  }
}

// Transfer from a contact node to the bed material in a step.
struct EntrainmentImpulse {
  double entrained = 0;    // [kg]
  double impulse = 0;      // along the slip [N s]
  double of_friction = 0;  // part of it already removed by friction [N s]
};

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

// Bed below the candidate nodes of a step, by their numbers.
template <int Dim>
struct BedBelowNodes {
  using Layout = mpm::BedLayout<Dim>;

  BedMaterial material;
  double* records;  // of BedLayout; null: there is no bed

  // Entrainment by a sliding node of a mass [kg] after friction with the strength of the base [Pa]. Fills the node's
  // record; the momentum along the slip is that after friction.
  [[nodiscard]] THAWSLIDE_HD EntrainmentImpulse entrain(std::size_t candidate, const physics::ContactImpulse& impulse,
                                                        double normal_pressure, double area, double strength, double dt,
                                                        double mass, const Vector<double, Dim>& along,
                                                        double tangential_size) const {
    double* record = records + candidate * Layout::size;
    if (records == nullptr || !impulse.slides || !(record[Layout::available] > 0.0)) {
      return {};
    }
    const double speed = (tangential_size - impulse.tangential) / mass;
    const EntrainmentImpulse entrain =
        entrainment_of(material, record[Layout::available], mass, speed, strength, normal_pressure, area, dt);
    record[Layout::entrained] = entrain.entrained;
    for (std::size_t a = 0; a < Dim; ++a) {
      record[Layout::impulse + a] = entrain.impulse * along[static_cast<int>(a)];
    }
    return entrain;
  }
  // The work on the entrained material [J], and the normal pressure on the bed [Pa].
  THAWSLIDE_HD void record(std::size_t candidate, double work, double normal_pressure) const {
    records[candidate * Layout::size + Layout::work] = work;
    records[candidate * Layout::size + Layout::normal_pressure] = normal_pressure;
  }
};

}  // namespace thawslide::terrain
