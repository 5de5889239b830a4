#include "terrain/bed.hpp"

#include "base/instances.hpp"
#include "base/state_numbers.hpp"

namespace thawslide::terrain {

template <int Dim>
typename Bed<Dim>::Column Bed<Dim>::column_at(std::size_t number) const {
  const auto along_x = static_cast<std::size_t>(columns_.count[0]);
  Column column{static_cast<int>(number % along_x)};
  if constexpr (Dim == 3) {
    column[1] = static_cast<int>(number / along_x);
  }
  return column;
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
