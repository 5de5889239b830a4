// Columns of the sliding mass on an executor. They are renumbered when tiles change, by sorting the keys of the columns
// that each tile overlaps: 6 per tile in 2D, 36 in 3D. A full 3D tile has about 500 particles, whose keys are sorted
// more often. The CPU then evaluates the terrain at new columns.
#pragma once

#include <utility>
#include <vector>

#include "band/column_boxes.hpp"
#include "band/slide_column_kernels.hpp"
#include "exec/keyed_parts.hpp"

namespace thawslide::band {

template <class Executor, int Dim>
class SlideColumns {
 public:
  // Data of columns by horizontal position [m]. Each must be the same in every call.
  struct AtColumns {
    // Slope cosine of the terrain; empty: level ground.
    OfPosition<Dim> slope_cosine;
    // Gravity component that loads the ground per mass and footprint [m/s2]: g.n times the slope cosine, because the
    // ground area exceeds the footprint by its inverse. Empty: no loads are computed.
    OfPosition<Dim> normal_gravity;
    // Relative width of a 2D section; empty: uniform.
    OfPosition<Dim> width;
  };

  // sizes: half sizes of particles [m]. has_ground: heights of particles are above the ground (mpm/mapping.hpp).
  SlideColumns(Executor& executor, double cell, bool has_ground, const mpm::SizesOfBodies& sizes, AtColumns data)
      : executor_(executor),
        cell_(cell),
        has_ground_(has_ground),
        sizes_(sizes),
        slope_cosine_{std::move(data.slope_cosine), {}, exec::Array<double, Executor>(executor)},
        normal_gravity_{std::move(data.normal_gravity), {}, exec::Array<double, Executor>(executor)},
        width_{std::move(data.width), {}, exec::Array<double, Executor>(executor)} {}

  // Call after tiles have changed.
  void update(const std::uint64_t* tile_keys, std::size_t tiles) {
    parts_.list(tiles * columns_per_tile<Dim>, KeyOfColumn<Dim>{tile_keys});
    parts_.places().index(column_);
    const std::size_t columns = parts_.keys().size();
    adjacent_.resize(columns * column_sides<Dim>);
    executor_.for_each(adjacent_.size(), FindNeighbourColumns<Dim>{parts_.keys().data(), columns, adjacent_.data()});
    for (exec::Array<double, Executor>* numbers : {&thickness_, &top_, &load_per_depth_}) {
      numbers->resize(columns);
    }
    evaluate_at_new_columns();
  }

  // Updates the columns from positions, volumes and masses. tile_keys: of the last update. add_boxes(boxes): adds the
  // boxes of particles (mpm/box_sums.hpp).
  template <class AddBoxes>
  void sum(const std::uint64_t* tile_keys, const AddBoxes& add_boxes) {
    executor_.for_each(parts_.size(), exec::Fill<ColumnPart<Dim>>{parts_.parts(), {}});
    add_boxes(ColumnBoxes<Dim>{
        parts_.size() / columns_per_tile<Dim>, tile_keys, sizes_, cell_, {has_ground_}, parts_.parts()});
    parts_.sum();
    executor_.for_each(parts_.keys().size(),
                       FinishColumns<Dim>{parts_.sums(), adjacent_.data(), width_.values.data(),
                                          normal_gravity_.function ? normal_gravity_.values.data() : nullptr, cell_,
                                          thickness_.data(), top_.data(), load_per_depth_.data()});
  }

  template <class Numbers>
  [[nodiscard]] ColumnsByTile<Dim, Numbers> by_tile(const std::uint64_t* tile_keys) const {
    return by_tile_with<Numbers>(tile_keys, slope_cosine_.values);
  }
  // Columns with the load per depth [Pa/m] in place of the slope's cosine: the flow depth of a particle is then its
  // load.
  template <class Numbers>
  [[nodiscard]] ColumnsByTile<Dim, Numbers> loading_by_tile(const std::uint64_t* tile_keys) const {
    return by_tile_with<Numbers>(tile_keys, load_per_depth_);
  }

 private:
  // Function of the position, and its values at the columns.
  struct AtColumn {
    OfPosition<Dim> function;
    std::vector<double> known;
    exec::Array<double, Executor> values;
  };

  void evaluate_at_new_columns() {
    const std::vector<std::uint64_t> keys = parts_.keys().get();
    const std::vector<std::int32_t> before = exec::index_map(known_keys_, keys);
    for (AtColumn* data : {&slope_cosine_, &normal_gravity_, &width_}) {
      std::vector<double> values(keys.size(), 1.0);
      for (std::size_t k = 0; data->function && k < keys.size(); ++k) {
        values[k] = before[k] != exec::absent ? data->known[static_cast<std::size_t>(before[k])]
                                              : data->function(middle_of_column<Dim>(keys[k], cell_));
      }
      data->values.set(values);
      data->known = std::move(values);
    }
    known_keys_ = keys;
  }

  template <class Numbers>
  [[nodiscard]] ColumnsByTile<Dim, Numbers> by_tile_with(const std::uint64_t* tile_keys,
                                                         const exec::Array<double, Executor>& cosine) const {
    return {tile_keys, column_.data(), sizes_, cell_, has_ground_, thickness_.data(), top_.data(), cosine.data()};
  }

  Executor& executor_;
  double cell_;
  bool has_ground_;
  mpm::SizesOfBodies sizes_;
  AtColumn slope_cosine_, normal_gravity_, width_;
  std::vector<std::uint64_t> known_keys_;  // of the columns
  exec::KeyedParts<ColumnPart<Dim>, Executor> parts_{executor_};
  exec::Array<std::int32_t, Executor> column_{executor_}, adjacent_{executor_};
  exec::Array<double, Executor> thickness_{executor_}, top_{executor_}, load_per_depth_{executor_};
};

}  // namespace thawslide::band
