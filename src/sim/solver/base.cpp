#include "sim/solver/base.hpp"

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "sim/setup/restored_state.hpp"

namespace thawslide::sim {

namespace {

// Volume averages over the particles in the band, which must all be of one material.
template <int Dim>
ColumnMaterial material_of_base(const config::Case& parameters, const Model<Dim>& model,
                                const mpm::Particles<Dim>& particles) {
  ColumnMaterial material{};
  double volume = 0.0;
  std::int32_t index = -1;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.in_band(p) == 0) {
      continue;
    }
    if (index >= 0 && particles.material(p) != index) {
      throw UserError(
          fmt::format("{}: bodies of different materials stand on the ground, and band columns are of one. Give all "
                      "bodies the same material, or set band.model = \"scaled\".",
                      config::location_of(parameters, "band.model")));
    }
    index = particles.material(p);
    const auto of_particle = particles.initial_volume(p);
    volume += of_particle;
    material.depth += of_particle * particles.flow_depth(p);
    material.temperature += of_particle * particles.temperature(p);
    material.porosity += of_particle * particles.initial_porosity(p);
  }
  if (index < 0) {
    throw UserError(
        fmt::format("{}: no particle touches the terrain, where band columns begin. Place the body on the "
                    "terrain, or set band.model = \"scaled\".",
                    config::location_of(parameters, "band.model")));
  }
  material.depth /= volume;
  material.temperature /= volume;
  material.porosity /= volume;
  material.hydraulic_conductivity = model.motion.materials[static_cast<std::size_t>(index)].hydraulic_conductivity;
  return material;
}

}  // namespace

template <int Dim>
void start_columns(const Setup<Dim>& setup, const mpm::Particles<Dim>& particles, Base<Dim>& base) {
  if (!setup.model.contact.band_columns) {
    return;
  }
  const config::Case& parameters = setup.parameters;
  const ColumnMaterial material = material_of_base(parameters, setup.model, particles);
  const double thickest = parameters.band.thickness.largest();
  if (thickest >= material.depth) {
    throw UserError(
        fmt::format("{}: the band is up to {} m thick, and the slide above it {} m on average. Use a thinner band.",
                    config::location_of(parameters, "band.thickness"), thickest, rounded_text(material.depth, 3)));
  }
  base.columns = std::make_unique<band::BaseColumns<Dim>>(
      base.cpu, make_columns_model(parameters, setup.model, material), setup.cell(), setup.model.motion.gravity);
}

template <int Dim>
void update_columns(const Setup<Dim>& setup, const mpm::SparseGrid<Dim>& grid,
                    const terrain::GroundOnGrid<Dim>& ground_on_grid, double time, double dt, mpm::Nodes<Dim>& nodes,
                    Base<Dim>& base) {
  using Nodes = mpm::NodeAccess<Dim>;
  using Ground = decltype(setup.model.ground->anywhere());
  struct Normals {
    const terrain::GroundOnGrid<Dim>* ground;
    const Vector<double, Dim>& operator()(std::size_t b, std::size_t k) const { return ground->block(b)[k].normal; }
  };
  if (base.columns) {
    base.columns->update(
        band::BaseInStep<Nodes, Ground, Normals, Dim>{grid.block_tables(), Nodes{grid, nodes},
                                                      setup.model.ground->anywhere(), Normals{&ground_on_grid}},
        setup.band_thickness(time), dt);
  }
}

template <int Dim>
void restore_columns(const Setup<Dim>& setup, const std::vector<double>& state, Base<Dim>& base) {
  band::restore(state, *base.columns);
  // Segments move with the slide, whose cells extend beyond the domain.
  const double margin = 8.0 * setup.cell();
  for (const auto& segment : base.columns->segments()) {
    if (!is_about_domain<Dim>(segment.position, setup.model.constraints.extent, margin)) {
      StateNumbers(state, "band columns").fail(fmt::format("segment {} lies far beyond the domain", segment.id));
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                     \
  template void start_columns<Dim>(const Setup<Dim>&, const mpm::Particles<Dim>&, Base<Dim>&);                         \
  template void update_columns<Dim>(const Setup<Dim>&, const mpm::SparseGrid<Dim>&, const terrain::GroundOnGrid<Dim>&, \
                                    double, double, mpm::Nodes<Dim>&, Base<Dim>&);                                     \
  template void restore_columns<Dim>(const Setup<Dim>&, const std::vector<double>&, Base<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
