// An erodible bed on the ground: how much of it is left below each column of nodes, what contact nodes take of it, and
// what of that has not joined the slide yet.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "mpm/body_sizes.hpp"
#include "mpm/nodes.hpp"
#include "terrain/bed_node.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Bed matter that has been taken up and waits to join the slide as a particle.
template <int Dim, class Real>
struct LooseMaterial {
  Real mass = 0;                                           // [kg]
  Vector<Real, Dim> momentum = Vector<Real, Dim>::Zero();  // [kg m/s]
  Real work = 0;                                           // that the slide has lost to it [J]
  Real normal_pressure = 0;                                // on the bed when it was last taken from [Pa]
  Real idle = 0;                                           // since then [s]
};

template <int Dim, class Real>
class Bed {
 public:
  using Column = std::array<int, Dim - 1>;  // nodes with the same indices along the horizontal axes
  using Layout = mpm::BedLayout<Dim>;

  // columns: how many along each axis, the first at the domain's lower corner; mass: of the bed below each [kg], x
  // fastest.
  Bed(const BedMaterial<Real>& material, const Column& columns, std::vector<Real> mass)
      : material_(material),
        columns_(columns),
        initial_(std::move(mass)),
        left_(initial_),
        covered_(initial_.size(), 0) {}

  // Number of a column, x fastest; `outside` for one beyond the domain.
  static constexpr std::size_t outside = ~std::size_t{0};
  [[nodiscard]] std::size_t number_of(const Column& column) const;

  // Notes which parts of the bed the slide has come to cover: bed_parts along each axis for a column of nodes.
  void cover(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
             const mpm::BodySizes<Real>& sizes, const mpm::Particles<Dim, Real>& particles);
  // The same of one column; parts: a bit for each.
  void cover(std::size_t column, std::uint32_t parts) { covered_[column] |= static_cast<std::uint16_t>(parts); }

  // Shares out what is left below each column among its nodes, by how they press on the ground (nodes.base): none takes
  // what another one does, and none where the slide has never been. Fills nodes.bed.
  void parallel_chunks(const mpm::SparseGrid<Dim, Real>& grid, mpm::Nodes<Dim, Real>& nodes) const;
  // The same among nodes of a list, of any columns.
  struct Pressing {
    std::size_t column = outside;
    Real load = 0;       // as BaseLayout has it
    Real available = 0;  // of the bed [kg]
  };
  void parallel_chunks(std::vector<Pressing>& nodes) const;

  // What nodes took in a step of dt goes from the bed to what is loose.
  void collect(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Nodes<Dim, Real>& nodes, Real dt);
  // The same node by node, after age(dt). record: of BedLayout.
  void age(Real dt);
  void collect(std::size_t column, const Real* record, Real normal_pressure);

  // Loose matter that is to join: join(column, matter) says whether it does, and it is loose no more.
  void release(const std::function<bool(const Column&, const LooseMaterial<Dim, Real>&)>& join);

  [[nodiscard]] const BedMaterial<Real>& material() const { return material_; }
  [[nodiscard]] bool is_exhausted(const Column& column) const { return !(left_[number_of(column)] > Real(0)); }
  [[nodiscard]] const std::vector<Real>& left() const { return left_; }  // [kg], by column
  [[nodiscard]] const Column& columns() const { return columns_; }

  // Over all columns [kg, J].
  struct Sums {
    Real initial = 0, left = 0, loose = 0, loose_work = 0;
  };
  [[nodiscard]] Sums sums() const;

  // Everything a checkpoint must hold, and its way back.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  void cover_part(const Column& part);
  [[nodiscard]] Column column_of(const mpm::SparseGrid<Dim, Real>& grid, std::size_t block, std::size_t node) const;
  [[nodiscard]] Column column_at(std::size_t number) const;

  BedMaterial<Real> material_;
  Column columns_;
  std::vector<Real> initial_, left_;                       // [kg], by column
  std::vector<std::uint16_t> covered_;                     // by column: a bit for each of its parts
  std::map<std::size_t, LooseMaterial<Dim, Real>> loose_;  // by number of the column
};

}  // namespace thawslide::terrain
