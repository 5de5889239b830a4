// Erodible bed on the ground: remaining mass below each column of nodes, entrainment by contact nodes, and entrained
// material that has not yet joined the sliding mass.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "mpm/body_sizes.hpp"
#include "mpm/nodes.hpp"
#include "terrain/bed_node.hpp"

namespace thawslide::terrain {

template <int Dim>
class GroundOnGrid;

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
  using Column = std::array<int, Dim - 1>;  // nodes with the same indices along the horizontal axes
  using Layout = mpm::BedLayout<Dim>;

  // columns: number along each axis, the first at the domain's lower corner. mass: of the bed below each column [kg], x
  // fastest.
  Bed(const BedMaterial& material, const Column& columns, std::vector<double> mass)
      : material_(material),
        columns_(columns),
        initial_(std::move(mass)),
        left_(initial_),
        covered_(initial_.size(), 0) {}

  // Number of a column, x fastest; `outside` if it is outside the domain.
  static constexpr std::size_t outside = ~std::size_t{0};
  [[nodiscard]] std::size_t number_of(const Column& column) const;

  // Marks the parts of the bed that the sliding mass covers, with bed_parts along each axis of a column of nodes.
  void cover(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground, const mpm::BodySizes& sizes,
             const mpm::Particles<Dim>& particles);
  // Marks parts of one column, given as a bit mask.
  void cover(std::size_t column, std::uint32_t parts) { covered_[column] |= static_cast<std::uint16_t>(parts); }

  // Distributes the remaining bed below each column over its nodes, in proportion to their loads (nodes.base). Nodes
  // therefore cannot entrain the same mass twice, nor bed that was never covered. Fills nodes.bed.
  void distribute(const mpm::SparseGrid<Dim>& grid, mpm::Nodes<Dim>& nodes) const;
  // The same for a list of nodes of any columns.
  struct Pressing {
    std::size_t column = outside;
    double load = 0;       // as in BaseLayout
    double available = 0;  // of the bed [kg]
  };
  void distribute(std::vector<Pressing>& nodes) const;

  // Transfers the mass entrained by nodes in a step of dt from the bed to the loose material.
  void collect(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes, double dt);
  // The same node by node, after age(dt). record: of BedLayout.
  void age(double dt);
  void collect(std::size_t column, const double* record, double normal_pressure);

  // Passes loose material to join(column, material) and removes it if the result is true.
  void release(const std::function<bool(const Column&, const LooseMaterial<Dim>&)>& join);

  [[nodiscard]] const BedMaterial& material() const { return material_; }
  [[nodiscard]] bool is_exhausted(const Column& column) const { return !(left_[number_of(column)] > 0.0); }
  [[nodiscard]] const std::vector<double>& left() const { return left_; }  // [kg], by column
  [[nodiscard]] const Column& columns() const { return columns_; }

  // Sums over all columns [kg, J].
  struct Sums {
    double initial = 0, left = 0, loose = 0, loose_work = 0;
  };
  [[nodiscard]] Sums sums() const;

  // Checkpoint state.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  void cover_part(const std::array<int, 2>& part);
  [[nodiscard]] Column column_of(const mpm::SparseGrid<Dim>& grid, std::size_t block, std::size_t node) const;
  [[nodiscard]] Column column_at(std::size_t number) const;

  BedMaterial material_;
  Column columns_;
  std::vector<double> initial_, left_;               // [kg], by column
  std::vector<std::uint16_t> covered_;               // by column: one bit per part
  std::map<std::size_t, LooseMaterial<Dim>> loose_;  // by column number
};

}  // namespace thawslide::terrain
