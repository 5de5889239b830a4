// Thickness of the band's cells along the ground (terrain/layer_thickness.hpp), in device memory. The CPU evaluates it
// at the middles of columns; particles interpolate between them.
#pragma once

#include <cmath>
#include <utility>

#include "device/array.hpp"
#include "device/stacks.hpp"
#include "device/step_model.hpp"
#include "terrain/between_middles.hpp"

namespace thawslide::device {

// Layer thickness as seen from the particles of one tile.
template <int Dim>
struct LayersOfTile {
  TileTables<Dim> tables;
  const std::uint32_t* stack_of_block;
  const double* at_middle;  // by stack and column [m]
  double cell;
  std::size_t tile;

  [[nodiscard]] THAWSLIDE_HD double at(const std::array<double, Dim - 1>& position) const {
    using T = mpm::Tile<Dim>;
    using std::floor;
    const typename T::Index corner = T::node(T::index(tables.tile_keys[tile]), 0);
    ColumnIndex<Dim> first{};
    std::array<double, Dim - 1> fraction{};
    for (std::size_t a = 0; a < first.size(); ++a) {
      const double in_columns = position[a] / cell + 0.5;  // 1 in the middle of column 0
      const int left = static_cast<int>(floor(in_columns)) - 1 - corner[a];
      first[a] = left < -1 ? -1 : left;  // rounding can yield the column before, whose weight is then zero
      fraction[a] = in_columns - floor(in_columns);
    }
    return terrain::between_middles(fraction, [&](const ColumnIndex<Dim>& steps) {
      ColumnIndex<Dim> column = first;
      for (std::size_t a = 0; a < column.size(); ++a) {
        column[a] += steps[a];
      }
      return at_middle[index_of_column<Dim>(tables, stack_of_block, tile, column)];
    });
  }
};

template <class Backend, int Dim>
class LayerThickness {
 public:
  LayerThickness(Backend& backend, LayerAtMiddle<Dim> at_middle)
      : host_(std::move(at_middle)), stack_(backend), at_middle_(backend) {}

  [[nodiscard]] bool exists() const { return static_cast<bool>(host_); }

  // Call after blocks have changed.
  void update(const std::vector<std::uint64_t>& blocks) {
    const Stacks<Dim> stacks(blocks);
    std::vector<double> at_middle;
    for (const ColumnIndex<Dim>& column : stacks.columns) {
      at_middle.push_back(host_(column));
    }
    stack_.set(stacks.of_block);
    at_middle_.set(at_middle);
  }

  [[nodiscard]] LayersOfTile<Dim> layers(const TileTables<Dim>& tables, Real cell) const {
    return {tables, stack_.data(), at_middle_.data(), static_cast<double>(cell), 0};
  }

 private:
  LayerAtMiddle<Dim> host_;
  Array<std::uint32_t, Backend> stack_;
  Array<double, Backend> at_middle_;
};

}  // namespace thawslide::device
