#include "sim/records/history.hpp"

#include <cmath>

#include "band/base_sums.hpp"
#include "sim/direction.hpp"
#include "sim/records/output_columns.hpp"

namespace thawslide::sim {

namespace {

// Groups of the reference.
enum Group : std::size_t { motion, band, band_columns, force, mechanical, heat, mass, guards, momentum, bed };

// State from which a row is computed.
template <int Dim>
struct State {
  double time = 0, step = 0, last_step = 0, width = 1;
  FrontInRow front{};
  BodySums<Dim> body;
  Budget<Dim> budget;
  terrain::ContactWork<Dim> contact;
  Vector<double, Dim> force = Vector<double, Dim>::Zero(), weight = force;  // on the ground, and of the slide
  band::BaseSums base{};           // without columns: over the particles of the band, with mass for area
  band::ColumnLedger exchanged{};  // by the columns
  typename terrain::Bed<Dim>::Sums bed{};
  double bed_density = 1;
};

template <int Dim>
struct Column {
  // A number, or one number per axis.
  struct Value {
    Value(double number) : axes(Vector<double, Dim>::Constant(number)) {}
    template <class Expression>
    Value(const Eigen::MatrixBase<Expression>& vector) : axes(vector) {}

    Vector<double, Dim> axes;
  };

  Group group;
  const char *name, *unit, *meaning;  // as in OutputColumn
  Value value;
  bool is_described_last = false;  // of its group
};

// All columns in the order of the table.
template <int Dim>
std::vector<Column<Dim>> columns_of(const State<Dim>& s) {
  const Budget<Dim>& b = s.budget;
  const band::ColumnLedger& c = s.exchanged;
  const double w = s.width;
  const auto mean = [&](double sum) { return sum / s.body.mass; };
  const double strain = b.stress_work - b.plastic;
  const double stored = s.body.kinetic + s.body.potential + strain;
  const double dissipated = b.plastic + b.viscous + b.damping + b.friction_work + b.contact_loss;
  const double heat_in = c.created_heat + c.body_heat + c.ground_heat;
  const double heat_out = c.vented_heat + c.steam_heat + c.left_heat;
  const double water_in = c.created_water + c.body_water;
  const double water_out = c.vented_water + c.steam + c.left_water;
  const double entrained = s.bed.loose + b.bed_joined_mass;
  return {
      {motion, "time_s", "s", "simulated time", s.time},
      {motion, "step", "1", "number of time steps performed", s.step},
      {motion, "dt_s", "s", "length of the last time step", s.last_step},
      {motion, "mean_velocity_m_s", "m/s", "magnitude of the total momentum divided by the total mass",
       mean(s.body.momentum.norm())},
      {motion, "max_velocity_m_s", "m/s", "speed of the fastest particle", std::sqrt(s.body.largest_speed2)},
      {motion, "mean_displacement_m", "m", "mass-weighted mean of the path lengths of the particles",
       mean(s.body.displacement)},
      {motion, "front_position_m", "m",
       "x behind which 99.5 % of the mass of bodies that have moved is located; in 3D the distance along the path",
       s.front.position},
      {motion, "runout_m", "m",
       "distance from the rear of the bodies that have moved, at t = 0, to the front; in 3D along the path",
       s.front.runout},
      {band, "band_temperature_C", "C", "mean temperature of the band", s.base.mean(s.base.temperature)},
      {band, "band_saturation", "1", "mean liquid saturation of the band", s.base.mean(s.base.saturation)},
      {band, "band_pore_pressure_Pa", "Pa", "mean pore pressure of the band", s.base.mean(s.base.pore_pressure)},
      {band_columns, "band_normal_pressure_Pa", "Pa", "mean normal pressure N, averaged over `band.load_time`",
       s.base.mean(s.base.load)},
      {band_columns, "band_shear_Pa", "Pa",
       "shear traction of the base over the area in contact, by friction and cohesion, in the last time step",
       s.contact.shear_force / s.contact.area},
      {band_columns, "band_thickness_m", "m", "mean thickness of the band", s.base.mean(s.base.thickness)},
      {band_columns, "band_max_temperature_C", "C", "maximum temperature of any column",
       s.base.known(s.base.max_temperature)},
      {band_columns, "band_max_wet_temperature_C", "C",
       "maximum temperature of cells that contain more than a thousandth of the water of full pores",
       s.base.known(s.base.max_wet_temperature)},
      {band_columns, "band_dry_fraction", "1", "fraction of the base at which a cell of the band has no water left",
       s.base.mean(s.base.dry_area)},
      {band_columns, "band_max_pressure_ratio", "1", "maximum ratio of pore pressure P to averaged N over all columns",
       s.base.max_pressure_ratio},
      {band, "band_friction_coefficient", "1",
       "area-weighted mean of the friction coefficient mu_e over the nodes in contact, in the last time step",
       s.contact.area > 0.0 ? s.contact.friction_area / s.contact.area : std::nan("")},
      {motion, "mean_plastic_strain", "1", "mass-weighted mean of the equivalent plastic strain",
       mean(s.body.plastic_strain)},
      {motion, "dilation_volume_m3", "m3",
       "change of the particles' volume since t = 0; for entrained bed material since its entrainment",
       w * s.body.volume_change},
      {motion, "dilation_fraction", "1", "that change as a fraction of the initial volume",
       s.body.volume_change / s.body.initial_volume},
      {force, "basal_force_*_N", "N",
       "force on the ground in the last time step, and on the sides of a 2D section whose width varies; at t = 0 the "
       "weight",
       w * s.force},
      {force, "seismic_force_*_N", "N", "the same less the static weight: the force that a seismic inversion gives",
       w * (s.force - s.weight)},
      {mechanical, "kinetic_J", "J", "kinetic energy, the sum of m v^2/2", w * s.body.kinetic},
      {mechanical, "potential_J", "J", "potential energy, minus the sum of m g.x from the origin of the coordinates",
       w * s.body.potential},
      {mechanical, "strain_J", "J", "stress work less plastic work", w * strain},
      {mechanical, "plastic_J", "J", "energy dissipated by yielding", w * b.plastic},
      {mechanical, "viscous_J", "J", "energy dissipated by viscosity", w * b.viscous},
      {mechanical, "damping_J", "J", "energy dissipated by mass damping", w * b.damping},
      {mechanical, "pore_work_J", "J",
       "work of the pore pressure while the body changes its volume, with `mechanics.effective_stress`",
       w * b.pore_work},
      {mechanical, "friction_work_J", "J", "energy dissipated by sliding on the ground", w * b.friction_work},
      {mechanical, "contact_loss_J", "J", "energy dissipated by impact on the ground and the sides, and by sticking",
       w * b.contact_loss},
      {mechanical, "frame_work_J", "J", "work of rigid frames on the material", w * b.frame_work},
      {heat, "friction_heat_J", "J", "part of the friction work that heated the material", w * b.friction_heat},
      {heat, "converted_J", "J",
       "the other part of the friction work, summed separately at the contact nodes. It is all of the work if "
       "`heat.enabled` is false",
       w * b.converted},
      {heat, "sensible_J", "J", "sensible heat, zero at `freezing.reference_temperature`", w * s.body.sensible},
      {heat, "latent_J", "J", "latent heat, zero for wholly frozen material", w * s.body.latent},
      {heat, "boundary_heat_J", "J", "heat gained through the sides of the domain", w * b.boundary_heat},
      {heat, "band_rescale_J", "J", "heat created by a change of the band thickness", w * b.band_rescale},
      {heat, "advection_J", "J", "heat created by the advection term in the form that does not conserve heat",
       w * b.advection},
      {heat, "capacity_heat_J", "J",
       "heat created by an update with the old apparent capacity, with `heat.update = \"apparent_capacity\"`",
       w * b.capacity_heat},
      {heat, "drained_heat_J", "J", "heat lost with drained water, with `heat.advection_form = \"conservative\"`",
       w * b.drained_heat},
      {mechanical, "numerical_J", "J", "energy created by the transfers (FLIP, MUSL, the filter of FMPM), computed",
       w * b.numerical},
      {mechanical, "mechanical_residual_J", "J", "residual of the mechanical energy budget",
       w * (stored + dissipated + b.pore_work - b.frame_work - b.numerical + b.left_mechanical + b.bed_work -
            b.joined_mechanical - b.initial_mechanical),
       true},
      {band_columns, "base_area_m2", "m2", "area of the base that has columns", w * s.base.area},
      {band_columns, "column_heat_J", "J",
       "heat in the columns, with the friction heat accumulated for their next step", w * s.base.heat},
      {band_columns, "column_intake_J", "J",
       "heat gained with new columns, from the body and from the ground, less the return to the body when columns "
       "become shorter. Heat of cold material is negative",
       w * heat_in},
      {band_columns, "column_drained_J", "J", "heat lost with drained water", w * c.vented_heat},
      {band_columns, "column_steam_J", "J", "heat lost as steam", w * c.steam_heat},
      {band_columns, "column_left_J", "J", "heat lost with removed columns", w * c.left_heat},
      {band_columns, "column_water_kg", "kg", "ice and water in the columns", w * s.base.water},
      {band_columns, "column_intake_kg", "kg",
       "ice and water gained with new columns and from the body, less the return to the body when columns become "
       "shorter",
       w * water_in},
      {band_columns, "column_drained_kg", "kg", "water lost by drainage", w * c.vented_water},
      {band_columns, "column_steam_kg", "kg", "water lost as steam", w * c.steam},
      {band_columns, "column_left_kg", "kg", "ice and water lost with removed columns", w * c.left_water},
      {band_columns, "column_water_residual_kg", "kg", "residual of the columns' water budget",
       w * (s.base.water + water_out - water_in)},
      {band_columns, "column_opening_m3", "m3", "volume that water at P = N has opened along the base",
       w * s.base.opening},
      {band_columns, "column_void_m3", "m3", "volume of gas in the pores of the columns", w * s.base.gas_void},
      {heat, "thermal_residual_J", "J", "residual of the thermal energy budget",
       w * (s.base.heat + heat_out - heat_in + s.body.sensible + s.body.latent - b.initial_thermal - b.friction_heat -
            b.boundary_heat - b.band_rescale - b.advection - b.capacity_heat + b.drained_heat + b.left_thermal -
            b.joined_thermal),
       true},
      {mass, "mass_kg", "kg", "mass of all particles", w * s.body.mass},
      {mass, "rock_kg", "kg", "mass of rock", w * s.body.rock},
      {mass, "ice_kg", "kg", "mass of ice; melting and freezing use the scaled volume `V/xi`", w * s.body.ice},
      {mass, "water_kg", "kg", "mass of water. Rock, ice and water sum to `mass_kg`", w * s.body.water},
      {mass, "pore_water_kg", "kg", "`water_kg` with the gain and loss of the particles by seepage",
       w * (s.body.water + s.body.seeped)},
      {mass, "drained_water_kg", "kg", "water that seepage removed at the surface", w * b.drained_water},
      {mass, "vented_water_kg", "kg", "water that seepage removed into frozen pores", w * b.vented_water},
      {mass, "seepage_residual_kg", "kg", "residual of the seepage budget",
       w * (s.body.seeped + b.left_seeped + b.drained_water + b.vented_water)},
      {mass, "pore_void_m3", "m3", "volume of gas in the pores of the band's own material, `V/xi`", w * s.body.gas},
      {mass, "mass_residual_kg", "kg", "residual of the mass budget",
       w * (s.body.mass + b.left_mass - b.joined_mass - b.initial_mass), true},
      {mass, "left_mass_kg", "kg", "mass of particles removed when they left (`grid.leaving`) or by guards",
       w * b.left_mass},
      {mechanical, "left_mechanical_J", "J", "kinetic and potential energy of removed particles",
       w * b.left_mechanical},
      {heat, "left_heat_J", "J", "heat of removed particles", w * b.left_thermal},
      {guards, "removed_mass_kg", "kg", "part of `left_mass_kg` that guards removed", w * b.removed_mass},
      {bed, "entrained_mass_kg", "kg", "mass removed from the bed", w * entrained},
      {bed, "entrained_volume_m3", "m3", "its volume at the density of the bed", w * (entrained / s.bed_density)},
      {bed, "entrained_work_J", "J", "mechanical energy transferred to entrained material", w * b.bed_work},
      {bed, "entrained_heat_J", "J", "part of that energy that became heat of new particles", w * b.bed_heat},
      {bed, "loose_mass_kg", "kg", "part of the entrained mass that has not been converted to particles yet",
       w * s.bed.loose, true},
      {bed, "bed_mass_kg", "kg", "mass that remains in the bed", w * s.bed.left, true},
      {bed, "bed_residual_kg", "kg", "residual of the bed's mass budget", w * (s.bed.left + entrained - s.bed.initial),
       true},
      {bed, "bed_residual_J", "J", "residual of the budget of `entrained_work_J`",
       w * (b.bed_work - b.bed_joined_kinetic - b.bed_heat - s.bed.loose_work), true},
      {momentum, "momentum_*_N_s", "N s", "total momentum", w * s.body.momentum},
      {momentum, "left_momentum_*_N_s", "N s", "momentum of removed particles", w * b.left_momentum},
      {momentum, "gravity_impulse_*_N_s", "N s", "impulse of gravity", w * b.gravity_impulse},
      {momentum, "ground_impulse_*_N_s", "N s",
       "impulse of the ground, which also holds bodies before their release, and of the sides of a 2D section whose "
       "width varies",
       w * b.ground_impulse},
      {momentum, "constraint_impulse_*_N_s", "N s",
       "impulse of the sides of the domain, of rigid frames and of mass damping", w * b.constraint_impulse},
      {bed, "entrained_momentum_*_N_s", "N s", "momentum transferred to entrained material", w * b.bed_impulse},
      {momentum, "momentum_residual_*_N_s", "N s", "residual of the momentum budget",
       w * (s.body.momentum + b.left_momentum + b.bed_impulse - b.joined_momentum - b.initial_momentum -
            b.gravity_impulse - b.ground_impulse - b.constraint_impulse)},
  };
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
  State<Dim> state{.time = simulation.time(),
                   .step = static_cast<double>(simulation.step_number()),
                   .last_step = simulation.last_step(),
                   .width = parameters.general.width.factor(),
                   .front = front,
                   .body = simulation.sum_over_body(),
                   .budget = simulation.budget(),
                   .contact = simulation.contact()};
  state.weight = state.body.mass * simulation.model().motion.gravity;
  // Before the first step, the ground carries the weight of the mass at rest.
  const bool is_carried = simulation.ground() != nullptr && parameters.mechanics.enabled;
  state.force = simulation.step_number() == 0 && is_carried ? state.weight : state.contact.force;
  if (simulation.has_band_columns()) {
    const band::BaseTotals totals = simulation.base_totals();
    state.base = totals.sums;
    state.exchanged = totals.budget;
  } else {
    state.base.area = state.body.band_mass;
    state.base.temperature = state.body.band_temperature;
    state.base.saturation = state.body.band_saturation;
    state.base.pore_pressure = state.body.band_pore_pressure;
  }
  if (simulation.bed() != nullptr) {
    state.bed = simulation.bed()->sums();
    state.bed_density = simulation.bed()->material().density;
  }
  HistoryRow row;
  for (const Column<Dim>& column : columns_of(state)) {
    if ((column.group == band_columns && !simulation.has_band_columns()) ||
        (column.group == bed && simulation.bed() == nullptr) ||
        (column.group == guards && !config::guards_remove(parameters))) {
      continue;
    }
    std::string name = column.name;
    const std::size_t star = name.find('*');
    for (int a = 0; a < (star == std::string::npos ? 1 : Dim); ++a) {
      if (star != std::string::npos) {
        name[star] = "xyz"[a];
      }
      row.emplace_back(name, column.value.axes[a]);
    }
  }
  return row;
}

const std::vector<ColumnGroup>& history_columns() {
  static const std::vector<ColumnGroup> described = [] {
    std::vector<ColumnGroup> groups{
        {"Time and motion", "", {}},
        {"Band", "", {}},
        {"Band columns", "with `band.model = \"columns\"`", {}},
        {"Force on the ground", "", {}},
        {"Mechanical energy", "", {}},
        {"Heat", "", {}},
        {"Mass and water", "", {}},
        {"Guards", "if `guards.not_finite` or `guards.volume` is `\"remove\"`", {}},
        {"Momentum", "", {}},
        {"Erodible bed", "with `[bed]`", {}},
    };
    for (const bool last : {false, true}) {
      for (const Column<3>& column : columns_of(State<3>{})) {
        if (column.is_described_last == last) {
          groups[column.group].columns.push_back({column.name, column.unit, column.meaning});
        }
      }
    }
    return groups;
  }();
  return described;
}

template HistoryRow history_row<2>(const Simulation<2>&);
template HistoryRow history_row<3>(const Simulation<3>&);
template HistoryRow history_row<2>(const Simulation<2>&, const FrontInRow&);
template HistoryRow history_row<3>(const Simulation<3>&, const FrontInRow&);
template double front_position<2>(const Simulation<2>&);
template double front_position<3>(const Simulation<3>&);

}  // namespace thawslide::sim
