// Material points of a simulation in host memory, the grid around them, and the ground at its nodes. With a device they
// are copies of its last synchronization.
#pragma once

#include <cstdint>
#include <utility>

#include "base/error.hpp"
#include "mpm/particles.hpp"
#include "mpm/sparse_grid.hpp"
#include "sim/setup/model.hpp"
#include "sim/setup/release_body.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {

// Particle that joins a run; properties not listed here are those at t = 0.
template <int Dim>
struct NewParticle {
  std::int32_t body = 0, material = 0;                         // numbers, as in Model
  Vector<double, Dim> position = Vector<double, Dim>::Zero();  // relative to the domain's lower corner [m]
  Vector<double, Dim> velocity = Vector<double, Dim>::Zero();  // [m/s]
  double volume = 0;                                           // [m3], per metre of width in 2D
  double temperature = 0, porosity = 0;                        // [C], [1]
  double flow_depth = 0;  // below the surface, normal to the ground [m]: loads the ice
  SymmetricTensor<double> stress = SymmetricTensor<double>::Zero();  // total [Pa]
  double heat = 0;  // in addition to the heat content at its temperature [J]: it warms or melts the particle
};

template <int Dim>
struct Slide {
  explicit Slide(mpm::SparseGrid<Dim> empty) : grid(std::move(empty)) {}

  mpm::Particles<Dim> particles;
  mpm::SparseGrid<Dim> grid;
  terrain::GroundOnGrid<Dim> ground;  // empty without terrain
  bool are_located = false;           // particles have their heights above the ground
  std::size_t count_at_start = 0;     // particles at t = 0
  std::int64_t next_id = 0;           // of a particle that joins
  std::int64_t split_count = 0;       // particles added by splitting
  int sorting_interval = 64;          // steps between two sortings of particles in memory; 0: only at the start

  // Updates the heights of particles above the ground, unless no particle has moved.
  void locate(const Model<Dim>& model) {
    if (model.ground && !are_located) {
      model.ground->locate(particles);
      are_located = true;
    }
  }
  // Moves bodies that are released to the layers of moving ones, from the next update of the grid on.
  void set_layers(const Model<Dim>& model, double time) {
    if (model.between_bodies.has_held) {
      grid.set_layers(layers_of_bodies(model, time));
    }
  }
  // Updates the grid, and the ground at its nodes, to the particles' positions. sorting: steps between two sortings of
  // particles in memory; 0: none, such that new particles remain last.
  void update_grid(const Model<Dim>& model, int sorting) {
    grid.update(particles, sorting);
    update_ground(model);
  }
  // Call after the grid's blocks have changed.
  void update_ground(const Model<Dim>& model) {
    if (model.ground && grid.blocks_changed()) {
      ground.update(*model.ground, grid, model.substrates.get());
    }
  }
  // Index in memory of a particle, which must exist.
  [[nodiscard]] std::size_t index_of(std::int64_t id) const {
    std::size_t p = 0;
    while (p < particles.size() && particles.id(p) != id) {
      ++p;
    }
    THAWSLIDE_ASSERT(p < particles.size(), "particle {} is not among the particles", id);
    return p;
  }
};

}  // namespace thawslide::sim
