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
      parameter(&Mechanics::enabled, {.key = "enabled",
                                      .text = "true: motion and stress are computed (Eqs. 10-16); false: nothing moves",
                                      .source = "Lei et al., Sec. 3.1"}),
      parameter(&Mechanics::shape_function,
                {.key = "shape_function", .text = "shape functions for momentum between particles and grid"}),
      parameter(&Mechanics::transfer, {.key = "transfer",
                                       .text = "transfer of velocities from the grid to the particles",
                                       .source = "Lei et al., Eq. 13"}),
      parameter(&Mechanics::pic_fraction, {.key = "pic_fraction",
                                           .range = between(0, 1),
                                           .text = "fraction of PIC in the particle velocities; 0: FLIP, 1: PIC",
                                           .formerly = "pic_share"})
          .required_if("when mechanics.transfer is \"blend\"",
                       [](const Case&, const Mechanics& mechanics) { return mechanics.transfer == Transfer::blend; }),
      parameter(&Mechanics::fmpm_order, {.key = "fmpm_order",
                                         .range = between(2, 4),
                                         .text = "order m of the filter FMPM; a higher order damps long waves less",
                                         .source = "Hammerquist and Nairn (2017)"}),
      parameter(&Mechanics::fmpm_interval, {.key = "fmpm_interval",
                                            .unit = "s",
                                            .range = above(0),
                                            .text = "simulated time between applications of the filter FMPM"})
          .required_if("when mechanics.transfer is \"fmpm\"",
                       [](const Case&, const Mechanics& mechanics) { return mechanics.transfer == Transfer::fmpm; }),
      parameter(&Mechanics::initial_stress, {.key = "initial_stress", .text = "stress at t = 0; none is published"}),
      parameter(
          &Mechanics::k0,
          {.key = "k0",
           .range = at_least(0),
           .text = "coefficient K0 of the geostatic stress: stress along the terrain divided by stress normal to it"})
          .otherwise("nu / (1 - nu) of each material"),
      parameter(
          &Mechanics::slope_shear,
          {.key = "slope_shear", .text = "true: the geostatic stress includes the shear stress of an infinite slope"}),
      parameter(&Mechanics::effective_stress, {.key = "effective_stress",
                                               .text = "true: the effective stress sigma + P I determines deformation "
                                                       "and strength inside the body; false: P acts at the base only",
                                               .source = "Lei et al., Eq. 10"}),
      parameter(&Mechanics::settle_time,
                {.key = "settle_time", .unit = "s", .range = above(0), .text = "duration of settling before t = 0"})
          .required_if(when_settling, settles),
      parameter(&Mechanics::settle_damping, {.key = "settle_damping",
                                             .unit = "1/s",
                                             .range = above(0),
                                             .text = "damping rate of velocities during settling"})
          .required_if(when_settling, settles),
      parameter(&Mechanics::mass_damping, {.key = "mass_damping",
                                           .unit = "1/s",
                                           .range = at_least(0),
                                           .text = "damping rate of velocities during the run; 0: no damping"}),
      parameter(&Mechanics::split_stretched,
                {.key = "split_stretched",
                 .text = "true: particles stretched along the ground to more than 1.5 cells are split in two"}),
      parameter(&Mechanics::split_limit,
                {.key = "split_limit",
                 .range = above(1),
                 .text = "maximum number of particles after splitting, relative to the number at t = 0"})
          .only_if("when mechanics.split_stretched is true", "split_stretched",
                   [](const Case&, const Mechanics& mechanics) { return mechanics.split_stretched; }),
  };
}

std::vector<Parameter<Mechanisms>> mechanism_parameters() {
  return {
      parameter(&Mechanisms::deformation,
                {.key = "deformation",
                 .text = "mechanism D: the body yields internally (Eq. 11); false: the body is elastic",
                 .source = "Lei et al., Eq. 11, Sec. 3.3"}),
      parameter(&Mechanisms::lubrication, {.key = "lubrication",
                                           .text = "mechanism L: friction depends on melting and porosity (Eq. 25); "
                                                   "false: Eq. 25 uses their values at t = 0",
                                           .source = "Lei et al., Eqs. 17, 25, Sec. 3.3"}),
      parameter(
          &Mechanisms::pressurization,
          {.key = "pressurization",
           .text =
               "mechanism P: pore pressure reduces friction (Eq. 17); false: P = 0 in Eq. 17, ice pressure included",
           .source = "Lei et al., Eqs. 17, 21, Sec. 3.3"}),
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
      parameter(&Band::model, {.key = "model", .text = "model of heat and pore pressure at the base"})
          .otherwise("\"columns\" if there is a terrain, band.thickness is given, and mechanics and heat are enabled; "
                     "\"scaled\" otherwise",
                     [](const Case& read, Band& band) {
                       const bool has_base = read.terrain.kind != TerrainKind::none && band.thickness.is_given() &&
                                             read.mechanics.enabled && read.heat.enabled;
                       band.model = has_base ? BandKind::columns : BandKind::scaled;
                     }),
      parameter(&Band::thickness, {.key = "thickness",
                                   .unit = "m",
                                   .range = above(0),
                                   .text = "thickness e of the shear band, constant or over time; with band.model "
                                           "\"scaled\", heat and seepage are scaled by xi = grid.cell / e",
                                   .source = "Lei et al., Eq. 19, Sec. 2.3"})
          .otherwise("no band: xi = 1")
          .usually({0.01, 2}, has_columns),
      parameter(&Band::region, {.key = "region",
                                .text = "particles to which the scaling xi of band.model \"scaled\" applies",
                                .source = "Lei et al., Sec. 2.3"})
          .only_if(when_scaled, "model", is_scaled),
      parameter(&Band::thickness_change,
                {.key = "thickness_change",
                 .text = "treatment of heat when the thickness e changes over time or, with the slope, along the "
                         "terrain, and when particles leave the first layer"}),
      parameter(&Band::growth, {.key = "growth", .text = "growth of the band thickness with band.model \"columns\""})
          .only_if(when_columns, "model", has_columns),
      parameter(&Band::grain_size, {.key = "grain_size",
                                    .unit = "m",
                                    .range = above(0),
                                    .text = "grain size d for band.growth \"inertial\"",
                                    .source = "Jop et al. (2006), as quoted by others"})
          .only_if(when_inertial, "growth", grows(BandGrowth::inertial)),
      parameter(&Band::inertial_number, {.key = "inertial_number",
                                         .range = above(0),
                                         .text = "maximum inertial number I of the band for band.growth \"inertial\"",
                                         .source = "Jop et al. (2006), as quoted by others"})
          .only_if(when_inertial, "growth", grows(BandGrowth::inertial)),
      parameter(&Band::growth_per_slip, {.key = "growth_per_slip",
                                         .range = above(0),
                                         .text = "increase of thickness per slip [m/m] for band.growth \"slip\""})
          .required_if(when_slip, grows(BandGrowth::slip))
          .only_if(when_slip, "growth", grows(BandGrowth::slip)),
      parameter(&Band::mixing_slip, {.key = "mixing_slip",
                                     .unit = "m",
                                     .range = {.low = 0, .low_open = true, .infinity_allowed = true},
                                     .text = "slip over which mixing by shear reduces differences of heat and water "
                                             "within a band column to 1/e; inf: no mixing"})
          .only_if(when_columns, "model", has_columns),
      parameter(&Band::load_time,
                {.key = "load_time",
                 .unit = "s",
                 .range = above(0),
                 .text = "averaging time of the normal pressure N on band columns, which is intermittent at nodes"})
          .only_if(when_columns, "model", has_columns)
          .usually({0.1, 10}, has_columns),
      parameter(&Band::column_step,
                {.key = "column_step", .unit = "s", .range = above(0), .text = "maximum time step of band columns"})
          .only_if(when_columns, "model", has_columns)
          .usually({0.001, 0.5}, has_columns),
      parameter(&Band::ground_temperature, {.key = "ground_temperature",
                                            .unit = "C",
                                            .range = {.low = -100, .high = 100},
                                            .text = "temperature of the terrain below band columns at t = 0"})
          .otherwise("temperature of the body at its base")
          .only_if(when_columns, "model", has_columns),
  };
}

std::vector<Parameter<Heat>> heat_parameters() {
  return {
      parameter(
          &Heat::enabled,
          {.key = "enabled",
           .text = "true: temperature and phase change are computed (Eq. 9); false: temperatures remain as at t = 0",
           .source = "Lei et al., Eqs. 9, 18-20"}),
      parameter(&Heat::update,
                {.key = "update", .text = "update of temperatures by heat", .source = "Lei et al., Eqs. 18, 19"}),
      parameter(&Heat::masses, {.key = "masses",
                                .text = "masses of rock, ice and water that store heat",
                                .source = "Lei et al., Eqs. 6, 9"}),
      parameter(
          &Heat::latent,
          {.key = "latent",
           .text = "true: melting absorbs and freezing releases latent heat; false: ice melts without latent heat",
           .source = "Lei et al., Eq. 9"}),
      parameter(&Heat::steam, {.key = "steam",
                               .text = "true: water of band columns boils when the steam pressure would exceed N, and "
                                       "the steam escapes; false: it remains liquid"}),
      parameter(&Heat::conduction,
                {.key = "conduction",
                 .text = "true: heat conduction, q_T = -k grad T; false: heat remains where it is generated",
                 .source = "Lei et al., Eq. 18"}),
      parameter(&Heat::advection, {.key = "advection",
                                   .text = "true: seeping water carries heat, which requires pressure.enabled and a "
                                           "hydraulic conductivity; band columns always include this",
                                   .source = "Lei et al., Eq. 9"}),
      parameter(&Heat::advection_form, {.key = "advection_form",
                                        .text = "form of the heat that seeping water carries",
                                        .source = "Lei et al., Eq. 9"}),
  };
}

std::vector<Parameter<Pressure>> pressure_parameters() {
  return {
      parameter(&Pressure::enabled,
                {.key = "enabled",
                 .text = "true: pore pressure P (Eq. 21): Clapeyron equation with ice (Eq. 4), heating and seepage "
                         "after melting (Eq. 23); false: P = 0, ice pressure included",
                 .source = "Lei et al., Eqs. 4, 8, 21-23"}),
      parameter(&Pressure::thermal_pressurization,
                {.key = "thermal_pressurization",
                 .text = "true: heating raises the pressure of melted pore water; false: the pressure remains at P_I/r "
                         "with r = rho_I/rho_L, and water does not seep",
                 .source = "Lei et al., Eq. 23"}),
      parameter(&Pressure::clapeyron, {.key = "clapeyron",
                                       .text = "sign of the logarithm in the Clapeyron equation",
                                       .source = "Lei et al., Eq. 4"}),
      parameter(&Pressure::volumetric_term, {.key = "volumetric_term",
                                             .text = "true: compression of the body also raises the pressure of melted "
                                                     "pore water: -div v in Eq. 8, which Eq. 23 omits",
                                             .source = "Lei et al., Eq. 8"}),
      parameter(&Pressure::frozen, {.key = "frozen", .text = "pore pressure of frozen and partly frozen material"}),
      parameter(&Pressure::residual_stress,
                {.key = "residual_stress",
                 .unit = "Pa",
                 .range = {.low = 0, .infinity_allowed = true},
                 .text = "effective stress s0 that remains of the load N after thawing, with frozen = \"none\": pore "
                         "pressure then starts at N - s0; inf: no excess pressure"}),
      parameter(&Pressure::melt_contraction,
                {.key = "melt_contraction",
                 .text = "true: melt leaves a void n (1 - r), r = rho_I/rho_L, which expansion or inflow fills before "
                         "the pressure rises; false: no void"}),
      parameter(&Pressure::skeleton_compressibility,
                {.key = "skeleton_compressibility",
                 .unit = "1/Pa",
                 .range = at_least(0),
                 .text = "compressibility m_v of the skeleton, volumetric strain per effective stress: pores store "
                         "n/K_L + m_v per pressure, and P follows changes of the load; 0: rigid pores"})
          .usually({1e-9, 1e-7}, [](const Case& whole, const Pressure&) { return has_band_columns(whole); }),
      parameter(&Pressure::seepage, {.key = "seepage",
                                     .text = "true: Darcy flow of melted pore water (Eq. 22); false: undrained",
                                     .source = "Lei et al., Eq. 22"}),
      parameter(
          &Pressure::frozen_rows,
          {.key = "frozen_rows",
           .text = "boundary condition of frozen material for water that seeps to it; the lost water is counted"}),
      parameter(&Pressure::column_top,
                {.key = "column_top",
                 .text = "boundary condition for water at the top of a band column that has thawed completely"}),
      parameter(&Pressure::water_to_steam_viscosity,
                {.key = "water_to_steam_viscosity",
                 .range = at_least(0),
                 .text = "ratio of the viscosities of water and steam, for seepage of steam from band columns into "
                         "vented material; 0: steam does not seep"}),
      parameter(&Pressure::seepage_scaling,
                {.key = "seepage_scaling", .text = "scaling of seepage in the band", .source = "Lei et al., Eq. 23"}),
      parameter(
          &Pressure::thickness_direction,
          {.key = "thickness_direction", .text = "direction of the thickness H in the ice pressure P_I = rho_I g H"}),
      parameter(&Pressure::thickness_update,
                {.key = "thickness_update", .text = "update of the thickness H in the ice pressure"}),
  };
}

std::vector<Parameter<Block>> block_parameters() {
  return {
      parameter(&Block::bends, {.key = "bends",
                                .text = "true: the centrifugal term v^2 kappa in bends of the terrain changes the "
                                        "normal load; false: the normal load is that of the weight alone"}),
  };
}

}  // namespace

void declare_model(Tables& tables) {
  tables.push_back(std::make_unique<SingleTable<Mechanics>>("mechanics", "Momentum and stress", &Case::mechanics,
                                                            mechanics_parameters()));
  declare_basal(tables);
  declare_bed(tables);
  declare_contact(tables);
  tables.push_back(std::make_unique<SingleTable<Mechanisms>>(
      "mechanisms", "Mechanisms of Lei et al., Sec. 3.3, on or off", &Case::mechanisms, mechanism_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Band>>("band", "Shear band at the base", &Case::band, band_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Heat>>("heat", "Heat and phase change", &Case::heat, heat_parameters()));
  tables.push_back(
      std::make_unique<SingleTable<Heat>>("heat.boundary", "Thermal boundary conditions on the sides of the grid",
                                          &Case::heat, six_sides(&Heat::boundary, "thermal boundary condition")));
  tables.push_back(
      std::make_unique<SingleTable<Pressure>>("pressure", "Pore pressure", &Case::pressure, pressure_parameters()));
  tables.push_back(std::make_unique<SingleTable<Block>>("block", "Rigid-block model of `thawslide block`", &Case::block,
                                                        block_parameters()));
}

}  // namespace thawslide::config
