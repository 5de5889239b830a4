// Erodible bed below the nodes of a device (terrain/bed_stage.hpp), and the bed parts that the sliding mass covers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "device/ground.hpp"
#include "device/node_kernels.hpp"
#include "exec/array.hpp"
#include "terrain/bed_stage.hpp"

namespace thawslide::device {

// Marks the bed parts that particles of tiles near the ground cover. One thread per particle, by rank.
template <int Dim>
struct CoverBed {
  TileTables<Dim> tables;
  mpm::ParticleView<Dim> particles;
  mpm::SizesOfBodies sizes;
  double cell;
  terrain::BedColumns<Dim> columns;
  std::uint8_t* covered;  // by column and part

  THAWSLIDE_HD void operator()(std::size_t rank) const {
    using T = mpm::Tile<Dim>;
    if (T::index(tables.keys[rank] >> T::node_bits)[Dim - 1] > 0) {
      return;
    }
    const std::uint32_t particle = tables.order[rank];
    const double half = sizes.half[sizes.is_uniform ? 0 : static_cast<std::size_t>(particles.body(particle))];
    terrain::for_covered_parts(columns, particles, particle, half, cell, [this](std::size_t column, int part) {
      // benign race: all threads write the same value
      covered[column * terrain::parts_of_column<Dim> + static_cast<std::size_t>(part)] = 1;
    });
  }
};

// Packs the parts of the column of a candidate node into one bit mask.
template <int Dim>
struct PackParts {
  const std::size_t* columns;
  const std::uint8_t* covered;
  std::uint32_t* parts;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr std::size_t count = terrain::parts_of_column<Dim>;
    parts[k] = 0;
    for (std::size_t part = 0; columns[k] != terrain::BedColumns<Dim>::outside && part < count; ++part) {
      parts[k] |= covered[columns[k] * count + part] != 0 ? 1U << part : 0U;
    }
  }
};

template <class Backend, int Dim>
class ErodibleBed : public terrain::BedStage<Backend, Dim> {
 public:
  ErodibleBed(Backend& backend, terrain::Bed<Dim>& bed) : terrain::BedStage<Backend, Dim>(backend, bed) {
    covered_.set(std::vector<std::uint8_t>(bed.left().size() * terrain::parts_of_column<Dim>));
  }

  // Call after blocks have changed.
  void update(const std::vector<std::uint64_t>& blocks, const Ground<Backend, Dim>& ground) {
    constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    std::vector<std::size_t> columns;
    for (const std::uint32_t node : ground.list_candidates()) {
      columns.push_back(this->bed_.columns().number_of(blocks[node / block_nodes], node % block_nodes));
    }
    columns_on_device_.set(columns);
    parts_.resize(columns.size());
    this->set_columns(std::move(columns));
  }

  // Marks the parts of the bed that particles cover, and distributes it over the candidate nodes. Call after the basal
  // law has been evaluated.
  void update(const TileTables<Dim>& tables, const mpm::ParticleView<Dim>& particles, const mpm::SizesOfBodies& sizes,
              double cell, const ContactNodes<Dim>& nodes, const std::uint32_t* candidates) {
    this->executor_.for_each(tables.particles,
                             CoverBed<Dim>{tables, particles, sizes, cell, this->bed_.columns(), covered_.data()});
    this->executor_.for_each(parts_.size(), PackParts<Dim>{columns_on_device_.data(), covered_.data(), parts_.data()});
    const std::vector<std::uint32_t> parts = parts_.get();
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (parts[k] != 0) {
        this->bed_.cover(this->columns_[k], parts[k]);
      }
    }
    this->distribute(nodes, candidates);
  }

 private:
  exec::Array<std::uint8_t, Backend> covered_{this->executor_};
  exec::Array<std::size_t, Backend> columns_on_device_{this->executor_};  // by candidate
  exec::Array<std::uint32_t, Backend> parts_{this->executor_};            // by candidate
};

}  // namespace thawslide::device
