// Parameters of the model: [mechanics], [mechanisms], [band], [heat], [pressure], [block].
#include "config/table_declaration.hpp"

namespace thawslide::config {

namespace {

std::vector<Parameter<Mechanics>> mechanics_parameters() {
  const auto settles = [](const Case&, const Mechanics& mechanics) {
    return mechanics.initial_stress == InitialStress::settle;
  };
  const std::string when_settling = "when mechanics.initial_stress is \"settle\"";
  return {
      parameter(&Mechanics::enabled,
                {.key = "enabled",
                 .text = "motion and stress (Eqs. 10-16); false: nothing moves, as in the freezing bar",
                 .source = "Sec. 3.1"}),
      parameter(&Mechanics::shape_function,
                {.key = "shape_function", .text = "shape functions that carry momentum between particles and grid"}),
      parameter(&Mechanics::transfer,
                {.key = "transfer", .text = "how particles take their velocities from the grid", .source = "Eq. 13"}),
      parameter(&Mechanics::pic_share, {.key = "pic_share",
                                        .range = between(0, 1),
                                        .text = "share of the node velocities in a particle's; 0: FLIP, 1: PIC"})
          .required_if("when mechanics.transfer is \"blend\"",
                       [](const Case&, const Mechanics& mechanics) { return mechanics.transfer == Transfer::blend; }),
      parameter(&Mechanics::fmpm_order,
                {.key = "fmpm_order",
                 .range = between(2, 4),
                 .text = "order m of the filter of transfer \"fmpm\": the higher, the less it takes of long waves",
                 .source = "Hammerquist and Nairn 2017"}),
      parameter(&Mechanics::fmpm_interval, {.key = "fmpm_interval",
                                            .unit = "s",
                                            .range = above(0),
                                            .text = "simulated time from one filtering to the next"})
          .required_if("when mechanics.transfer is \"fmpm\"",
                       [](const Case&, const Mechanics& mechanics) { return mechanics.transfer == Transfer::fmpm; }),
      parameter(&Mechanics::initial_stress,
                {.key = "initial_stress", .text = "stress at t = 0, not given in the paper"}),
      parameter(&Mechanics::k0, {.key = "k0",
                                 .range = at_least(0),
                                 .text = "K0 of the geostatic stress: stress along the ground over stress across it"})
          .otherwise("nu / (1 - nu) of each material"),
      parameter(
          &Mechanics::slope_shear,
          {.key = "slope_shear", .text = "the geostatic stress holds the shear stress of an infinite slope as well"}),
      parameter(
          &Mechanics::effective_stress,
          {.key = "effective_stress",
           .text = "stress and strength inside the body are of the effective stress, sigma + P I; false: P acts on the "
                   "ground only",
           .source = "Eq. 10"}),
      parameter(&Mechanics::settle_time,
                {.key = "settle_time", .unit = "s", .range = above(0), .text = "time the body settles before t = 0"})
          .required_if(when_settling, settles),
      parameter(&Mechanics::settle_damping, {.key = "settle_damping",
                                             .unit = "1/s",
                                             .range = above(0),
                                             .text = "rate at which velocities are damped while the body settles"})
          .required_if(when_settling, settles),
      parameter(&Mechanics::mass_damping, {.key = "mass_damping",
                                           .unit = "1/s",
                                           .range = at_least(0),
                                           .text = "rate at which velocities are damped during the run; 0: none"}),
  };
}

std::vector<Parameter<Mechanisms>> mechanism_parameters() {
  return {
      parameter(
          &Mechanisms::deformation,
          {.key = "deformation",
           .text = "mechanism D: the body yields inside (Eq. 11); false: it is elastic, its strength out of reach",
           .source = "Sec. 3.3, Eq. 11"}),
      parameter(
          &Mechanisms::lubrication,
          {.key = "lubrication",
           .text = "mechanism L: friction follows melting and porosity (Eq. 25); false: Eq. 25 keeps those of t = 0",
           .source = "Sec. 3.3, Eqs. 17, 25"}),
      parameter(
          &Mechanisms::pressurization,
          {.key = "pressurization",
           .text = "mechanism P: pore pressure lowers friction (Eq. 17); false: P = 0 there, ice pressure included",
           .source = "Sec. 3.3, Eqs. 17, 21"}),
  };
}

std::vector<Parameter<Band>> band_parameters() {
  const auto grows = [](BandGrowth growth) {
    return [growth](const Case&, const Band& band) { return band.model == BandKind::columns && band.growth == growth; };
  };
  const auto is_scaled = [](const Case&, const Band& band) { return band.model == BandKind::scaled; };
  const auto has_columns = [](const Case&, const Band& band) { return band.model == BandKind::columns; };
  const std::string when_scaled = "when band.model is \"scaled\"", when_columns = "when band.model is \"columns\"";
  const std::string when_inertial = when_columns + " and band.growth is \"inertial\"";
  const std::string when_slip = when_columns + " and band.growth is \"slip\"";
  return {
      parameter(&Band::model, {.key = "model", .text = "what carries heat and pore pressure along the ground"})
          .otherwise(
              "\"columns\" where there is a terrain, band.thickness is given, and mechanics and heat are enabled; "
              "\"scaled\" elsewhere",
              [](const Case& read, Band& band) {
                const bool have_a_base = read.terrain.kind != TerrainKind::none && band.thickness.is_given() &&
                                         read.mechanics.enabled && read.heat.enabled;
                band.model = have_a_base ? BandKind::columns : BandKind::scaled;
              }),
      parameter(
          &Band::thickness,
          {.key = "thickness",
           .unit = "m",
           .range = above(0),
           .text = "thickness e of the shear band, constant or over time: with band.model \"columns\" that of their "
                   "band, with \"scaled\" it scales heat and seepage by xi = grid.cell / e",
           .source = "Sec. 2.3, Eq. 19"})
          .otherwise("no band: xi = 1")
          .usually({0.01, 2}, has_columns),
      parameter(&Band::region, {.key = "region",
                                .text = "particles that the scaling xi of band.model \"scaled\" acts on",
                                .source = "Sec. 2.3"})
          .only_if(when_scaled, "model", is_scaled),
      parameter(&Band::cut_cells,
                {.key = "cut_cells", .text = "band.model \"scaled\" where the ground cuts through cells"})
          .only_if(when_scaled, "model", is_scaled),
      parameter(&Band::thickness_change,
                {.key = "thickness_change",
                 .text = "what becomes of heat where e changes over time, or with band.cut_cells along the ground, and "
                         "where particles leave the first layer"}),
      parameter(&Band::growth, {.key = "growth", .text = "how the band of columns grows thicker"})
          .only_if(when_columns, "model", has_columns),
      parameter(&Band::grain_size, {.key = "grain_size",
                                    .unit = "m",
                                    .range = above(0),
                                    .text = "size d of grains, of growth \"inertial\"",
                                    .source = "Jop et al. 2006 (not checked)"})
          .only_if(when_inertial, "growth", grows(BandGrowth::inertial)),
      parameter(&Band::inertial_number, {.key = "inertial_number",
                                         .range = above(0),
                                         .text = "inertial number I up to which the band stays, of growth \"inertial\"",
                                         .source = "Jop et al. 2006 (not checked)"})
          .only_if(when_inertial, "growth", grows(BandGrowth::inertial)),
      parameter(&Band::growth_per_slip,
                {.key = "growth_per_slip", .range = above(0), .text = "thickness gained over slip, of growth \"slip\""})
          .required_if(when_slip, grows(BandGrowth::slip))
          .only_if(when_slip, "growth", grows(BandGrowth::slip)),
      parameter(&Band::mixing_slip,
                {.key = "mixing_slip",
                 .unit = "m",
                 .range = {.low = 0, .low_open = true, .infinity_allowed = true},
                 .text = "slip over which shear mixes the heat and water of a band column to 1/e of "
                         "their differences; inf: it does not mix"})
          .only_if(when_columns, "model", has_columns),
      parameter(&Band::load_time, {.key = "load_time",
                                   .unit = "s",
                                   .range = above(0),
                                   .text = "time over which columns average the normal pressure N, which switches on "
                                           "and off at nodes"})
          .only_if(when_columns, "model", has_columns)
          .usually({0.1, 10}, has_columns),
      parameter(&Band::column_step,
                {.key = "column_step", .unit = "s", .range = above(0), .text = "largest time step of columns"})
          .only_if(when_columns, "model", has_columns)
          .usually({0.001, 0.5}, has_columns),
      parameter(&Band::ground_temperature, {.key = "ground_temperature",
                                            .unit = "C",
                                            .range = {.low = -100, .high = 100},
                                            .text = "temperature of the ground below columns at the start"})
          .otherwise("that of the body's base")
          .only_if(when_columns, "model", has_columns),
  };
}

std::vector<Parameter<Heat>> heat_parameters() {
  return {
      parameter(&Heat::enabled, {.key = "enabled",
                                 .text = "temperature and phase change (Eq. 9); false: temperatures stay as at t = 0",
                                 .source = "Eqs. 9, 18-20"}),
      parameter(&Heat::update, {.key = "update", .text = "how temperatures follow from heat", .source = "Eqs. 18, 19"}),
      parameter(&Heat::masses,
                {.key = "masses", .text = "the rock, ice and water that hold heat", .source = "Eqs. 6, 9"}),
      parameter(
          &Heat::latent,
          {.key = "latent",
           .text = "melting takes and freezing gives latent heat; false: ice melts all the same, at no cost of heat",
           .source = "Eq. 9"}),
      parameter(&Heat::steam,
                {.key = "steam",
                 .text = "water of band columns boils where its steam lifts the slide, and leaves; false: "
                         "it stays liquid"}),
      parameter(&Heat::conduction, {.key = "conduction",
                                    .text = "heat is conducted, q_T = -k grad T; false: it stays where it is made",
                                    .source = "Eq. 18"}),
      parameter(&Heat::advection,
                {.key = "advection",
                 .text = "seeping water carries heat; needs pressure.enabled and a hydraulic conductivity. In band "
                         "columns it always does",
                 .source = "Eq. 9"}),
      parameter(&Heat::advection_form,
                {.key = "advection_form", .text = "form of the heat that seeping water carries", .source = "Eq. 9"}),
  };
}

std::vector<Parameter<Pressure>> pressure_parameters() {
  return {
      parameter(
          &Pressure::enabled,
          {.key = "enabled",
           .text = "pore pressure P (Eq. 21): Clapeyron with ice (Eq. 4), heating and seepage once melted (Eq. 23); "
                   "false: P = 0 everywhere, ice pressure included",
           .source = "Eqs. 4, 8, 21-23"}),
      parameter(
          &Pressure::thermal_pressurization,
          {.key = "thermal_pressurization",
           .text = "heating melted pore water raises its pressure; false: it keeps P_I/r, r = rho_I/rho_L, and does "
                   "not seep",
           .source = "Eq. 23"}),
      parameter(&Pressure::clapeyron,
                {.key = "clapeyron", .text = "sign before the logarithm of the Clapeyron equation", .source = "Eq. 4"}),
      parameter(&Pressure::volumetric_term,
                {.key = "volumetric_term",
                 .text = "compressing the body presses on melted pore water too: -div v in Eq. 8, which Eq. 23 drops",
                 .source = "Eq. 8"}),
      parameter(&Pressure::frozen, {.key = "frozen", .text = "pore pressure of frozen and partly frozen material"}),
      parameter(
          &Pressure::residual_stress,
          {.key = "residual_stress",
           .unit = "Pa",
           .range = {.low = 0, .infinity_allowed = true},
           .text = "effective stress s0 that thawing leaves of the load N, with frozen = \"none\": the water then "
                   "starts at N - s0; inf: at no excess pressure"}),
      parameter(&Pressure::melt_contraction,
                {.key = "melt_contraction",
                 .text = "melt fills r = rho_I/rho_L of the pore that its ice filled: water has to fill the void "
                         "n (1 - r) by expansion or inflow before its pressure rises; false: as if it were full"}),
      parameter(&Pressure::skeleton_compressibility,
                {.key = "skeleton_compressibility",
                 .unit = "1/Pa",
                 .range = at_least(0),
                 .text = "volume by which the skeleton compresses per volume and effective stress, m_v: pores store "
                         "n/K_L + m_v per pressure, and P follows the load above; 0: rigid pore"})
          .usually({1e-9, 1e-7}, [](const Case& whole, const Pressure&) { return has_band_columns(whole); }),
      parameter(
          &Pressure::seepage,
          {.key = "seepage", .text = "Darcy flow of melted pore water (Eq. 22); false: undrained", .source = "Eq. 22"}),
      parameter(&Pressure::frozen_rows,
                {.key = "frozen_rows",
                 .text = "behaviour of frozen material towards water that seeps to it; the lost water is counted"}),
      parameter(
          &Pressure::column_top,
          {.key = "column_top", .text = "what water meets at the top of a band column that has thawed throughout"}),
      parameter(&Pressure::water_to_steam_viscosity,
                {.key = "water_to_steam_viscosity",
                 .range = at_least(0),
                 .text = "viscosity of water over that of steam, by which steam of band columns seeps into vented "
                         "material; 0: it does not seep"}),
      parameter(&Pressure::seepage_scaling,
                {.key = "seepage_scaling", .text = "how seepage is scaled in the band", .source = "Eq. 23"}),
      parameter(&Pressure::thickness_direction,
                {.key = "thickness_direction",
                 .text = "how the slide's thickness H in the ice pressure P_I = rho_I g H is measured"}),
      parameter(&Pressure::thickness_update,
                {.key = "thickness_update", .text = "whether the thickness H of the ice pressure follows the slide"}),
  };
}

std::vector<Parameter<Block>> block_parameters() {
  return {
      parameter(
          &Block::bends,
          {.key = "bends",
           .text = "where the ground bends, the slide presses on it by v^2 kappa more, or less; false: its weight "
                   "alone does"}),
  };
}

}  // namespace

void declare_model(Tables& tables) {
  tables.push_back(std::make_unique<SingleTable<Mechanics>>("mechanics", "Momentum and stress", &Case::mechanics,
                                                            mechanics_parameters()));
  declare_basal(tables);
  declare_bed(tables);
  declare_contact(tables);
  tables.push_back(std::make_unique<SingleTable<Mechanisms>>("mechanisms", "The mechanisms of Sec. 3.3, on or off",
                                                             &Case::mechanisms, mechanism_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Band>>("band", "The shear band along the ground", &Case::band, band_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Heat>>("heat", "Heat and phase change", &Case::heat, heat_parameters()));
  tables.push_back(std::make_unique<SingleTable<Heat>>("heat.boundary",
                                                       "Temperature or heat flux at the sides of the grid", &Case::heat,
                                                       six_sides(&Heat::boundary, "heat condition")));
  tables.push_back(
      std::make_unique<SingleTable<Pressure>>("pressure", "Pore pressure", &Case::pressure, pressure_parameters()));
  tables.push_back(std::make_unique<SingleTable<Block>>("block", "The rigid-block model of `thawslide block`",
                                                        &Case::block, block_parameters()));
}

}  // namespace thawslide::config
