// Nodal part of conduct_heat: state from the averages, and temperature rate.
#pragma once

#include "band/averages_kernel.hpp"
#include "band/heat.hpp"
#include "mpm/node_pass.hpp"

namespace thawslide::band {

// Temperature and pore pressure of a node (Eq. 21). A prescribed temperature is set before gradients are computed.
template <int Dim>
struct SetNodalState {
  const mpm::SparseGrid<Dim>& grid;
  const BandModel<Dim>& model;
  bool has_faces = model.at_faces.any();

  void operator()(mpm::Nodes<Dim>& nodes, const mpm::NodeAt& at) const {
    auto& state = nodes.state(at);
    if (set_nodal_state<Dim>(nodes.averages(at), state) && has_faces) {
      prescribe_temperature(model.at_faces.at(mpm::node_position(grid, at.block, at.node)), state);
    }
  }
};

// Temperature rate of a node (Eq. 19) from a heat capacity [J/K], the particles' gain by subgrid diffusion [J],
// friction heat and face conditions. first_step: prescribed temperatures are applied as a jump.
template <int Dim>
struct SolveTemperatureRate {
  const mpm::SparseGrid<Dim>& grid;
  const BandModel<Dim>& model;
  double dt;
  bool first_step;
  bool has_faces = model.at_faces.any();

  void operator()(mpm::Nodes<Dim>& nodes, const mpm::NodeAt& at, double capacity, double subgrid,
                  NodalHeat& sum) const {
    const bool has_contact = nodes.unreached_heat.contains(at.block);
    double none = 0;
    double& unreached = has_contact ? nodes.unreached_heat.of_block(at.block)[at.node][0] : none;
    solve_temperature_rate<Dim>(
        nodes.heat_rates(at), capacity, subgrid, nodes.contact(at)[mpm::Contact::friction_heat], nodes.momentum(at), dt,
        nodes.state(at)[mpm::NodalState::temperature_rate], unreached, sum, [&](double& rate, double& power) {
          return has_faces && meets_face(model.at_faces.at(mpm::node_position(grid, at.block, at.node)), first_step,
                                         nodes.averages(at), capacity, grid.cell(), dt, rate, power, sum.gain.boundary);
        });
    THAWSLIDE_ASSERT(has_contact || !(unreached > 0.0), "friction heat at node {} of block {}, which is in no contact",
                     at.node, at.block);
  }
};

}  // namespace thawslide::band
