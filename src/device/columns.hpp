// Columns of the sliding mass in device memory, as in band/flow_depth.hpp. They are renumbered when tiles change, by
// sorting the keys of the columns that each tile overlaps: 6 per tile in 2D, 36 in 3D. A full 3D tile has about 500
// particles, whose keys are sorted more often. The CPU then copies the column keys and evaluates the terrain at new
// columns.
#pragma once

#include <utility>
#include <vector>

#include "band/at_columns.hpp"
#include "device/array.hpp"
#include "device/body_sizes.hpp"
#include "device/column_kernels.hpp"
#include "device/tile_tables.hpp"
#include "device/unique_keys.hpp"

namespace thawslide::device {

template <class Backend, int Dim>
class Columns {
  using Part = ColumnPart<Dim>;

 public:
  // half_sizes: of particles, by body, in cells. An empty slope_cosine means level ground; an empty normal_gravity
  // means that no loads are computed.
  Columns(Backend& backend, double cell, const mpm::Mapping& mapping, const std::vector<double>& half_sizes,
          band::OfPosition<Dim> slope_cosine, band::OfPosition<Dim> normal_gravity)
      : backend_(backend),
        cell_(cell),
        mapping_(mapping),
        slope_cosine_{std::move(slope_cosine), {}, Array<double, Backend>(backend)},
        normal_gravity_{std::move(normal_gravity), {}, Array<double, Backend>(backend)},
        sizes_(backend, half_sizes, cell) {}

  // Call after tiles have changed.
  void update(const TileTables<Dim>& tables) {
    keys_of_seen_.resize(tables.tiles * band::columns_per_tile<Dim>);
    seen_.resize(keys_of_seen_.size());
    keys_listed_.resize(keys_of_seen_.size());
    listed_.resize(keys_of_seen_.size());
    column_.resize(keys_of_seen_.size());
    parts_.resize(keys_of_seen_.size());
    backend_.for_each(seen_.size(), ListColumns<Dim>{tables.tile_keys, keys_listed_.data(), listed_.data()});
    backend_.sort(keys_listed_.data(), listed_.data(), keys_of_seen_.data(), seen_.data(), seen_.size());
    first_.find(keys_of_seen_, 0, keys_, &first_seen_);
    backend_.for_each(seen_.size(), NumberColumns{seen_.data(), first_.is_first(), first_.number(), column_.data()});
    adjacent_.resize(keys_.size() * band::column_sides<Dim>);
    backend_.for_each(adjacent_.size(), FindNeighbourColumns<Dim>{keys_.data(), keys_.size(), adjacent_.data()});
    sums_.resize(keys_.size());
    for (Array<double, Backend>* numbers : {&thickness_, &top_, &load_per_depth_}) {
      numbers->resize(keys_.size());
    }
    query_terrain();
  }

  // Updates the columns from positions, volumes and masses.
  void sum(const TileTables<Dim>& tables, const mpm::ParticleView<Dim>& particles) {
    using InTile = SumInTile<Dim>;
    backend_.for_groups(tables.tiles, InTile::at_a_time, InTile::bytes,
                        InTile{tables, particles, sizes_.view(), cell_, mapping_, parts_.data()});
    backend_.for_each(keys_.size(), SumParts<Part>{first_seen_.data(), seen_.data(), keys_.size(), seen_.size(),
                                                   parts_.data(), sums_.data()});
    backend_.for_each(keys_.size(),
                      FinishColumns<Dim>{sums_.data(), adjacent_.data(),
                                         normal_gravity_.function ? normal_gravity_.values.data() : nullptr, cell_,
                                         thickness_.data(), top_.data(), load_per_depth_.data()});
  }

  [[nodiscard]] ColumnsByTile<Dim> seen(const TileTables<Dim>& tables) const {
    return seen_with(tables, slope_cosine_.values);
  }
  // Columns with the load per depth [Pa/m] in place of the slope's cosine: the flow depth of a particle is then its
  // load.
  [[nodiscard]] ColumnsByTile<Dim> loading(const TileTables<Dim>& tables) const {
    return seen_with(tables, load_per_depth_);
  }

 private:
  // Terrain query at columns and its results.
  struct ColumnQuery {
    band::OfPosition<Dim> function;
    std::vector<double> known;
    Array<double, Backend> values;
  };

  void query_terrain() {
    const std::vector<std::uint64_t> keys = keys_.get();
    const std::vector<std::int32_t> before = index_map(known_keys_, keys);
    for (ColumnQuery* query : {&slope_cosine_, &normal_gravity_}) {
      std::vector<double> values(keys.size(), 1.0);
      for (std::size_t k = 0; query->function && k < keys.size(); ++k) {
        values[k] = before[k] != absent ? query->known[static_cast<std::size_t>(before[k])]
                                        : query->function(band::middle_of_column<Dim>(keys[k], cell_));
      }
      query->values.set(values);
      query->known = std::move(values);
    }
    known_keys_ = keys;
  }

  [[nodiscard]] ColumnsByTile<Dim> seen_with(const TileTables<Dim>& tables,
                                             const Array<double, Backend>& cosine) const {
    return {tables.tile_keys, column_.data(),    sizes_.view(), cell_,
            mapping_,         thickness_.data(), top_.data(),   cosine.data()};
  }

  Backend& backend_;
  double cell_;
  mpm::Mapping mapping_;
  ColumnQuery slope_cosine_, normal_gravity_;
  std::vector<std::uint64_t> known_keys_;  // of the columns
  BodySizes<Backend> sizes_;               // half sizes of particles [m]
  UniqueKeys<Backend> first_{backend_};
  Array<std::uint64_t, Backend> keys_listed_{backend_}, keys_of_seen_{backend_}, keys_{backend_};
  Array<std::uint32_t, Backend> listed_{backend_}, seen_{backend_}, first_seen_{backend_};
  Array<std::int32_t, Backend> column_{backend_}, adjacent_{backend_};
  Array<Part, Backend> parts_{backend_}, sums_{backend_};
  Array<double, Backend> thickness_{backend_}, top_{backend_}, load_per_depth_{backend_};
};

}  // namespace thawslide::device
