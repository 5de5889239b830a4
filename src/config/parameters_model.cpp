// Parameters of the model: [mechanics], [mechanisms], [band], [heat], [pressure], [block].
#include "config/table_declaration.hpp"

namespace thawslide::config {

namespace {

void declare_mechanics(Tables& tables) {
  const auto settling =
      if_is(&Mechanics::initial_stress, InitialStress::settle, "mechanics.initial_stress", "initial_stress");
  const auto blend = if_is(&Mechanics::transfer, Transfer::blend, "mechanics.transfer", "transfer");
  const auto fmpm = if_is(&Mechanics::transfer, Transfer::fmpm, "mechanics.transfer", "transfer");
  const auto splitting = if_is(&Mechanics::split_stretched, true, "mechanics.split_stretched", "split_stretched");
  declare(
      tables, "mechanics", "Momentum and stress", &Case::mechanics,
      {parameter(&Mechanics::enabled, "enabled",
                 "true: motion and stress are computed (Eqs. 10-16); false: nothing moves",
                 {.source = "Lei et al., Sec. 3.1"}),
       parameter(&Mechanics::shape_function, "shape_function",
                 "shape functions for momentum between particles and grid"),
       parameter(&Mechanics::transfer, "transfer", "transfer of velocities from the grid to the particles",
                 {.source = "Lei et al., Eq. 13"}),
       parameter(&Mechanics::pic_fraction, "pic_fraction", "", between(0, 1),
                 "fraction of PIC in the particle velocities; 0: FLIP, 1: PIC")
           .required_if(blend)
           .only_if(blend),
       parameter(&Mechanics::fmpm_order, "fmpm_order", "", between(2, 4),
                 "order m of the filter FMPM; a higher order damps long waves less",
                 {.source = "Hammerquist and Nairn (2017)"})
           .only_if(fmpm),
       parameter(&Mechanics::fmpm_interval, "fmpm_interval", "s", above(0),
                 "simulated time between applications of the filter FMPM")
           .required_if(fmpm)
           .only_if(fmpm),
       parameter(&Mechanics::initial_stress, "initial_stress", "stress at t = 0; none is published"),
       parameter(&Mechanics::k0, "k0", "", at_least(0),
                 "coefficient K0 of the geostatic stress: stress along the terrain divided by stress normal to it")
           .otherwise("nu / (1 - nu) of each material"),
       parameter(&Mechanics::slope_shear, "slope_shear",
                 "true: the geostatic stress includes the shear stress of an infinite slope"),
       parameter(&Mechanics::effective_stress, "effective_stress",
                 "true: the effective stress sigma + P I determines deformation and strength inside the body; false: P "
                 "acts at the base only",
                 {.source = "Lei et al., Eq. 10"}),
       parameter(&Mechanics::settle_time, "settle_time", "s", above(0), "duration of settling before t = 0")
           .required_if(settling),
       parameter(&Mechanics::settle_damping, "settle_damping", "1/s", above(0),
                 "damping rate of velocities during settling")
           .required_if(settling),
       parameter(&Mechanics::mass_damping, "mass_damping", "1/s", at_least(0),
                 "damping rate of velocities during the run; 0: no damping"),
       parameter(&Mechanics::split_stretched, "split_stretched",
                 "true: particles stretched along the ground to more than 1.5 cells are split in two"),
       parameter(&Mechanics::split_limit, "split_limit", "", above(1),
                 "maximum number of particles after splitting, relative to the number at t = 0")
           .only_if(splitting)});
}

void declare_band(Tables& tables) {
  const auto grows = [](const char* keyword, BandGrowth growth) {
    return Condition<Band>{
        fmt::format("when band.model is \"columns\" and band.growth is \"{}\"", keyword), "growth",
        [growth](const Case&, const Band& band) { return band.model == BandKind::columns && band.growth == growth; }};
  };
  const auto scaled = if_is(&Band::model, BandKind::scaled, "band.model", "model");
  const auto columns = if_is(&Band::model, BandKind::columns, "band.model", "model");
  const Condition<Band> inertial = grows("inertial", BandGrowth::inertial), by_slip = grows("slip", BandGrowth::slip);
  declare(
      tables, "band", "Shear band at the base", &Case::band,
      {parameter(&Band::model, "model", "model of heat and pore pressure at the base")
           .otherwise("\"columns\" if there is a terrain, band.thickness is given, and mechanics and heat are enabled; "
                      "\"scaled\" otherwise",
                      [](const Case& read, Band& band) {
                        const bool has_base = read.terrain.kind != TerrainKind::none && band.thickness.is_given() &&
                                              read.mechanics.enabled && read.heat.enabled;
                        band.model = has_base ? BandKind::columns : BandKind::scaled;
                      }),
       parameter(&Band::thickness, "thickness", "m", above(0),
                 "thickness e of the shear band, constant or over time; with band.model \"scaled\", heat and seepage "
                 "are scaled by xi = grid.cell / e",
                 {.source = "Lei et al., Eq. 19, Sec. 2.3"})
           .otherwise("no band: xi = 1")
           .usually({0.01, 2}, columns.holds),
       parameter(&Band::region, "region", "particles to which the scaling xi of band.model \"scaled\" applies",
                 {.source = "Lei et al., Sec. 2.3"})
           .only_if(scaled),
       parameter(&Band::thickness_change, "thickness_change",
                 "treatment of heat when the thickness e changes over time or, with the slope, along the terrain, and "
                 "when particles leave the first layer"),
       parameter(&Band::growth, "growth", "growth of the band thickness with band.model \"columns\"").only_if(columns),
       parameter(&Band::grain_size, "grain_size", "m", above(0), "grain size d for band.growth \"inertial\"",
                 {.source = "Jop et al. (2006), as quoted by others"})
           .only_if(inertial),
       parameter(&Band::inertial_number, "inertial_number", "", above(0),
                 "maximum inertial number I of the band for band.growth \"inertial\"",
                 {.source = "Jop et al. (2006), as quoted by others"})
           .only_if(inertial),
       parameter(&Band::growth_per_slip, "growth_per_slip", "", above(0),
                 "increase of thickness per slip [m/m] for band.growth \"slip\"")
           .required_if(by_slip)
           .only_if(by_slip),
       parameter(&Band::mixing_slip, "mixing_slip", "m", {.low = 0, .low_open = true, .infinity_allowed = true},
                 "slip over which mixing by shear reduces differences of heat and water within a band column to 1/e; "
                 "inf: no mixing")
           .only_if(columns),
       parameter(&Band::load_time, "load_time", "s", above(0),
                 "averaging time of the normal pressure N on band columns, which is intermittent at nodes")
           .only_if(columns)
           .usually({0.1, 10}, columns.holds),
       parameter(&Band::column_step, "column_step", "s", above(0), "maximum time step of band columns")
           .only_if(columns)
           .usually({0.001, 0.5}, columns.holds),
       parameter(&Band::ground_temperature, "ground_temperature", "C", {.low = -100, .high = 100},
                 "temperature of the terrain below band columns at t = 0")
           .otherwise("temperature of the body at its base")
           .only_if(columns)});
}

void declare_heat(Tables& tables) {
  declare(
      tables, "heat", "Heat and phase change", &Case::heat,
      {parameter(&Heat::enabled, "enabled",
                 "true: temperature and phase change are computed (Eq. 9); false: temperatures remain as at t = 0",
                 {.source = "Lei et al., Eqs. 9, 18-20"}),
       parameter(&Heat::update, "update", "update of temperatures by heat", {.source = "Lei et al., Eqs. 18, 19"}),
       parameter(&Heat::latent, "latent",
                 "true: melting absorbs and freezing releases latent heat; false: ice melts without latent heat",
                 {.source = "Lei et al., Eq. 9"}),
       parameter(&Heat::steam, "steam",
                 "true: water of band columns boils when the steam pressure would exceed N, and the steam escapes; "
                 "false: it remains liquid"),
       parameter(&Heat::conduction, "conduction",
                 "true: heat conduction, q_T = -k grad T; false: heat remains where it is generated",
                 {.source = "Lei et al., Eq. 18"}),
       parameter(&Heat::advection, "advection",
                 "true: seeping water carries heat, which requires pressure.enabled and a hydraulic conductivity; band "
                 "columns always include this",
                 {.source = "Lei et al., Eq. 9"}),
       parameter(&Heat::advection_form, "advection_form", "form of the heat that seeping water carries",
                 {.source = "Lei et al., Eq. 9"})});
  declare(tables, "heat.boundary", "Thermal boundary conditions on the sides of the grid", &Case::heat,
          six_sides(&Heat::boundary, "thermal boundary condition"));
}

void declare_pressure(Tables& tables) {
  declare(
      tables, "pressure", "Pore pressure", &Case::pressure,
      {parameter(&Pressure::enabled, "enabled",
                 "true: pore pressure P (Eq. 21): Clapeyron equation with ice (Eq. 4), heating and seepage after "
                 "melting (Eq. 23); false: P = 0, ice pressure included",
                 {.source = "Lei et al., Eqs. 4, 8, 21-23"}),
       parameter(
           &Pressure::thermal_pressurization, "thermal_pressurization",
           "true: heating raises the pressure of melted pore water; false: the pressure remains at P_I/r with r = "
           "rho_I/rho_L, and water does not seep",
           {.source = "Lei et al., Eq. 23"}),
       parameter(&Pressure::volumetric_term, "volumetric_term",
                 "true: compression of the body also raises the pressure of melted pore water: -div v in Eq. 8, which "
                 "Eq. 23 omits",
                 {.source = "Lei et al., Eq. 8"}),
       parameter(&Pressure::frozen, "frozen", "pore pressure of frozen and partly frozen material"),
       parameter(&Pressure::residual_stress, "residual_stress", "Pa", {.low = 0, .infinity_allowed = true},
                 "effective stress s0 that remains of the load N after thawing, with frozen = \"none\": pore pressure "
                 "then starts at N - s0; inf: no excess pressure"),
       parameter(&Pressure::melt_contraction, "melt_contraction",
                 "true: melt leaves a void n (1 - r), r = rho_I/rho_L, which expansion or inflow fills before the "
                 "pressure rises; false: no void"),
       parameter(&Pressure::skeleton_compressibility, "skeleton_compressibility", "1/Pa", at_least(0),
                 "compressibility m_v of the skeleton, volumetric strain per effective stress: pores store n/K_L + m_v "
                 "per pressure, and P follows changes of the load; 0: rigid pores")
           .usually({1e-9, 1e-7}, [](const Case& whole, const Pressure&) { return has_band_columns(whole); }),
       parameter(&Pressure::seepage, "seepage", "true: Darcy flow of melted pore water (Eq. 22); false: undrained",
                 {.source = "Lei et al., Eq. 22"}),
       parameter(&Pressure::frozen_rows, "frozen_rows",
                 "boundary condition of frozen material for water that seeps to it; the lost water is counted"),
       parameter(&Pressure::column_top, "column_top",
                 "boundary condition for water at the top of a band column that has thawed completely"),
       parameter(&Pressure::water_to_steam_viscosity, "water_to_steam_viscosity", "", at_least(0),
                 "ratio of the viscosities of water and steam, for seepage of steam from band columns into vented "
                 "material; 0: steam does not seep"),
       parameter(&Pressure::thickness_direction, "thickness_direction",
                 "direction of the thickness H in the ice pressure P_I = rho_I g H"),
       parameter(&Pressure::thickness_update, "thickness_update", "update of the thickness H in the ice pressure")});
}

}  // namespace

void declare_model(Tables& tables) {
  declare_mechanics(tables);
  declare_basal(tables);
  declare(
      tables, "mechanisms", "Mechanisms of Lei et al., Sec. 3.3, on or off", &Case::mechanisms,
      {parameter(&Mechanisms::deformation, "deformation",
                 "mechanism D: the body yields internally (Eq. 11); false: the body is elastic",
                 {.source = "Lei et al., Eq. 11, Sec. 3.3"}),
       parameter(
           &Mechanisms::lubrication, "lubrication",
           "mechanism L: friction depends on melting and porosity (Eq. 25); false: Eq. 25 uses their values at t = 0",
           {.source = "Lei et al., Eqs. 17, 25, Sec. 3.3"}),
       parameter(&Mechanisms::pressurization, "pressurization",
                 "mechanism P: pore pressure reduces friction (Eq. 17); false: P = 0 in Eq. 17, ice pressure included",
                 {.source = "Lei et al., Eqs. 17, 21, Sec. 3.3"})});
  declare_band(tables);
  declare_heat(tables);
  declare_pressure(tables);
  declare(tables, "block", "Rigid-block model of `thawslide block`", &Case::block,
          {parameter(&Block::bends, "bends",
                     "true: the centrifugal term v^2 kappa in bends of the terrain changes the normal load; false: the "
                     "normal load is that of the weight alone")});
}

}  // namespace thawslide::config
