// Band columns of a simulation: initialization and update in a time step.

#include "band/basal_segments.hpp"
#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "sim/columns_model.hpp"
#include "sim/restored_state.hpp"
#include "sim/simulation.hpp"
#include "terrain/ground_on_grid.hpp"

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
    const auto of_particle = static_cast<double>(particles.initial_volume(p));
    volume += of_particle;
    material.depth += of_particle * static_cast<double>(particles.flow_depth(p));
    material.temperature += of_particle * static_cast<double>(particles.temperature(p));
    material.porosity += of_particle * static_cast<double>(particles.initial_porosity(p));
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
  material.hydraulic_conductivity =
      static_cast<double>(model.motion.materials[static_cast<std::size_t>(index)].hydraulic_conductivity);
  return material;
}

}  // namespace

template <int Dim>
void Simulation<Dim>::restore_band_columns(const std::vector<double>& state) {
  band_columns_->restore(state);
  // Segments move with the slide, whose cells extend beyond the domain.
  const Real margin = Real(8) * static_cast<Real>(parameters_.grid.cell);
  for (const auto& segment : band_columns_->segments()) {
    if (!is_about_domain<Dim>(segment.position, model_.constraints.extent, margin)) {
      StateNumbers(state, "band columns").fail(fmt::format("segment {} lies far beyond the domain", segment.id));
    }
  }
}

template <int Dim>
void Simulation<Dim>::start_band_columns() {
  if (!model_.contact.band_columns) {
    return;
  }
  const ColumnMaterial material = material_of_base(parameters_, model_, particles_);
  const double thickest = parameters_.band.thickness.largest();
  if (thickest >= material.depth) {
    throw UserError(
        fmt::format("{}: the band is up to {} m thick, and the slide above it {} m on average. Use a thinner band.",
                    config::location_of(parameters_, "band.thickness"), thickest, rounded_text(material.depth, 3)));
  }
  band_columns_ = std::make_unique<band::BasalSegments<Dim>>(make_columns_model(parameters_, model_, material),
                                                             model_.motion.gravity);
  column_time_ = 0.0;
}

template <int Dim>
void Simulation<Dim>::band_columns_follow(const mpm::SparseGrid<Dim>& grid,
                                          const terrain::GroundOnGrid<Dim>& ground_on_grid, mpm::Nodes<Dim>& nodes) {
  if (!band_columns_) {
    return;
  }
  const double cell = parameters_.grid.cell;
  const terrain::Surface<Dim>& surface = *model_.ground;
  const typename band::BasalSegments<Dim>::Ground ground{
      [&](const auto& point) { return static_cast<Real>(surface.height(point.template cast<double>())); },
      [&](const auto& point) -> Vector<Real, Dim> {
        return surface.normal_below(point.template cast<double>(), cell).template cast<Real>();
      },
      [&](const auto& point) { return model_.motion.width.at(point[0]); }};
  const auto node_normal = [&](std::size_t b, std::size_t k) {
    const bool is_near = ground_on_grid.any_candidate(b) && ground_on_grid.block(b)[k].candidate;
    return is_near ? &ground_on_grid.block(b)[k].normal : nullptr;
  };
  const auto thickness = static_cast<Real>(band_thickness());
  band_columns_->update_from_nodes(grid, ground, node_normal, thickness, dt_, nodes);
  column_time_ += static_cast<double>(dt_);
  if (column_time_ + 0.5 * static_cast<double>(dt_) > parameters_.band.column_step) {
    const auto duration = static_cast<Real>(column_time_);
    band_columns_->follow(grid, ground, node_normal, duration, nodes);
    band_columns_->step(thickness, duration);
    column_time_ = 0.0;
  }
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                   \
  template void Simulation<Dim>::restore_band_columns(const std::vector<double>&);                                   \
  template void Simulation<Dim>::start_band_columns();                                                               \
  template void Simulation<Dim>::band_columns_follow(const mpm::SparseGrid<Dim>&, const terrain::GroundOnGrid<Dim>&, \
                                                     mpm::Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
