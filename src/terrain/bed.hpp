// Erodible bed on the ground: remaining mass below each column of nodes, entrainment by contact nodes, and entrained
// material that has not yet joined the sliding mass.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "base/linear.hpp"
#include "mpm/vectors_in_records.hpp"
#include "terrain/bed_node.hpp"

namespace thawslide::terrain {

// Entrained bed material that has not yet joined the sliding mass as a particle.
template <int Dim>
struct LooseMaterial {
  double mass = 0;                                             // [kg]
  Vector<double, Dim> momentum = Vector<double, Dim>::Zero();  // [kg m/s]
  double work = 0;                                             // work done on it by the sliding mass [J]
  double normal_pressure = 0;                                  // on the bed at the last entrainment [Pa]
  double idle = 0;                                             // time since then [s]
};

template <int Dim>
class Bed {
 public:
  using Column = typename BedColumns<Dim>::Column;
  using Layout = mpm::BedLayout<Dim>;
  static constexpr std::size_t outside = BedColumns<Dim>::outside;

  // mass: of the bed below each column [kg], x fastest.
  Bed(const BedMaterial& material, const Column& columns, std::vector<double> mass)
      : material_(material),
        columns_{columns},
        initial_(std::move(mass)),
        left_(initial_),
        covered_(initial_.size(), 0) {}

  // Marks parts of the bed below a column that the sliding mass covers, one bit each.
  void cover(std::size_t column, std::uint32_t parts) { covered_[column] |= static_cast<std::uint16_t>(parts); }

  // Distributes the remaining bed below each column over its nodes, in proportion to their loads (BaseLoad). Nodes
  // therefore cannot entrain the same mass twice, nor bed that was never covered. columns: number, or `outside`, by
  // node. Returns the mass available to each node [kg].
  [[nodiscard]] std::vector<double> distribute(const std::vector<std::size_t>& columns,
                                               const std::vector<double>& loads) const;

  // Transfers the mass that nodes have entrained in a step of dt from the bed to the loose material. records: of
  // BedLayout, by node.
  void collect(const std::vector<std::size_t>& columns, const std::vector<double>& records, double dt);

  // Passes loose material to join(column, material) and removes it if the result is true.
  void release(const std::function<bool(const Column&, const LooseMaterial<Dim>&)>& join);

  [[nodiscard]] const BedMaterial& material() const { return material_; }
  [[nodiscard]] bool is_exhausted(const Column& column) const { return !(left_[columns_.number_of(column)] > 0.0); }
  [[nodiscard]] const std::vector<double>& left() const { return left_; }  // [kg], by column
  [[nodiscard]] const BedColumns<Dim>& columns() const { return columns_; }

  // Sums over all columns [kg, J].
  struct Sums {
    double initial = 0, left = 0, loose = 0, loose_work = 0;
  };
  [[nodiscard]] Sums sums() const;

  // Checkpoint state.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  [[nodiscard]] Column column_at(std::size_t number) const;

  BedMaterial material_;
  BedColumns<Dim> columns_;
  std::vector<double> initial_, left_;               // [kg], by column
  std::vector<std::uint16_t> covered_;               // by column: one bit per part
  std::map<std::size_t, LooseMaterial<Dim>> loose_;  // by column number
};

// Defined here for the GPU's library, which the others do not precede.
template <int Dim>
std::vector<double> Bed<Dim>::distribute(const std::vector<std::size_t>& columns,
                                         const std::vector<double>& loads) const {
  const auto has_bed = [&](std::size_t n) {
    return loads[n] > 0.0 && columns[n] != outside && left_[columns[n]] > 0.0;
  };
  std::map<std::size_t, double> load;  // by column with remaining bed [kg m/s]
  for (std::size_t n = 0; n < loads.size(); ++n) {
    if (has_bed(n)) {
      load[columns[n]] += loads[n];
    }
  }
  std::vector<double> available(loads.size(), 0.0);
  for (std::size_t n = 0; n < loads.size(); ++n) {
    if (has_bed(n)) {
      const std::size_t c = columns[n];
      const int bare_parts = parts_of_column<Dim> - std::popcount(covered_[c]);
      const double bare = initial_[c] * static_cast<double>(bare_parts) / double(parts_of_column<Dim>);
      available[n] = loads[n] / load[c] * std::max(left_[c] - bare, 0.0);
    }
  }
  return available;
}

template <int Dim>
void Bed<Dim>::collect(const std::vector<std::size_t>& columns, const std::vector<double>& records, double dt) {
  for (auto& [column, material] : loose_) {
    material.idle += dt;
  }
  const double* record = records.data();
  for (const std::size_t column : columns) {
    if (const double entrained = record[Layout::entrained]; entrained > 0.0) {
      LooseMaterial<Dim>& material = loose_[column];
      left_[column] = std::max(left_[column] - entrained, 0.0);  // the shares sum to it up to round-off
      material.mass += entrained;
      material.momentum += mpm::vector_at<Dim>(record, Layout::impulse);
      material.work += record[Layout::work];
      material.normal_pressure = record[Layout::normal_pressure];
      material.idle = 0.0;
    }
    record += Layout::size;
  }
}

}  // namespace thawslide::terrain
