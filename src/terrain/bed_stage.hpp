// Erodible bed below the candidate nodes of a step, on an executor. The bed itself (terrain/bed.hpp) is on the CPU,
// which receives the loads of the nodes, the parts of the bed that particles cover, and the mass that the nodes have
// entrained.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "exec/array.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/particle_view.hpp"
#include "terrain/bed.hpp"

namespace thawslide::terrain {

// Marks the bed parts that a particle in the lowest tiles covers.
template <int Dim>
struct CoverBed {
  static constexpr std::size_t of_task = std::size_t{1} << 48;  // all: threads of the CPU may not write to one part

  mpm::ParticleView<Dim> particles;
  mpm::SizesOfBodies sizes;
  double cell;
  BedColumns<Dim> columns;
  std::uint8_t* covered;  // by column and part

  THAWSLIDE_HD void operator()(std::size_t k) const {
    using std::floor;
    const auto particle = static_cast<std::uint32_t>(k);
    const double layer = floor(particles.height_above_ground(particle) * (1.0 / cell) + 0.5);
    if (!(layer < static_cast<double>(mpm::Tile<Dim>::edge))) {
      return;
    }
    const double half = sizes.half[sizes.is_uniform ? 0 : static_cast<std::size_t>(particles.body(particle))];
    for_covered_parts(columns, particles, particle, half, cell, [this](std::size_t column, int part) {
      // benign race on a device: all threads write the same value
      covered[column * parts_of_column<Dim> + static_cast<std::size_t>(part)] = 1;
    });
  }
};

// The column of a candidate node, its covered parts as a bit mask, and the node's load.
template <int Dim>
struct PackNode {
  BedColumns<Dim> of_bed;
  const std::uint8_t* covered;
  std::size_t* columns;
  std::uint32_t* parts;
  double* loads;

  template <class Step, class Node>
  THAWSLIDE_HD void operator()(const Step& step, const Node& node, std::size_t k) const {
    constexpr std::size_t count = parts_of_column<Dim>;
    const auto& nodes = step.nodes;
    columns[k] = of_bed.number_of(step.blocks.block_keys[nodes.block(node)], nodes.in_block(node));
    loads[k] = nodes.template read<mpm::BaseLoad>(node)[mpm::BaseLoad::load];
    parts[k] = 0;
    for (std::size_t part = 0; columns[k] != BedColumns<Dim>::outside && part < count; ++part) {
      parts[k] |= covered[columns[k] * count + part] != 0 ? 1U << part : 0U;
    }
  }
};

template <int Dim>
struct OfferBed {
  const double* available;
  double* records;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    double* record = records + k * mpm::BedLayout<Dim>::size;
    for (std::size_t c = 0; c < mpm::BedLayout<Dim>::size; ++c) {
      record[c] = 0.0;
    }
    record[mpm::BedLayout<Dim>::available] = available[k];
  }
};

template <class Executor, int Dim>
class BedStage {
 public:
  // Both must outlive the stage.
  BedStage(Executor& executor, Bed<Dim>& bed) : executor_(executor), bed_(bed) {
    covered_.set(std::vector<std::uint8_t>(bed.left().size() * parts_of_column<Dim>));
  }

  // Marks the parts of the bed that particles cover, and distributes it over the loaded candidate nodes. Passes: as in
  // terrain/contact_stage.hpp, with the particles and their half sizes in cells.
  template <class Passes>
  void distribute(Passes& passes) {
    const std::size_t count = passes.candidate_count();
    columns_of_nodes_.resize(count);
    parts_.resize(count);
    loads_.resize(count);
    records_.resize(count * mpm::BedLayout<Dim>::size);
    executor_.for_each(passes.particle_count(), CoverBed<Dim>{passes.particles(), passes.body_sizes(), passes.cell(),
                                                              bed_.columns(), covered_.data()});
    passes.for_candidates(
        PackNode<Dim>{bed_.columns(), covered_.data(), columns_of_nodes_.data(), parts_.data(), loads_.data()});
    columns_ = columns_of_nodes_.get();
    const std::vector<std::uint32_t> parts = parts_.get();
    for (std::size_t k = 0; k < count; ++k) {
      if (parts[k] != 0) {
        bed_.cover(columns_[k], parts[k]);
      }
    }
    available_.set(bed_.distribute(columns_, loads_.get()));
    executor_.for_each(count, OfferBed<Dim>{available_.data(), records_.data()});
  }
  // Call after the bed has been distributed.
  [[nodiscard]] BedBelowNodes<Dim> below_nodes() { return {bed_.material(), records_.data()}; }
  // Call after contact has been resolved, in a step of dt [s].
  void collect(double dt) { bed_.collect(columns_, records_.get(), dt); }

 private:
  Executor& executor_;
  Bed<Dim>& bed_;
  std::vector<std::size_t> columns_;  // of the bed, by candidate
  exec::Array<std::uint8_t, Executor> covered_{executor_};
  exec::Array<std::size_t, Executor> columns_of_nodes_{executor_};
  exec::Array<std::uint32_t, Executor> parts_{executor_};
  exec::Array<double, Executor> loads_{executor_}, available_{executor_}, records_{executor_};
};

}  // namespace thawslide::terrain
