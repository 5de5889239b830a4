// State of the base of a slide in addition to the particles: band columns and erodible bed.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "band/base_state.hpp"
#include "sim/setup/model.hpp"
#include "terrain/bed.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {

template <int Dim>
struct Base {
  exec::Cpu cpu;
  std::unique_ptr<band::BaseColumns<Dim>> columns;  // null unless the band consists of columns
  std::optional<terrain::Bed<Dim>> bed;             // empty without an erodible bed

  // Null without an erodible bed, and while the base is fixed.
  [[nodiscard]] terrain::Bed<Dim>* bed_in_reach(const Model<Dim>& model) {
    return bed && !model.contact.base_is_fixed ? &*bed : nullptr;
  }
};

// Creates the columns at t = 0, if the band consists of them. Throws UserError, with the key, for bodies that cannot
// have columns.
template <int Dim>
void start_columns(const Setup<Dim>& setup, const mpm::Particles<Dim>& particles, Base<Dim>& base);

// Updates the columns after contact in a step of dt from `time` [s]. ground, nodes: on the grid of the step.
template <int Dim>
void update_columns(const Setup<Dim>& setup, const mpm::SparseGrid<Dim>& grid, const terrain::GroundOnGrid<Dim>& ground,
                    double time, double dt, mpm::Nodes<Dim>& nodes, Base<Dim>& base);

// Restores columns from a checkpoint. Throws UserError for an impossible state.
template <int Dim>
void restore_columns(const Setup<Dim>& setup, const std::vector<double>& state, Base<Dim>& base);

}  // namespace thawslide::sim
