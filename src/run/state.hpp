// State of a simulation other than particles and scalars, by name, for checkpoints.
#pragma once

#include <vector>

#include "band/base_sums.hpp"
#include "base/state_numbers.hpp"
#include "sim/simulation.hpp"

namespace thawslide::run {

template <int Dim>
void add_state(const sim::Simulation<Dim>& simulation, NamedNumbers& blocks) {
  if (const auto* columns = simulation.band_columns()) {
    blocks["band_columns"] = band::numbers_of(*columns);
  }
  if (const auto* bed = simulation.bed()) {
    blocks["bed"] = bed->state();
  }
}

// Restores the state for particles already read from a checkpoint. Throws UserError for an impossible state.
template <int Dim>
void restore_state(sim::Simulation<Dim>& simulation, const std::vector<double>& scalars, const NamedNumbers& blocks) {
  simulation.restore(scalars);
  if (simulation.has_band_columns()) {
    simulation.restore_band_columns(block_of(blocks, "band_columns"));
  }
  if (simulation.bed() != nullptr) {
    simulation.restore_bed(block_of(blocks, "bed"));
  }
}

}  // namespace thawslide::run
