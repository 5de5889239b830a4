#include "terrain/bed.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/instances.hpp"
#include "base/state_numbers.hpp"

namespace thawslide::terrain {

using mpm::BaseLayout;

template <int Dim, class Real>
typename Bed<Dim, Real>::Column Bed<Dim, Real>::column_of(const mpm::SparseGrid<Dim, Real>& grid, std::size_t block,
                                                          std::size_t node) const {
  using T = mpm::Tile<Dim>;
  const typename T::Index index = T::node(T::index(grid.blocks()[block]), static_cast<int>(node));
  Column column{};
  std::copy_n(index.begin(), column.size(), column.begin());
  return column;
}

template <int Dim, class Real>
bool Bed<Dim, Real>::holds(const Column& column) const {
  for (std::size_t a = 0; a < column.size(); ++a) {
    if (column[a] < 0 || column[a] >= columns_[a]) {
      return false;
    }
  }
  return true;
}

template <int Dim, class Real>
std::size_t Bed<Dim, Real>::number_of(const Column& column) const {
  auto number = static_cast<std::size_t>(column[0]);
  if constexpr (Dim == 3) {
    number += static_cast<std::size_t>(column[1]) * static_cast<std::size_t>(columns_[0]);
  }
  return number;
}

template <int Dim, class Real>
typename Bed<Dim, Real>::Column Bed<Dim, Real>::column_at(std::size_t number) const {
  const auto along_x = static_cast<std::size_t>(columns_[0]);
  Column column{static_cast<int>(number % along_x)};
  if constexpr (Dim == 3) {
    column[1] = static_cast<int>(number / along_x);
  }
  return column;
}

template <int Dim, class Real>
void Bed<Dim, Real>::cover_part(const Column& part) {
  Column column{};
  int bit = 0;
  for (std::size_t a = part.size(); a-- > 0;) {
    column[a] = part[a] >= 0 ? part[a] / parts : -1;
    bit = bit * parts + part[a] % parts;
  }
  if (holds(column)) {
    covered_[number_of(column)] |= static_cast<std::uint16_t>(1U << bit);
  }
}

// A part is covered where the box of a particle near the ground reaches its middle.
template <int Dim, class Real>
void Bed<Dim, Real>::cover(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                           const mpm::BodySizes<Real>& sizes, const mpm::Particles<Dim, Real>& particles) {
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    if (!ground.any_near(t)) {
      continue;
    }
    for (std::uint32_t k = grid.tiles()[t].first; k < grid.tiles()[t].last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const Real half = sizes.half(static_cast<std::size_t>(particles.body(p))) * parts;  // in parts
      Column first{}, last{};
      for (int a = 0; a + 1 < Dim; ++a) {
        // The first part of column 0 begins half a column below the domain's corner.
        const Real middle = (particles.position(p, a) / grid.cell() + Real(0.5)) * parts - Real(0.5);
        first[static_cast<std::size_t>(a)] = static_cast<int>(std::ceil(middle - half));
        last[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(middle + half));
      }
      Column part = first;
      for (part[0] = first[0]; part[0] <= last[0]; ++part[0]) {
        if constexpr (Dim == 3) {
          for (part[1] = first[1]; part[1] <= last[1]; ++part[1]) {
            cover_part(part);
          }
        } else {
          cover_part(part);
        }
      }
    }
  }
}

template <int Dim, class Real>
void Bed<Dim, Real>::share_out(const mpm::SparseGrid<Dim, Real>& grid, mpm::Nodes<Dim, Real>& nodes) const {
  nodes.bed.hold(grid.blocks().size(), [&](std::size_t b) { return nodes.base.holds(b); });
  struct Pressing {
    std::size_t block, node, column;
  };
  std::vector<Pressing> pressing;
  std::map<std::size_t, Real> load;  // by column where some of the bed is left [kg m/s]
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    for (std::size_t k = 0; nodes.base.holds(b) && k < nodes.base.nodes; ++k) {
      nodes.bed.of_block(b)[k] = {};
      const Real of_node = nodes.base(b, k)[BaseLayout::load];
      const Column column = column_of(grid, b, k);
      if (of_node > Real(0) && holds(column) && left_[number_of(column)] > Real(0)) {
        pressing.push_back({b, k, number_of(column)});
        load[number_of(column)] += of_node;
      }
    }
  }
  constexpr int all_parts = Dim == 2 ? parts : parts * parts;
  for (const Pressing& at : pressing) {
    const int bare_parts = all_parts - std::popcount(covered_[at.column]);
    const Real bare = initial_[at.column] * static_cast<Real>(bare_parts) / Real(all_parts);
    const Real share = nodes.base(at.block, at.node)[BaseLayout::load] / load[at.column];
    nodes.bed.of_block(at.block)[at.node][Layout::available] = share * std::max(left_[at.column] - bare, Real(0));
  }
}

template <int Dim, class Real>
Bite<Real> Bed<Dim, Real>::bite(Real available, Real mass, Real speed, Real shear, Real normal_pressure, Real area,
                                Real dt) const {
  const Real strength = physics::bed_strength(matter_.cohesion, matter_.tangent, normal_pressure);
  const Real rate = matter_.law == BedLaw::strength
                        ? physics::erosion_by_strength(shear, strength, speed, matter_.depth_per_slip)
                        : physics::erosion_by_momentum(shear, strength, matter_.density, speed, matter_.depth_per_slip);
  const Real taken = std::min(available, matter_.density * rate * area * dt);
  if (matter_.law == BedLaw::momentum) {
    return {taken, taken * speed, taken * speed};
  }
  return {taken, taken * physics::speed_with_taken(mass, speed, taken), Real(0)};
}

template <int Dim, class Real>
void Bed<Dim, Real>::collect(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Nodes<Dim, Real>& nodes, Real dt) {
  for (auto& [column, matter] : loose_) {
    matter.idle += dt;
  }
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    for (std::size_t k = 0; nodes.bed.holds(b) && k < nodes.bed.nodes; ++k) {
      const auto& of_node = nodes.bed(b, k);
      const Real taken = of_node[Layout::taken];
      if (!(taken > Real(0))) {
        continue;
      }
      const std::size_t column = number_of(column_of(grid, b, k));
      LooseMatter<Dim, Real>& matter = loose_[column];
      left_[column] = std::max(left_[column] - taken, Real(0));  // of shares that sum to it but for rounding
      matter.mass += taken;
      matter.momentum += mpm::vector_at<Dim, Real>(of_node, Layout::impulse);
      matter.work += of_node[Layout::work];
      matter.normal_pressure =
          nodes.contact(b, k)[mpm::Contact::normal_force] / nodes.contact(b, k)[mpm::Contact::area];
      matter.idle = Real(0);
    }
  }
}

template <int Dim, class Real>
void Bed<Dim, Real>::release(const std::function<bool(const Column&, const LooseMatter<Dim, Real>&)>& join) {
  for (auto at = loose_.begin(); at != loose_.end();) {
    at = join(column_at(at->first), at->second) ? loose_.erase(at) : std::next(at);
  }
}

template <int Dim, class Real>
typename Bed<Dim, Real>::Sums Bed<Dim, Real>::sums() const {
  Sums sums;
  for (std::size_t c = 0; c < left_.size(); ++c) {
    sums.initial += initial_[c];
    sums.left += left_[c];
  }
  for (const auto& [column, matter] : loose_) {
    sums.loose += matter.mass;
    sums.loose_work += matter.work;
  }
  return sums;
}

// Columns that the slide has covered or taken from, as number, what is left and parts; then what is loose.
template <int Dim, class Real>
std::vector<double> Bed<Dim, Real>::state() const {
  std::vector<double> numbers{0.0};
  for (std::size_t c = 0; c < left_.size(); ++c) {
    if (left_[c] != initial_[c] || covered_[c] != 0) {
      numbers.insert(numbers.end(),
                     {static_cast<double>(c), static_cast<double>(left_[c]), static_cast<double>(covered_[c])});
      ++numbers[0];
    }
  }
  for (const auto& [column, matter] : loose_) {
    numbers.push_back(static_cast<double>(column));
    for (const Real number : {matter.mass, matter.work, matter.normal_pressure, matter.idle}) {
      numbers.push_back(static_cast<double>(number));
    }
    for (int a = 0; a < Dim; ++a) {
      numbers.push_back(static_cast<double>(matter.momentum[a]));
    }
  }
  return numbers;
}

template <int Dim, class Real>
void Bed<Dim, Real>::restore(const std::vector<double>& numbers) {
  left_ = initial_;
  covered_.assign(covered_.size(), 0);
  loose_.clear();
  StateNumbers state(numbers, "bed");
  const auto next = [&] { return static_cast<Real>(state.next_finite()); };
  const auto next_column = [&] {
    return static_cast<std::size_t>(state.whole(static_cast<std::int64_t>(left_.size()) - 1));
  };
  constexpr std::size_t of_column = 3;  // numbers: which it is, what is left, the parts of it that are covered
  const std::size_t changed = state.count(of_column);
  for (std::size_t c = 0; c < changed; ++c) {
    const std::size_t column = next_column();
    left_[column] = next();
    covered_[column] = static_cast<std::uint16_t>(state.whole(std::numeric_limits<std::uint16_t>::max()));
  }
  while (state.left() > 0) {
    LooseMatter<Dim, Real>& matter = loose_[next_column()];
    for (Real* number : {&matter.mass, &matter.work, &matter.normal_pressure, &matter.idle}) {
      *number = next();
    }
    for (int a = 0; a < Dim; ++a) {
      matter.momentum[a] = next();
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) template class Bed<Dim, Real>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
