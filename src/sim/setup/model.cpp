#include "sim/setup/model.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "config/body_layers.hpp"
#include "config/grounds.hpp"
#include "physics/softening.hpp"
#include "physics/tension_gap.hpp"
#include "sim/setup/domain_bottom.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/setup/substrates.hpp"
#include "terrain/height_field.hpp"

namespace thawslide::sim {

namespace {

double radians(double degrees) { return degrees * pi / 180.0; }

// bodies: number of bodies, with that of the entrained bed material.
mpm::BetweenBodies between_bodies(const config::Case& parameters, std::size_t bodies, bool has_held) {
  mpm::BetweenBodies between;
  const config::BodyLayers layers = config::body_layers(parameters);
  if (layers.count == 1 && !has_held) {
    return between;
  }
  between.layers = layers.count;
  between.has_held = has_held;
  between.layer_of_body.assign(bodies, 0);
  std::copy(layers.of_body.begin(), layers.of_body.end(), between.layer_of_body.begin());
  for (const double angle : layers.friction_angle) {
    between.friction.push_back(std::tan(radians(angle)));
  }
  for (std::size_t layer = 0; layer < layers.count; ++layer) {
    between.friction[layer * (layers.count + 1)] = mpm::rough;  // bonded bodies, while one of them is held
  }
  return between;
}

physics::Strength strength_of(const config::Material& material, double cell) {
  const double of_slip = physics::softening_strain_of_slip(material.softening_slip, cell);
  const double softening_strain = material.softening_slip > 0.0 ? of_slip : material.softening_strain;
  physics::Strength strength{.friction_angle = material.friction_angle,
                             .dilation_angle = material.dilation_angle,
                             .cohesion = material.cohesion,
                             .residual_cohesion = material.residual_cohesion,
                             .tension_cutoff = material.tension_cutoff,
                             .residual_friction_angle = material.residual_friction_angle};
  if (softening_strain > 0.0) {  // otherwise nothing softens
    strength.softening_strain = softening_strain;
  }
  return strength;
}

// Without viscosity_time, `viscosity_number` times the time that an elastic wave in rock takes across a cell [s]; 0 if
// the case has no mechanics.
double viscosity_time_of(const config::Material& material, const physics::Elastic& elastic,
                         const config::Case& parameters) {
  if (!std::isnan(material.viscosity_time)) {
    return material.viscosity_time;
  }
  const double wave_speed = std::sqrt(elastic.p_wave_modulus() / parameters.phases.rock_density);
  return wave_speed > 0.0 ? material.viscosity_number * parameters.grid.cell / wave_speed : 0.0;
}

mpm::MaterialModel make_material(const config::Material& material, const config::Case& parameters) {
  mpm::MaterialModel model;
  model.elastic = physics::Elastic::from_young_poisson(material.youngs_modulus, material.poisson_ratio);
  model.gaps_close_first = material.gaps_close_first;
  model.viscosity_time = viscosity_time_of(material, model.elastic, parameters);
  model.hydraulic_conductivity = material.hydraulic_conductivity;
  if (material.law == config::LawKind::mohr_coulomb && parameters.mechanisms.deformation) {
    const physics::Strength strength = strength_of(material, parameters.grid.cell);
    if (strength.residual_friction_angle < strength.friction_angle) {
      model.law = physics::MohrCoulomb<true>::make(model.elastic, strength);
    } else {
      model.law = physics::MohrCoulomb<>::make(model.elastic, strength);
    }
  } else {
    model.law = physics::LinearElastic{};
  }
  return model;
}

template <int Dim>
void set_transfer(const config::Case& parameters, const Vector<double, Dim>& origin, mpm::MotionModel<Dim>& motion) {
  const config::Mechanics& mechanics = parameters.mechanics;
  motion.shape = mechanics.shape_function;
  motion.transfer =
      mechanics.transfer == config::Transfer::apic ? mpm::TransferKind::apic : mpm::TransferKind::flip_pic;
  motion.pic_fraction = mechanics.pic_fraction;
  motion.filter_order = mechanics.transfer == config::Transfer::fmpm ? mechanics.fmpm_order : 0;
  for (std::size_t a = 0; a < Dim; ++a) {
    const double length = parameters.grid.max[a] - origin[static_cast<int>(a)];
    if (parameters.grid.boundary[2 * a] != config::BoundaryKind::open) {
      motion.sides.lower[a] = 0;
    }
    if (parameters.grid.boundary[2 * a + 1] != config::BoundaryKind::open) {
      motion.sides.upper[a] = static_cast<int>(std::lround(length / parameters.grid.cell));
    }
  }
}

template <int Dim>
mpm::Constraints<Dim> make_constraints(const config::Case& parameters, const Vector<double, Dim>& origin) {
  mpm::DomainFaces<Dim> faces;
  for (std::size_t a = 0; a < Dim; ++a) {
    const int i = static_cast<int>(a);
    faces.extent[i] = parameters.grid.max[a] - origin[i];
    for (std::size_t side = 0; side < 2; ++side) {
      faces.faces[2 * a + side] = parameters.grid.boundary[2 * a + side];
    }
  }
  mpm::Constraints<Dim> constraints{faces.extent, {faces}};
  Vector<double, Dim> zero = origin;  // of the grid
  if (parameters.terrain.kind == config::TerrainKind::flat) {
    zero[Dim - 1] = parameters.terrain.elevation;
  }
  for (const auto& [name, frame] : parameters.frames) {
    constraints.conditions.push_back(mpm::RigidFrame<Dim>::from(frame, zero));
  }
  return constraints;
}

terrain::BasalLaw make_basal_law(const config::Case& parameters) {
  const config::Basal& basal = parameters.basal;
  terrain::BasalLaw law;
  const auto laws_of = [](const config::GroundStrength& ground) -> terrain::GroundLaw {
    return {config::law_of<physics::basal::FrictionLaw>(ground), config::law_of<physics::basal::CohesionLaw>(ground)};
  };
  law.grounds = {laws_of(basal)};
  for (const auto& [name, substrate] : parameters.substrates) {
    law.grounds.push_back(laws_of(substrate));
  }
  law.clamp = basal.clamp;
  law.cap_pressure = basal.cap_pressure;
  law.heat_fraction = basal.heat_fraction;
  law.gravity = parameters.general.gravity;
  return law;
}

band::AnyHeatContent make_heat_content(const config::Case& parameters, const physics::Phases& phases) {
  const config::Freezing& freezing = parameters.freezing;
  const double reference = freezing.reference_temperature;
  const bool latent = parameters.heat.latent;
  if (freezing.curve == config::CurveKind::linear) {
    return physics::HeatContent<physics::LinearCurve>{phases, {reference, freezing.slope}, latent};
  }
  return physics::HeatContent<physics::PowerLawCurve>{phases, {reference, freezing.exponent}, latent};
}

void set_water_balance(const config::Case& parameters, band::BandPhysics& band) {
  const config::Pressure& pressure = parameters.pressure;
  band.frozen_rows = pressure.frozen_rows;
  band.ice_presses = pressure.frozen == config::FrozenPressure::ice_pressure;
  band.melt_contracts = pressure.melt_contraction;
  band.residual_stress = pressure.residual_stress;
  band.skeleton_compressibility = pressure.skeleton_compressibility;
  band.water.law = parameters.phases.water_expansion_law;
  band.water.constant = parameters.phases.water_expansion;
  band.conservative_advection =
      parameters.heat.enabled && parameters.heat.advection_form == config::AdvectionForm::conservative;
  band.rescaling_mixes =
      parameters.heat.enabled && parameters.band.thickness_change == config::ThicknessChange::conserving;
}

template <int Dim>
band::BandModel<Dim> make_band(const config::Case& parameters, const mpm::MotionModel<Dim>& motion,
                               const Vector<double, Dim>& extent) {
  band::BandModel<Dim> band;
  band.phases = motion.phases;
  band.heat_content = make_heat_content(parameters, band.phases);
  band.reference_temperature = parameters.freezing.reference_temperature;
  band.heat = parameters.heat.enabled;
  band.conduction = parameters.heat.conduction;
  band.advection = parameters.heat.advection && parameters.pressure.enabled;
  band.at_faces.extent = extent;
  for (std::size_t f = 0; f < 2 * Dim; ++f) {
    const config::HeatBoundary& face = parameters.heat.boundary[f];
    band.at_faces.faces[f] = {face.kind, face.value};
  }
  band.region = parameters.band.region;
  band.secant_capacity = parameters.heat.update == config::HeatUpdate::enthalpy;
  band.lubrication = motion.lubrication;
  band.pressure = parameters.pressure.enabled;
  band.thermal_pressurization = parameters.pressure.thermal_pressurization;
  band.volumetric_term = parameters.pressure.volumetric_term;
  band.seepage = parameters.pressure.seepage;
  band.normal_thickness = parameters.pressure.thickness_direction == config::ThicknessDirection::normal;
  band.thickness_each_step = parameters.pressure.thickness_update == config::ThicknessUpdate::each_step;
  band.gravity = parameters.general.gravity;
  set_water_balance(parameters, band);
  for (const auto& material : motion.materials) {
    band.hydraulic_conductivity.push_back(material.hydraulic_conductivity);
  }
  band.sizes = motion.sizes;
  band.shape = motion.shape;
  band.sides = motion.sides;
  band.width = motion.width;
  return band;
}

// Ground as a line over x, relative to the domain's lower corner; empty if it is not a line.
template <int Dim>
std::optional<terrain::Polyline> make_profile(const config::Case& parameters, const config::Site& site,
                                              const Vector<double, Dim>& origin) {
  const config::Terrain& terrain = parameters.terrain;
  const double base = origin[Dim - 1];
  switch (terrain.kind) {
    case config::TerrainKind::none:
    case config::TerrainKind::dem:
      return std::nullopt;
    case config::TerrainKind::flat:
    case config::TerrainKind::plane: {
      // Two points a kilometre apart; the line is extrapolated with its gradient.
      const double fall = terrain.kind == config::TerrainKind::plane ? std::tan(radians(terrain.slope)) : 0.0;
      const double left = terrain.elevation - fall * origin[0] - base;
      return terrain::Polyline({0.0, 1000.0}, {left, left - fall * 1000.0});
    }
    case config::TerrainKind::profile:
      break;
  }
  const config::ProfileTable profile = config::profile_of(parameters, site);
  std::vector<double> x = profile.distance;
  std::vector<double> height = profile.terrain;
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] -= origin[0];
    height[k] -= base;
  }
  return terrain::Polyline(std::move(x), std::move(height));
}

template <int Dim>
std::shared_ptr<const terrain::Surface<Dim>> make_terrain(const config::Case& parameters, const config::Site& site,
                                                          const Model<Dim>& model) {
  if constexpr (Dim == 3) {
    if (parameters.terrain.kind == config::TerrainKind::dem) {
      THAWSLIDE_ASSERT(site.ground != nullptr, "{}: no raster was read from {}", parameters.name,
                       parameters.terrain.file);
      Raster points = *site.ground;
      points.x -= model.origin[0];
      points.y -= model.origin[1];
      for (double& height : points.values) {
        height -= model.origin[2];
      }
      return std::make_shared<terrain::HeightField>(std::move(points));
    }
  }
  if (!model.profile) {
    return nullptr;
  }
  return std::make_shared<terrain::ProfileSurface<Dim>>(*model.profile);
}

}  // namespace

template <int Dim>
Model<Dim> make_model(const config::Case& parameters, const config::Site& site) {
  Model<Dim> model;
  for (std::size_t a = 0; a < Dim; ++a) {
    model.origin[static_cast<int>(a)] = a + 1 < Dim ? parameters.grid.min[a] : bottom_of_domain(parameters, site);
  }
  set_transfer(parameters, model.origin, model.motion);
  const double tilt = radians(parameters.general.gravity_tilt);
  if (parameters.general.width.varies()) {
    model.motion.width = mpm::SectionWidth(parameters.general.width.table, model.origin[0]);
  }
  model.motion.gravity.setZero();
  model.motion.gravity[0] = parameters.general.gravity * std::sin(tilt);
  model.motion.gravity[Dim - 1] = -parameters.general.gravity * std::cos(tilt);
  model.motion.phases = static_cast<const physics::Phases&>(parameters.phases);
  model.motion.effective_stress = parameters.mechanics.effective_stress && parameters.pressure.enabled;
  model.motion.lubrication = parameters.mechanisms.lubrication;
  for (const auto& [name, material] : parameters.materials) {
    model.material_names.push_back(name);
    model.motion.materials.push_back(make_material(material, parameters));
    const bool is_free = material.gaps_close_first && physics::gap_is_free(strength_of(material, parameters.grid.cell));
    model.free_gaps.push_back(is_free ? 1.0 : 0.0);
  }
  for (const auto& [name, body] : parameters.bodies) {
    model.body_names.push_back(name);
    model.motion.sizes.add(1.0 / static_cast<double>(2 * body.particles_per_axis));
  }
  if (parameters.bed.law != config::BedLaw::none) {  // entrained material is a separate body
    model.body_names.emplace_back("bed");
    model.motion.sizes.add(1.0 / static_cast<double>(2 * parameters.bed.particles_per_axis));
  }
  model.constraints = make_constraints<Dim>(parameters, model.origin);
  model.release_times = release_times(parameters, site, model.body_names.size());
  model.between_bodies = between_bodies(parameters, model.body_names.size(), !model.release_times.empty());
  model.constraints.first_held_layer = model.between_bodies.first_held_layer();
  model.splits_stretched = parameters.mechanics.enabled && parameters.mechanics.split_stretched;
  model.contact.law = make_basal_law(parameters);
  model.contact.pore_pressure = parameters.mechanisms.pressurization && parameters.pressure.enabled;
  model.contact.reads_mass = model.contact.pore_pressure || model.contact.law.depends_on_mass();
  model.contact.mass_damping = parameters.mechanics.mass_damping;
  model.contact.band_columns = parameters.band.model == config::BandKind::columns;
  model.contact.distance_check = parameters.basal.distance_check;
  model.band = make_band<Dim>(parameters, model.motion, model.constraints.extent);
  if (parameters.bed.law != config::BedLaw::none) {
    const auto saturation = model.band.with_heat_content(
        [&](const auto& content) { return content.curve.saturation(parameters.bed.temperature); });
    model.bed_density = physics::mixture_density(model.band.phases, parameters.bed.porosity, saturation);
  }
  model.profile = make_profile<Dim>(parameters, site, model.origin);
  if (const auto terrain = make_terrain(parameters, site, model)) {
    model.ground = std::make_shared<terrain::FollowingGround<Dim>>(
        terrain, parameters.grid.cell, model.constraints.extent.template head<Dim - 1>(), model.motion.sizes,
        model.motion.width, std::tan(radians(parameters.grid.steepest)));
  }
  model.substrates = make_substrates(parameters, site);
  return model;
}

template Model<2> make_model<2>(const config::Case&, const config::Site&);
template Model<3> make_model<3>(const config::Case&, const config::Site&);

namespace {

template <class Curve>
physics::ColumnModel<Curve> column_model(const config::Case& parameters, const physics::Phases& phases,
                                         const Curve& curve, const ColumnMaterial& material) {
  const config::Pressure& pressure = parameters.pressure;
  physics::ColumnModel<Curve> column;
  column.phases = phases;
  column.curve = curve;
  column.water_expansion = {parameters.phases.water_expansion_law, phases.water_expansion};
  column.porosity = material.porosity;
  column.hydraulic_conductivity = material.hydraulic_conductivity;
  column.skeleton_compressibility = pressure.skeleton_compressibility;
  column.residual_stress = pressure.residual_stress;
  column.at_frozen =
      pressure.frozen_rows == config::FrozenRows::vented ? physics::EndOfWater::vented : physics::EndOfWater::sealed;
  column.at_top = pressure.column_top;
  column.water_to_steam_viscosity = pressure.water_to_steam_viscosity;
  column.latent = parameters.heat.latent;
  column.conduction = parameters.heat.conduction;
  column.seepage = pressure.seepage;
  column.pressurization = pressure.enabled && pressure.thermal_pressurization;
  column.steam = parameters.heat.steam;
  column.ground_conductivity = phases.rock_conductivity;
  column.ground_capacity = phases.rock_density * phases.rock_heat_capacity;
  column.ground_cell = parameters.band.thickness.smallest() / physics::ColumnCells::band;
  return column;
}

}  // namespace

template <int Dim>
band::ColumnsModel make_columns_model(const config::Case& parameters, const Model<Dim>& model,
                                      const ColumnMaterial& material) {
  const config::Band& band = parameters.band;
  band::ColumnsModel columns;
  columns.column = model.band.with_heat_content([&](const auto& content) -> band::AnyColumnModel {
    return column_model(parameters, model.motion.phases, content.curve, material);
  });
  columns.body_temperature = material.temperature;
  columns.ground_temperature = std::isnan(band.ground_temperature) ? material.temperature : band.ground_temperature;
  columns.density = model.band.with_heat_content([&](const auto& content) {
    return physics::mixture_density(model.motion.phases, material.porosity,
                                    content.curve.saturation(columns.body_temperature));
  });
  columns.load_time = band.load_time;
  columns.step = band.column_step;
  columns.growth = band.growth;
  columns.grain_size = band.grain_size;
  columns.inertial_number = band.inertial_number;
  columns.growth_per_slip = band.growth_per_slip;
  columns.mixing_slip = band.mixing_slip;
  columns.rock_density = model.motion.phases.rock_density;
  columns.largest_thickness = material.depth;
  return columns;
}

template band::ColumnsModel make_columns_model(const config::Case&, const Model<2>&, const ColumnMaterial&);
template band::ColumnsModel make_columns_model(const config::Case&, const Model<3>&, const ColumnMaterial&);

}  // namespace thawslide::sim
