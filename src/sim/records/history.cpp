#include "sim/records/history.hpp"

#include <cmath>

#include "band/base_sums.hpp"
#include "sim/direction.hpp"

namespace thawslide::sim {

namespace {

// Adds the means of the band, over its particles or, if the band consists of columns, over the base.
template <int Dim>
void add_band(const Simulation<Dim>& simulation, const BodySums<Dim>& sums, HistoryRow& row) {
  const auto add = [&](const char* name, double value) { row.emplace_back(name, value); };
  if (const auto* columns = simulation.band_columns()) {
    const band::BaseMeans base = band::means_of(*columns);
    add("band_temperature_C", base.temperature);
    add("band_saturation", base.saturation);
    add("band_pore_pressure_Pa", base.pore_pressure);
    add("band_normal_pressure_Pa", base.load);
    add("band_shear_Pa", simulation.contact().shear_force / simulation.contact().area);
    add("band_thickness_m", base.thickness);
    add("band_max_temperature_C", base.max_temperature);
    add("band_max_wet_temperature_C", base.max_wet_temperature);
    add("band_dry_fraction", base.dry_fraction);
    add("band_max_pressure_ratio", base.max_pressure_ratio);
    return;
  }
  const double mass = sums.band_mass > 0.0 ? sums.band_mass : std::nan("");
  add("band_temperature_C", sums.band_temperature / mass);
  add("band_saturation", sums.band_saturation / mass);
  add("band_pore_pressure_Pa", sums.band_pore_pressure / mass);
}

// Adds the heat and water balances of band columns; returns the heat held by the columns minus the heat supplied.
template <int Dim, class Add>
double add_columns(const Simulation<Dim>& simulation, const Add& add) {
  const auto* columns = simulation.band_columns();
  if (columns == nullptr) {
    return 0.0;
  }
  const band::ColumnSums sums = band::sums_of(*columns);
  const band::ColumnLedger& budget = columns->budget();
  const double heat_in = budget.created_heat + budget.body_heat + budget.ground_heat;
  const double heat_out = budget.vented_heat + budget.steam_heat + budget.left_heat;
  const double water_in = budget.created_water + budget.body_water;
  const double water_out = budget.vented_water + budget.steam + budget.left_water;
  add("base_area_m2", sums.area);
  add("column_heat_J", sums.heat);
  add("column_intake_J", heat_in);
  add("column_drained_J", budget.vented_heat);
  add("column_steam_J", budget.steam_heat);
  add("column_left_J", budget.left_heat);
  add("column_water_kg", sums.water);
  add("column_intake_kg", water_in);
  add("column_drained_kg", budget.vented_water);
  add("column_steam_kg", budget.steam);
  add("column_left_kg", budget.left_water);
  add("column_water_residual_kg", sums.water + water_out - water_in);
  add("column_opening_m3", sums.opening);
  add("column_void_m3", sums.gas_void);
  return sums.heat + heat_out - heat_in;
}

// Adds the entrained mass, the remaining bed, and the balances of both. `add` takes the name and a number per metre of
// width.
template <int Dim, class Add>
void add_bed(const Simulation<Dim>& simulation, const Add& add) {
  const auto* bed = simulation.bed();
  if (bed == nullptr) {
    return;
  }
  const auto sums = bed->sums();
  const Budget<Dim>& budget = simulation.budget();
  const double entrained = sums.loose + budget.bed_joined_mass;
  add("entrained_mass_kg", entrained);
  add("entrained_volume_m3", entrained / bed->material().density);
  add("entrained_work_J", budget.bed_work);
  add("entrained_heat_J", budget.bed_heat);
  add("loose_mass_kg", sums.loose);
  add("bed_mass_kg", sums.left);
  add("bed_residual_kg", sums.left + entrained - sums.initial);
  add("bed_residual_J", budget.bed_work - budget.bed_joined_kinetic - budget.bed_heat - sums.loose_work);
}

template <int Dim>
void add_ledger(const Simulation<Dim>& simulation, const BodySums<Dim>& sums, double width, HistoryRow& row) {
  const Budget<Dim>& budget = simulation.budget();
  const auto add = [&](const char* name, double value) { row.emplace_back(name, width * value); };
  const double strain = budget.stress_work - budget.plastic;
  const double stored = sums.kinetic + sums.potential + strain;
  const double dissipated =
      budget.plastic + budget.viscous + budget.damping + budget.friction_work + budget.contact_loss;
  add("kinetic_J", sums.kinetic);
  add("potential_J", sums.potential);
  add("strain_J", strain);
  add("plastic_J", budget.plastic);
  add("viscous_J", budget.viscous);
  add("damping_J", budget.damping);
  add("pore_work_J", budget.pore_work);
  add("friction_work_J", budget.friction_work);
  add("contact_loss_J", budget.contact_loss);
  add("frame_work_J", budget.frame_work);
  add("friction_heat_J", budget.friction_heat);
  add("converted_J", budget.converted);
  add("sensible_J", sums.sensible);
  add("latent_J", sums.latent);
  add("boundary_heat_J", budget.boundary_heat);
  add("band_rescale_J", budget.band_rescale);
  add("advection_J", budget.advection);
  add("capacity_heat_J", budget.capacity_heat);
  add("porosity_heat_J", budget.porosity_heat);
  add("drained_heat_J", budget.drained_heat);
  add("numerical_J", budget.numerical);
  add("mechanical_residual_J", stored + dissipated + budget.pore_work - budget.frame_work - budget.numerical +
                                   budget.left_mechanical + budget.bed_work - budget.joined_mechanical -
                                   budget.initial_mechanical);
  const double in_columns = add_columns(simulation, add);
  add("thermal_residual_J", in_columns + sums.sensible + sums.latent - budget.initial_thermal - budget.friction_heat -
                                budget.boundary_heat - budget.band_rescale - budget.advection - budget.capacity_heat -
                                budget.porosity_heat + budget.drained_heat + budget.left_thermal -
                                budget.joined_thermal);
  add("mass_kg", sums.mass);
  add("rock_kg", sums.rock);
  add("ice_kg", sums.ice);
  add("water_kg", sums.water);
  add("pore_water_kg", sums.water + sums.seeped);
  add("drained_water_kg", budget.drained_water);
  add("vented_water_kg", budget.vented_water);
  add("seepage_residual_kg", sums.seeped + budget.left_seeped + budget.drained_water + budget.vented_water);
  add("pore_void_m3", sums.gas);
  add("mass_residual_kg", sums.mass + budget.left_mass - budget.joined_mass - budget.initial_mass);
  add("left_mass_kg", budget.left_mass);
  add("left_mechanical_J", budget.left_mechanical);
  add("left_heat_J", budget.left_thermal);
  if (config::guards_remove(simulation.parameters())) {
    add("removed_mass_kg", budget.removed_mass);
  }
  add_bed(simulation, add);
  const Vector<double, Dim> residual = sums.momentum + budget.left_momentum + budget.bed_impulse -
                                       budget.joined_momentum - budget.initial_momentum - budget.gravity_impulse -
                                       budget.ground_impulse - budget.constraint_impulse;
  const auto add_vector = [&](const char* name, const char* unit, const Vector<double, Dim>& value) {
    for (int a = 0; a < Dim; ++a) {
      row.emplace_back(fmt::format("{}_{}_{}", name, Dim == 2 ? "xy"[a] : "xyz"[a], unit), width * value[a]);
    }
  };
  add_vector("momentum", "N_s", sums.momentum);
  add_vector("left_momentum", "N_s", budget.left_momentum);
  add_vector("gravity_impulse", "N_s", budget.gravity_impulse);
  add_vector("ground_impulse", "N_s", budget.ground_impulse);
  add_vector("constraint_impulse", "N_s", budget.constraint_impulse);
  if (simulation.bed() != nullptr) {
    add_vector("entrained_momentum", "N_s", budget.bed_impulse);
  }
  add_vector("momentum_residual", "N_s", residual);
}

}  // namespace

template <int Dim>
double front_position(const Simulation<Dim>& simulation) {
  return front_along_x(simulation).position;
}

template <int Dim>
HistoryRow history_row(const Simulation<Dim>& simulation) {
  const FrontAlongX front = front_along_x(simulation);
  return history_row(simulation, {front.position, front.direction * (front.position - front.rear)});
}

template <int Dim>
HistoryRow history_row(const Simulation<Dim>& simulation, const FrontInRow& front) {
  const config::Case& parameters = simulation.parameters();
  const BodySums<Dim> sums = simulation.sum_over_body();
  const auto& contact = simulation.contact();
  const double width = parameters.general.width.factor();
  HistoryRow row;
  row.emplace_back("time_s", simulation.time());
  row.emplace_back("step", static_cast<double>(simulation.step_number()));
  row.emplace_back("dt_s", simulation.last_step());
  const auto mean = [&](double sum) { return sum / sums.mass; };
  row.emplace_back("mean_velocity_m_s", mean(sums.momentum.norm()));
  row.emplace_back("max_velocity_m_s", std::sqrt(sums.largest_speed2));
  row.emplace_back("mean_displacement_m", mean(sums.displacement));
  row.emplace_back("front_position_m", front.position);
  row.emplace_back("runout_m", front.runout);
  add_band(simulation, sums, row);
  row.emplace_back("band_friction_coefficient",
                   contact.area > 0.0 ? (contact.friction_area / contact.area) : std::nan(""));
  row.emplace_back("mean_plastic_strain", mean(sums.plastic_strain));
  row.emplace_back("dilation_volume_m3", width * sums.volume_change);
  row.emplace_back("dilation_fraction", sums.volume_change / sums.initial_volume);
  const char* axes = Dim == 2 ? "xy" : "xyz";
  const Vector<double, Dim> weight = sums.mass * simulation.model().motion.gravity;
  // Before the first step, the ground carries the weight of the mass at rest.
  const bool is_carried = simulation.ground() != nullptr && parameters.mechanics.enabled;
  const Vector<double, Dim> force = simulation.step_number() == 0 && is_carried ? weight : contact.force;
  for (int a = 0; a < Dim; ++a) {
    row.emplace_back(fmt::format("basal_force_{}_N", axes[a]), width * force[a]);
  }
  for (int a = 0; a < Dim; ++a) {
    row.emplace_back(fmt::format("seismic_force_{}_N", axes[a]), width * (force[a] - weight[a]));
  }
  add_ledger(simulation, sums, width, row);
  return row;
}

template HistoryRow history_row<2>(const Simulation<2>&);
template HistoryRow history_row<3>(const Simulation<3>&);
template HistoryRow history_row<2>(const Simulation<2>&, const FrontInRow&);
template HistoryRow history_row<3>(const Simulation<3>&, const FrontInRow&);
template double front_position<2>(const Simulation<2>&);
template double front_position<3>(const Simulation<3>&);

}  // namespace thawslide::sim
