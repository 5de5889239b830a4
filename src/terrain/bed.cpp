#include "terrain/bed.hpp"

#include <algorithm>

#include "base/instances.hpp"

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
void Bed<Dim, Real>::share_out(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                               mpm::Nodes<Dim, Real>& nodes) const {
  nodes.bed.hold(grid.blocks().size(), [&](std::size_t b) { return nodes.base.holds(b); });
  struct Pressing {
    std::size_t block, node, column;
  };
  struct Pressed {
    Real load = 0, covered = 0, area = 0;  // [kg m/s], [m2], [m2]
  };
  std::vector<Pressing> pressing;
  std::map<std::size_t, Pressed> pressed;  // by column where some of the bed is left
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    for (std::size_t k = 0; nodes.base.holds(b) && k < nodes.base.nodes; ++k) {
      nodes.bed.of_block(b)[k] = {};
      const Column column = column_of(grid, b, k);
      if (!ground.block(b)[k].candidate || !holds(column) || !(left_[number_of(column)] > Real(0))) {
        continue;
      }
      const auto& base = nodes.base(b, k);
      Pressed& all = pressed[number_of(column)];
      all.load += base[BaseLayout::load];
      all.covered += base[BaseLayout::covered];
      all.area += ground.block(b)[k].area;
      if (base[BaseLayout::load] > Real(0)) {
        pressing.push_back({b, k, number_of(column)});
      }
    }
  }
  for (const Pressing& at : pressing) {
    const Pressed& all = pressed[at.column];
    const Real bare = all.area > all.covered ? initial_[at.column] * (Real(1) - all.covered / all.area) : Real(0);
    const Real share = nodes.base(at.block, at.node)[BaseLayout::load] / all.load;
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

// Columns that the slide has taken from, as number and what is left; then what is loose.
template <int Dim, class Real>
std::vector<double> Bed<Dim, Real>::state() const {
  std::vector<double> numbers{0.0};
  for (std::size_t c = 0; c < left_.size(); ++c) {
    if (left_[c] != initial_[c]) {
      numbers.insert(numbers.end(), {static_cast<double>(c), static_cast<double>(left_[c])});
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
  loose_.clear();
  std::size_t k = 0;
  const auto next = [&] { return static_cast<Real>(numbers.at(k++)); };
  const auto next_column = [&] { return static_cast<std::size_t>(numbers.at(k++)); };
  const std::size_t taken_from = next_column();
  for (std::size_t c = 0; c < taken_from; ++c) {
    const std::size_t column = next_column();
    left_.at(column) = next();
  }
  while (k < numbers.size()) {
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
