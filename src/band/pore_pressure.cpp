#include "band/pore_pressure.hpp"

#include "physics/clapeyron.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::band {

namespace {

using mpm::HatLayout;

template <int Dim, class Real>
bool melted_before(const BandModel<Dim, Real>& model, const mpm::Particles<Dim, Real>& particles, std::uint32_t p) {
  return particles.previous_temperature(p) >= model.reference_temperature;
}

// Frozen or partly frozen: the liquid follows the ice (Eq. 4).
template <int Dim, class Real>
void set_frozen_pressure(const BandModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles, std::size_t p) {
  particles.liquid_pressure(p) =
      physics::liquid_pressure_clapeyron(model.phases, particles.ice_pressure(p), particles.temperature(p),
                                         model.reference_temperature, model.clapeyron_sign);
  particles.pore_pressure(p) =
      physics::pore_pressure(particles.liquid_saturation(p), particles.liquid_pressure(p), particles.ice_pressure(p));
}

// Pressure at which the liquid starts when the last ice melts, continuous with Eq. 4 at Tref.
template <int Dim, class Real>
Real melting_pressure(const BandModel<Dim, Real>& model, Real ice_pressure) {
  return ice_pressure * model.phases.water_density / model.phases.ice_density;
}

// Seepage between melted particles (Eq. 23: flow times xi; pore space over xi, or whole as printed); frozen particles
// keep their pressure and act as sinks. Differences within a cell, which nodes do not see, are levelled by the
// particles themselves, and what this changes at the nodes is taken off there (Gerya and Yuen 2003).
template <int Dim, class Real>
void seepage_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                     const mpm::Nodes<Dim, Real>& nodes, Real dt, SeepageNodes<Dim, Real>& work,
                     mpm::Particles<Dim, Real>& particles) {
  work.pressure.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& hats = nodes.hats(b, k);
      work.pressure(b, k)[0] =
          hats[HatLayout::volume] > Real(0) ? hats[HatLayout::pore_pressure] / hats[HatLayout::volume] : Real(0);
    }
  });
  auto& patches = work.flows.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    mpm::Patch<Dim, Real, 1> pressure;
    load_patch(grid, t, work.pressure, pressure);
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const Real hydraulic = model.hydraulic_conductivity[static_cast<std::size_t>(particles.material(p))];
      if (!(hydraulic > Real(0))) {
        continue;
      }
      const auto stencil = mpm::hat_stencil(grid, tile.key, particles, p);
      const Real scaling = particles.thermal_scaling(p);
      const Real pore_scaling = physics::pore_space_scaling(scaling, model.seepage_as_printed);
      const Real volume = particles.volume(p);
      Vector<Real, Dim> flow = Vector<Real, Dim>::Zero();
      particles.seepage_in_cell(p) = Real(0);
      if (melted_before(model, particles, p)) {
        Vector<Real, Dim> gradient = Vector<Real, Dim>::Zero();
        Real seen = 0;
        stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& slope) {
          gradient += pressure.records[place][0] * slope;
          seen += pressure.records[place][0] * weight;
        });
        const Real diffusivity =
            scaling * pore_scaling *
            physics::hydraulic_diffusivity(model.phases, particles.porosity(p), Real(1), hydraulic);
        particles.seepage_in_cell(p) = (seen - particles.pore_pressure(p)) *
                                       physics::share_levelled_within_cell(diffusivity, grid.cell(), Dim, dt);
        const Real mobility = hydraulic / model.phases.water_unit_weight;
        flow = -volume * scaling * mobility * model.phases.water_bulk_modulus * gradient;
      }
      // Frozen particles count with their pores, as they do in the nodal pressure: the share that reaches them is lost
      // to the sink. Left out, a node with few melted particles would drive these to pressures without bound.
      const Real pore_space = volume / pore_scaling * particles.porosity(p);
      stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& slope) {
        patch.records[place][0] += flow.dot(slope);
        patch.records[place][1] += weight * pore_space;
        patch.records[place][2] += weight * pore_space * particles.seepage_in_cell(p);
      });
    }
  });
  sum_patches(grid, work.flows);
}

// Pressure that seepage between nodes brings to a particle's place in a step (Eq. 22).
template <int Dim, class Real>
Real seepage_between_nodes(const mpm::Stencil<Dim, Real, 2>& stencil, const mpm::Patch<Dim, Real, 3>& flows, Real dt) {
  Real change = 0;
  stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*slope*/) {
    const auto& node = flows.records[place];
    if (weight > Real(0) && node[1] > Real(0)) {
      change += weight * (dt * node[0] - node[2]) / node[1];
    }
  });
  return change;
}

template <int Dim, class Real>
void pressurize(const BandModel<Dim, Real>& model, bool was_melted, Real seepage_change,
                mpm::Particles<Dim, Real>& particles, std::uint32_t p) {
  const Real start = melting_pressure(model, particles.ice_pressure(p));
  if (!model.thermal_pressurization) {
    particles.liquid_pressure(p) = start;
  } else {
    const Real from = was_melted ? particles.previous_temperature(p) : model.reference_temperature;
    const Real coefficient =
        physics::undrained_pressure_coefficient(model.phases, particles.porosity(p), particles.liquid_saturation(p));
    particles.liquid_pressure(p) = (was_melted ? particles.liquid_pressure(p) : start) +
                                   coefficient * (particles.temperature(p) - from) + seepage_change;
    if (model.volumetric_term && was_melted) {
      particles.liquid_pressure(p) -=
          physics::pore_stiffness(model.phases, particles.porosity(p), Real(1)) * particles.volume_strain(p);
    }
  }
  particles.pore_pressure(p) = particles.liquid_pressure(p);
}

}  // namespace

template <int Dim, class Real>
void drain_pore_pressure(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                         const FlowDepth<Dim, Real>& depth, Real dt, const mpm::Nodes<Dim, Real>& nodes,
                         SeepageNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles) {
  const bool seepage = model.seepage && model.thermal_pressurization;
  if (seepage) {
    seepage_to_grid(grid, model, nodes, dt, work, particles);
  }
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    mpm::Patch<Dim, Real, 3> flows;
    if (seepage) {
      load_patch(grid, t, work.flows, flows);
    }
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      particles.ice_pressure(p) = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth(p));
      if (particles.temperature(p) < model.reference_temperature) {
        set_frozen_pressure(model, particles, p);
        continue;
      }
      const bool was_melted = melted_before(model, particles, p);
      Real seepage_change = 0;
      if (seepage && was_melted) {
        const auto stencil = mpm::hat_stencil(grid, tile.key, particles, p);
        seepage_change = particles.seepage_in_cell(p) + seepage_between_nodes(stencil, flows, dt);
      }
      pressurize(model, was_melted, seepage_change, particles, p);
      if (seepage && depth.depth_below_top(grid, particles, t, p) < Real(0.5) * grid.cell()) {
        particles.liquid_pressure(p) = Real(0);  // the free surface is at atmospheric pressure
        particles.pore_pressure(p) = Real(0);
      }
    }
  });
}

template <int Dim, class Real>
void set_pore_pressure(const BandModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles) {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (!model.pressure) {
      particles.pore_pressure(p) = Real(0);
      continue;
    }
    particles.ice_pressure(p) = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth(p));
    if (particles.temperature(p) < model.reference_temperature) {
      set_frozen_pressure(model, particles, p);
    } else {
      particles.liquid_pressure(p) = melting_pressure(model, particles.ice_pressure(p));
      particles.pore_pressure(p) = particles.liquid_pressure(p);
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void drain_pore_pressure<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&,  \
                                               const FlowDepth<Dim, Real>&, Real, const mpm::Nodes<Dim, Real>&, \
                                               SeepageNodes<Dim, Real>&, mpm::Particles<Dim, Real>&);           \
  template void set_pore_pressure<Dim, Real>(const BandModel<Dim, Real>&, mpm::Particles<Dim, Real>&);
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
