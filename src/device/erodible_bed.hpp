// Erodible bed on the ground (terrain/bed.hpp). The bed is stored on the CPU; the device computes which bed parts the
// sliding mass covers, the load of nodes, and the entrained mass.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "device/ground.hpp"
#include "device/node_kernels.hpp"
#include "device/stacks.hpp"
#include "device/step_model.hpp"
#include "exec/array.hpp"
#include "terrain/bed_node.hpp"

namespace thawslide::device {

// Bed parts per column of nodes.
template <int Dim>
inline constexpr std::size_t parts_of_column = static_cast<std::size_t>(mpm::power(terrain::bed_parts, Dim - 1));

// Marks the bed parts that particles of tiles near the ground cover. One thread group per tile.
template <int Dim>
struct CoverBed {
  using T = mpm::Tile<Dim>;

  TileTables<Dim> tables;
  mpm::ParticleView<Dim> particles;
  mpm::SizesOfBodies sizes;
  SeesCandidates<Dim> sees;
  double cell;
  const std::uint32_t* stack_of_block;
  std::uint8_t* covered;  // by stack, column and part

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t tile) const {
    constexpr auto nodes = static_cast<std::size_t>(T::nodes);
    const std::size_t first = tables.first_of_cell[tile * nodes];
    const std::size_t last = sees(tile) ? tables.first_of_cell[(tile + 1) * nodes] : first;
    group.each(last - first, [this, tile, first](std::size_t k) { cover(tile, tables.order[first + k]); });
  }

 private:
  THAWSLIDE_HD void cover(std::size_t tile, std::uint32_t particle) const {
    const double half = sizes.half[sizes.is_uniform ? 0 : static_cast<std::size_t>(particles.body(particle))];
    terrain::for_covered_parts<Dim>(particles, particle, half, cell, [&](const std::array<int, 2>& part) {
      if (part[0] >= 0 && part[1] >= 0) {
        cover(tile, part);
      }
    });
  }
  THAWSLIDE_HD void cover(std::size_t tile, const std::array<int, 2>& part) const {
    constexpr int parts = terrain::bed_parts;
    const typename T::Index corner = T::node(T::index(tables.tile_keys[tile]), 0);
    ColumnIndex<Dim> column{};
    int bit = 0;
    for (std::size_t a = Dim - 1; a-- > 0;) {
      column[a] = part[a] / parts - corner[a];
      bit = bit * parts + part[a] % parts;
    }
    const std::size_t index = index_of_column<Dim>(tables, stack_of_block, tile, column);
    // benign race: all threads write the same value
    covered[index * parts_of_column<Dim> + static_cast<std::size_t>(bit)] = 1;
  }
};

// Packs the parts of a column into one bit mask. One thread per column.
template <int Dim>
struct PackParts {
  const std::uint8_t* covered;
  std::uint32_t* parts;

  THAWSLIDE_HD void operator()(std::size_t column) const {
    std::uint32_t all = 0;
    for (std::size_t bit = 0; bit < parts_of_column<Dim>; ++bit) {
      all |= covered[column * parts_of_column<Dim> + bit] != 0 ? 1U << bit : 0U;
    }
    parts[column] = all;
  }
};

// Kernels with one thread per candidate node: PackLoad gathers loads for the CPU, OfferBed initializes records with the
// available mass, and PackPressure adds the normal pressure of entraining nodes for the CPU.
template <int Dim>
struct PackLoad {
  NodeViews<Dim> nodes;
  const std::uint32_t* candidates;
  double* loads;

  THAWSLIDE_HD void operator()(std::size_t k) const { loads[k] = nodes.base_at(candidates[k])[mpm::BaseLayout::load]; }
};
template <int Dim>
struct OfferBed {
  const double* available;
  double* records;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    double* record = records + k * bed_record_size<Dim>;
    for (std::size_t c = 0; c < bed_record_size<Dim>; ++c) {
      record[c] = 0.0;
    }
    record[mpm::BedLayout<Dim>::available] = available[k];
  }
};
template <int Dim>
struct PackPressure {
  NodeViews<Dim> nodes;
  const std::uint32_t* candidates;
  double* records;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    double* record = records + k * bed_record_size<Dim>;
    const double* contact = nodes.contact_at(candidates[k]);
    if (record[mpm::BedLayout<Dim>::entrained] > 0.0) {
      record[mpm::BedLayout<Dim>::size] = contact[mpm::Contact::normal_force] / contact[mpm::Contact::area];
    }
  }
};

// Interface required by ResolveContact (device/node_kernels.hpp).
template <int Dim>
struct BedBelowNodes {
  terrain::BedMaterial material;
  double* records;

  [[nodiscard]] THAWSLIDE_HD terrain::BedBelowNode<Dim> below(std::size_t candidate, double area, double strength,
                                                              double dt, double mass) const {
    return {&material, records + candidate * bed_record_size<Dim>, area, strength, dt, mass};
  }
};

template <class Backend, int Dim>
class ErodibleBed {
 public:
  ErodibleBed(Backend& backend, HostBed<Dim> processor) : backend_(backend), cpu_(std::move(processor)) {}

  [[nodiscard]] bool exists() const { return static_cast<bool>(cpu_.distribute); }

  // Call after blocks have changed.
  void update(const std::vector<std::uint64_t>& blocks, const Ground<Backend, Dim>& ground) {
    if (!exists()) {
      return;
    }
    const Stacks<Dim> stacks(blocks);
    constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    std::vector<ColumnIndex<Dim>> of_candidates;
    for (const std::uint32_t node : ground.list_candidates()) {
      of_candidates.push_back(column_of_node<Dim>(blocks[node / block_nodes], node % block_nodes));
    }
    stack_.set(stacks.of_block);
    parts_.resize(stacks.columns.size());
    covered_.resize(stacks.columns.size() * parts_of_column<Dim>);
    backend_.for_each(covered_.size(), Fill<std::uint8_t>{covered_.data(), 0});
    loads_.resize(of_candidates.size());
    records_.resize(of_candidates.size() * bed_record_size<Dim>);
    cpu_.set_columns(stacks.columns, of_candidates);
  }

  // Sets the bed mass available to each candidate node. Call after the basal law has been evaluated.
  void distribute(const TileTables<Dim>& tables, const mpm::ParticleView<Dim>& particles,
                  const mpm::SizesOfBodies& sizes, const Ground<Backend, Dim>& ground, double cell,
                  const NodeViews<Dim>& nodes) {
    constexpr std::size_t threads = 128;
    backend_.for_groups(tables.tiles, threads, 0,
                        CoverBed<Dim>{tables, particles, sizes, SeesCandidates<Dim>{tables.tile_keys}, cell,
                                      stack_.data(), covered_.data()});
    backend_.for_each(parts_.size(), PackParts<Dim>{covered_.data(), parts_.data()});
    backend_.for_each(loads_.size(), PackLoad<Dim>{nodes, ground.candidates(), loads_.data()});
    available_.set(cpu_.distribute(parts_.get(), loads_.get()));
    backend_.for_each(loads_.size(), OfferBed<Dim>{available_.data(), records_.data()});
  }

  [[nodiscard]] BedBelowNodes<Dim> below_nodes() { return {cpu_.material, records_.data()}; }

  // Call after contact has been resolved.
  void collect(const NodeViews<Dim>& nodes, const std::uint32_t* candidates) {
    backend_.for_each(loads_.size(), PackPressure<Dim>{nodes, candidates, records_.data()});
    cpu_.collect(records_.get());
  }

 private:
  Backend& backend_;
  HostBed<Dim> cpu_;
  exec::Array<std::uint32_t, Backend> stack_{backend_}, parts_{backend_};
  exec::Array<std::uint8_t, Backend> covered_{backend_};
  exec::Array<double, Backend> loads_{backend_}, available_{backend_}, records_{backend_};
};

}  // namespace thawslide::device
