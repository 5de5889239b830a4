// Particles, nodes and ground for passes with different implementations.
#pragma once

#include <random>
#include <vector>

#include "mpm/particle_pass.hpp"
#include "sim/simulation.hpp"
#include "terrain/nodes_on_ground.hpp"

namespace thawslide::testing_support {

// Copied particles of a run with two bodies, on a separate grid, with random numbers at nodes, and the ground.
template <int Dim>
class Scene {
 public:
  explicit Scene(const sim::Simulation<Dim>& simulation) : model(simulation.model()), grid(simulation.grid().cell()) {
    copy(simulation.particles(), particles);
    grid.update(particles, 64);
    particles.affine_velocity.keep(true);
    particles.viscous_stress.keep(true);
    std::mt19937 random(7);
    particles.affine_velocity.resize(particles.size());
    particles.viscous_stress.resize(particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p) {
      for (int c = 0; c < Dim * Dim; ++c) {
        particles.affine_velocity(p, c) = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
      }
      // Most particles hover, such that the distance read from nodes has an effect.
      particles.contact_offset(p) = std::uniform_real_distribution<double>(-1.0, 0.1)(random);
      particles.pore_void(p) = std::uniform_real_distribution<double>(-1e-4, 1e-4)(random);
      particles.normal_load(p) = std::uniform_real_distribution<double>(0.0, 1e5)(random);
      particles.load_change(p) = std::uniform_real_distribution<double>(-1e3, 1e3)(random);
    }
    ground.update(*model.ground, grid);
    fill<mpm::NodalState>({1.0, 1e5, 0.1, 1e3}, random);
    fill<mpm::Velocity>({1.0, 2.0, 0.5}, random);
    fill<mpm::Motion>({10.0, 5.0, 8.0, 1.0, 2.0, 3.0}, random);
    fill<mpm::FilterIncrement>({1.0, 2.0, 0.5, 0.2, 0.1, 0.3}, random);
    fill<mpm::FilterTotal>({10.0, 5.0, 2.0, 0.4, 0.3, 0.1}, random);
    fill<mpm::UnreachedHeat>({2.0}, random);
    fill<mpm::Contact>({1.0, 1.0, 3.0, 1e3, 1e4, 1.0}, random);
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
        auto& contact = nodes.contact.of_block(b)[k];
        const bool candidate = ground.block(b)[k].candidate;
        const double touching = candidate && contact[mpm::Contact::touching] > 0.0 ? 1.0 : 0.0;
        contact[mpm::Contact::candidate] = candidate ? 1.0 : 0.0;
        contact[mpm::Contact::touching] = touching;
        contact[mpm::Contact::slip_speed] *= touching;
      }
    }
  }

  static void copy(const mpm::Particles<Dim>& from, mpm::Particles<Dim>& to) {
    to.resize(from.size());
    for (std::size_t f = 0; f < from.fields.all().size(); ++f) {
      to.fields.all()[f]->set_bytes(from.fields.all()[f]->bytes());
    }
  }

  template <class Name>
  void fill(const std::vector<double>& sizes, std::mt19937& random) {
    auto& records = nodes.template of<Name>();
    if constexpr (requires { records.contains(0); }) {
      records.allocate(grid.blocks().size(), [](std::size_t /*block*/) { return true; });
    } else {
      records.resize(grid.blocks().size());
    }
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
        auto& record = records.of_block(b)[k];
        record.fill(0.0);
        for (std::size_t c = 0; c < static_cast<std::size_t>(mpm::components_of<Name, Dim>); ++c) {
          record[c] = std::uniform_real_distribution<double>(-sizes.at(c), sizes.at(c))(random);
        }
      }
    }
  }

  sim::Model<Dim> model;
  mpm::SparseGrid<Dim> grid;
  mpm::Particles<Dim> particles;
  mpm::Nodes<Dim> nodes;
  terrain::GroundOnGrid<Dim> ground;
};

}  // namespace thawslide::testing_support
