#include "terrain/bed.hpp"

#include <algorithm>
#include <bit>

#include "base/instances.hpp"
#include "base/state_numbers.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

using mpm::BaseLayout;

template <int Dim>
typename Bed<Dim>::Column Bed<Dim>::column_of(const mpm::SparseGrid<Dim>& grid, std::size_t block,
                                              std::size_t node) const {
  using T = mpm::Tile<Dim>;
  const typename T::Index index = T::node(T::index(grid.blocks()[block]), static_cast<int>(node));
  Column column{};
  std::copy_n(index.begin(), column.size(), column.begin());
  return column;
}

template <int Dim>
std::size_t Bed<Dim>::number_of(const Column& column) const {
  std::size_t number = 0;
  for (std::size_t a = column.size(); a-- > 0;) {
    if (column[a] < 0 || column[a] >= columns_[a]) {
      return outside;
    }
    number = number * static_cast<std::size_t>(columns_[a]) + static_cast<std::size_t>(column[a]);
  }
  return number;
}

template <int Dim>
typename Bed<Dim>::Column Bed<Dim>::column_at(std::size_t number) const {
  const auto along_x = static_cast<std::size_t>(columns_[0]);
  Column column{static_cast<int>(number % along_x)};
  if constexpr (Dim == 3) {
    column[1] = static_cast<int>(number / along_x);
  }
  return column;
}

template <int Dim>
void Bed<Dim>::cover_part(const std::array<int, 2>& part) {
  Column column{};
  int bit = 0;
  for (std::size_t a = column.size(); a-- > 0;) {
    column[a] = part[a] >= 0 ? part[a] / bed_parts : -1;
    bit = bit * bed_parts + part[a] % bed_parts;
  }
  if (number_of(column) != outside) {
    cover(number_of(column), 1U << bit);
  }
}

// A part is covered if the box of a particle near the ground reaches its centre.
template <int Dim>
void Bed<Dim>::cover(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground, const mpm::BodySizes& sizes,
                     const mpm::Particles<Dim>& particles) {
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    if (!ground.any_near(t)) {
      continue;
    }
    for (std::uint32_t k = grid.tiles()[t].first; k < grid.tiles()[t].last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const double half = sizes.half(static_cast<std::size_t>(particles.body(p)));
      for_covered_parts<Dim>(particles, p, half, grid.cell(), [&](const auto& part) { cover_part(part); });
    }
  }
}

template <int Dim>
void Bed<Dim>::distribute(const mpm::SparseGrid<Dim>& grid, mpm::Nodes<Dim>& nodes) const {
  nodes.bed.allocate(grid.blocks().size(), [&](std::size_t b) { return nodes.base.contains(b); });
  struct Point {
    std::size_t block, node;
  };
  std::vector<Point> points;
  std::vector<Pressing> pressing;
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    for (std::size_t k = 0; nodes.base.contains(b) && k < nodes.base.nodes; ++k) {
      nodes.bed.of_block(b)[k] = {};
      if (nodes.base(b, k)[BaseLayout::load] > 0.0) {
        points.push_back({b, k});
        pressing.push_back({number_of(column_of(grid, b, k)), nodes.base(b, k)[BaseLayout::load]});
      }
    }
  }
  distribute(pressing);
  for (std::size_t n = 0; n < points.size(); ++n) {
    nodes.bed.of_block(points[n].block)[points[n].node][Layout::available] = pressing[n].available;
  }
}

template <int Dim>
void Bed<Dim>::distribute(std::vector<Pressing>& nodes) const {
  const auto has_bed = [&](const Pressing& node) {
    return node.load > 0.0 && node.column != outside && left_[node.column] > 0.0;
  };
  std::map<std::size_t, double> load;  // by column with remaining bed [kg m/s]
  for (const Pressing& node : nodes) {
    if (has_bed(node)) {
      load[node.column] += node.load;
    }
  }
  constexpr int all_parts = Dim == 2 ? bed_parts : bed_parts * bed_parts;
  for (Pressing& node : nodes) {
    node.available = 0.0;
    if (has_bed(node)) {
      const int bare_parts = all_parts - std::popcount(covered_[node.column]);
      const double bare = initial_[node.column] * static_cast<double>(bare_parts) / double(all_parts);
      node.available = node.load / load[node.column] * std::max(left_[node.column] - bare, 0.0);
    }
  }
}

template <int Dim>
void Bed<Dim>::collect(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes, double dt) {
  age(dt);
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    for (std::size_t k = 0; nodes.bed.contains(b) && k < nodes.bed.nodes; ++k) {
      const auto& contact = nodes.contact(b, k);
      if (nodes.bed(b, k)[Layout::entrained] > 0.0) {
        collect(number_of(column_of(grid, b, k)), nodes.bed(b, k).data(),
                contact[mpm::Contact::normal_force] / contact[mpm::Contact::area]);
      }
    }
  }
}

template <int Dim>
void Bed<Dim>::age(double dt) {
  for (auto& [column, material] : loose_) {
    material.idle += dt;
  }
}

template <int Dim>
void Bed<Dim>::collect(std::size_t column, const double* record, double normal_pressure) {
  const double entrained = record[Layout::entrained];
  LooseMaterial<Dim>& material = loose_[column];
  left_[column] = std::max(left_[column] - entrained, 0.0);  // the shares sum to it up to round-off
  material.mass += entrained;
  material.momentum += mpm::vector_at<Dim>(record, Layout::impulse);
  material.work += record[Layout::work];
  material.normal_pressure = normal_pressure;
  material.idle = 0.0;
}

template <int Dim>
void Bed<Dim>::release(const std::function<bool(const Column&, const LooseMaterial<Dim>&)>& join) {
  for (auto at = loose_.begin(); at != loose_.end();) {
    at = join(column_at(at->first), at->second) ? loose_.erase(at) : std::next(at);
  }
}

template <int Dim>
typename Bed<Dim>::Sums Bed<Dim>::sums() const {
  Sums sums;
  for (std::size_t c = 0; c < left_.size(); ++c) {
    sums.initial += initial_[c];
    sums.left += left_[c];
  }
  for (const auto& [column, material] : loose_) {
    sums.loose += material.mass;
    sums.loose_work += material.work;
  }
  return sums;
}

// Checkpoint state: number, remaining mass and covered parts of the columns that have been covered or entrained; then
// the loose material.
template <int Dim>
std::vector<double> Bed<Dim>::state() const {
  std::vector<double> numbers{0.0};
  for (std::size_t c = 0; c < left_.size(); ++c) {
    if (left_[c] != initial_[c] || covered_[c] != 0) {
      numbers.insert(numbers.end(), {static_cast<double>(c), left_[c], static_cast<double>(covered_[c])});
      ++numbers[0];
    }
  }
  for (const auto& [column, material] : loose_) {
    numbers.push_back(static_cast<double>(column));
    for (const double number : {material.mass, material.work, material.normal_pressure, material.idle}) {
      numbers.push_back(number);
    }
    for (int a = 0; a < Dim; ++a) {
      numbers.push_back(material.momentum[a]);
    }
  }
  return numbers;
}

template <int Dim>
void Bed<Dim>::restore(const std::vector<double>& numbers) {
  left_ = initial_;
  covered_.assign(covered_.size(), 0);
  loose_.clear();
  StateNumbers state(numbers, "bed");
  const auto next = [&] { return state.next_finite(); };
  const auto next_column = [&] {
    return static_cast<std::size_t>(state.whole(static_cast<std::int64_t>(left_.size()) - 1));
  };
  constexpr std::size_t of_column = 3;  // numbers per column: column number, remaining mass, covered parts
  const std::size_t changed = state.count(of_column);
  for (std::size_t c = 0; c < changed; ++c) {
    const std::size_t column = next_column();
    left_[column] = next();
    covered_[column] = static_cast<std::uint16_t>(state.whole(std::numeric_limits<std::uint16_t>::max()));
  }
  while (state.left() > 0) {
    LooseMaterial<Dim>& material = loose_[next_column()];
    for (double* number : {&material.mass, &material.work, &material.normal_pressure, &material.idle}) {
      *number = next();
    }
    for (int a = 0; a < Dim; ++a) {
      material.momentum[a] = next();
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim) template class Bed<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
