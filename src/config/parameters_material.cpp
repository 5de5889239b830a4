// Parameters of materials: [phases], [freezing], [material.NAME].
#include "config/table_declaration.hpp"

namespace thawslide::config {

namespace {

Parameter<Phases> phase(double Phases::*member, const char* key, const char* unit, const Range& range, const char* text,
                        const char* source = "Lei et al., Table 1") {
  return parameter(member, key, unit, range, text, {.source = source});
}

bool loses_friction(const Material& material) { return material.residual_friction_angle < material.friction_angle; }

bool softens(const Material& material) {
  return material.law == LawKind::mohr_coulomb &&
         (loses_friction(material) || material.residual_cohesion < material.cohesion);
}

// The published softening, of cohesion alone over a plastic strain of 1, is excluded.
bool breaks(const Case&, const Material& material) {
  constexpr double strain_of_the_paper = 1.0;
  return softens(material) && (loses_friction(material) || material.softening_strain != strain_of_the_paper);
}

bool seeps_at_base(const Case& whole, const Material& material) {
  return has_band_columns(whole) && material.hydraulic_conductivity > 0.0;
}

void declare_phases(Tables& tables) {
  const Range positive = above(0);
  const Range not_negative = at_least(0);
  declare(
      tables, "phases", "Properties of rock grains, ice and water", &Case::phases,
      {phase(&Phases::rock_density, "rock_density", "kg/m3", positive, "intrinsic density of the rock grains"),
       phase(&Phases::ice_density, "ice_density", "kg/m3", positive, "intrinsic density of ice"),
       phase(&Phases::water_density, "water_density", "kg/m3", positive, "intrinsic density of water"),
       phase(&Phases::rock_heat_capacity, "rock_heat_capacity", "J/kg/K", positive,
             "specific heat capacity of the rock grains"),
       phase(&Phases::ice_heat_capacity, "ice_heat_capacity", "J/kg/K", positive, "specific heat capacity of ice"),
       phase(&Phases::water_heat_capacity, "water_heat_capacity", "J/kg/K", positive,
             "specific heat capacity of water"),
       phase(&Phases::rock_conductivity, "rock_conductivity", "W/m/K", not_negative,
             "thermal conductivity of the rock grains"),
       phase(&Phases::ice_conductivity, "ice_conductivity", "W/m/K", not_negative, "thermal conductivity of ice"),
       phase(&Phases::water_conductivity, "water_conductivity", "W/m/K", not_negative, "thermal conductivity of water"),
       phase(&Phases::rock_expansion, "rock_expansion", "1/K", not_negative,
             "volumetric thermal expansion beta_S of the rock grains"),
       phase(&Phases::ice_expansion, "ice_expansion", "1/K", not_negative,
             "volumetric thermal expansion beta_I of ice"),
       phase(&Phases::water_expansion, "water_expansion", "1/K", not_negative,
             "volumetric thermal expansion beta_L of water"),
       parameter(&Phases::water_expansion_law, "water_expansion_law",
                 "thermal expansion beta_L of water in the equation of pore pressure"),
       phase(&Phases::water_bulk_modulus, "water_bulk_modulus", "Pa", positive, "bulk modulus K_L of water"),
       phase(&Phases::latent_heat, "latent_heat", "J/kg", not_negative,
             "latent heat of melting L_f; the published unit is J/m3"),
       phase(&Phases::water_unit_weight, "water_unit_weight", "N/m3", positive,
             "unit weight gamma_w of water in Darcy's law", "Lei et al., Eq. 22"),
       phase(
           &Phases::ice_to_rock_density_ratio, "ice_to_rock_density_ratio", "", not_negative,
           "weight of ice in the effective solid fraction n_e; the published value is the density ratio rounded to 1/3",
           "Lei et al., Eq. 2")});
}

}  // namespace

void declare_material(Tables& tables) {
  declare_phases(tables);
  declare(
      tables, "freezing", "Freezing curve: liquid saturation as a function of temperature", &Case::freezing,
      {parameter(&Freezing::curve, "curve", "form of the freezing curve", {.source = "Lei et al., Eq. 24, Sec. 3.1"}),
       parameter(&Freezing::exponent, "exponent", "", above(0),
                 "exponent of the power law; a larger value leaves less water below reference_temperature",
                 {.source = "Lei et al., Eq. 24"}),
       parameter(&Freezing::slope, "slope", "1/K", above(0),
                 "slope m of the linear curve: all pore water is ice from 1/m below reference_temperature",
                 {.source = "Lei et al., Sec. 3.1"}),
       parameter(&Freezing::reference_temperature, "reference_temperature", "C", inside(-273.15, 100),
                 "temperature Tref from which all pore water is liquid", {.source = "Lei et al., Eqs. 4, 24"})});
  const char* const when_broken = "for broken rock and ice";
  const Condition<Material> mechanical{"when mechanics.enabled is true", "",
                                       [](const Case& whole, const Material&) { return whole.mechanics.enabled; }};
  const Condition<Material> plastic{
      "when the law is \"mohr_coulomb\" and mechanics.enabled and mechanisms.deformation are true", "law",
      [](const Case& whole, const Material& material) {
        return whole.mechanics.enabled && material.law == LawKind::mohr_coulomb && whole.mechanisms.deformation;
      }};
  declare(
      tables, "material", "A material with a name of your choice", &Case::materials,
      {parameter(&Material::law, "law", "constitutive law", {.source = "Lei et al., Eqs. 10, 11"}),
       parameter(&Material::youngs_modulus, "youngs_modulus", "Pa", above(0), "Young's modulus",
                 {.source = "Lei et al., Tables 2, 3"})
           .required_if(mechanical),
       parameter(&Material::poisson_ratio, "poisson_ratio", "", inside(-1, 0.5), "Poisson's ratio",
                 {.source = "Lei et al., Tables 2, 3"})
           .required_if(mechanical),
       parameter(&Material::friction_angle, "friction_angle", "degrees", {.low = 0, .high = 90, .high_open = true},
                 "internal friction angle phi", {.source = "Lei et al., Eq. 11"})
           .required_if(plastic),
       parameter(&Material::dilation_angle, "dilation_angle", "degrees", {.low = 0, .high = 90, .high_open = true},
                 "dilation angle, at most friction_angle; no published value"),
       parameter(&Material::cohesion, "cohesion", "Pa", at_least(0), "cohesion c_0 before plastic strain",
                 {.source = "Lei et al., Eq. 11"})
           .required_if(plastic),
       parameter(&Material::residual_cohesion, "residual_cohesion", "Pa", at_least(0),
                 "residual cohesion c_f after large plastic strain eps: c = c_f + (c_0 - c_f) exp(-eps/eps_c)",
                 {.source = "Lei et al., Sec. 4"})
           .otherwise("equal to cohesion: no softening",
                      [](const Case&, Material& material) { material.residual_cohesion = material.cohesion; })
           .usually({0, 50e3, when_broken}, breaks),
       parameter(
           &Material::residual_friction_angle, "residual_friction_angle", "degrees",
           {.low = 0, .high = 90, .high_open = true},
           "residual friction angle phi_f after large plastic strain eps: sin(phi) decreases as the cohesion does")
           .otherwise(
               "equal to friction_angle: no softening of friction",
               [](const Case&, Material& material) { material.residual_friction_angle = material.friction_angle; })
           .usually({20, 35, when_broken}, breaks),
       parameter(&Material::softening_strain, "softening_strain", "", above(0),
                 "plastic strain eps_c over which the softening part of cohesion and friction decreases to 1/e; the "
                 "published value is 1; finer cells then soften at less slip",
                 {.source = "Lei et al., Sec. 4"})
           .otherwise("softening_slip/(sqrt(3) grid.cell)")
           .only_if({"when softening_slip is not given", "softening_slip",
                     [](const Case&, const Material& material) { return !(material.softening_slip > 0.0); }})
           .usually({0.005, 0.05, when_broken},
                    [](const Case& whole, const Material& material) {
                      return breaks(whole, material) && material.softening_strain > 0.0;
                    }),
       parameter(
           &Material::softening_slip, "softening_slip", "m", above(0),
           "slip s_c across a rupture surface over which the softening part of cohesion and friction decreases to "
           "1/e, for any cell size: eps_c = s_c/(sqrt(3) grid.cell)")
           .required_if("when cohesion or friction softens and softening_strain is not given",
                        [](const Case&, const Material& material) {
                          return softens(material) && !(material.softening_strain > 0.0);
                        }),
       parameter(&Material::tension_cutoff, "tension_cutoff", "Pa", {.low = 0, .infinity_allowed = true},
                 "maximum tensile stress in any direction; inf: limited by cohesion and friction angle alone"),
       parameter(&Material::gaps_close_first, "gaps_close_first",
                 "true: material separated by tension carries no compression until its gap has closed; false: at once, "
                 "as in classical plasticity, and a loose mass swells"),
       parameter(&Material::viscosity_number, "viscosity_number", "", at_least(0),
                 "numerical viscosity: viscosity time divided by the time grid.cell sqrt(rho_S/(lambda + 2 G)) of an "
                 "elastic wave across a cell; 0: none")
           .only_if({"when viscosity_time is not given", "viscosity_time",
                     [](const Case&, const Material& material) { return std::isnan(material.viscosity_time); }}),
       parameter(
           &Material::viscosity_time, "viscosity_time", "s", at_least(0),
           "physical Kelvin-Voigt viscosity, for any cell size: viscous stress divided by elastic stress rate; 0: none")
           .otherwise("viscosity_number times the time of a wave across a cell"),
       parameter(&Material::hydraulic_conductivity, "hydraulic_conductivity", "m/s", at_least(0),
                 "hydraulic conductivity k_L; 0: no seepage", {.source = "Lei et al., Eq. 22"})
           .usually({1e-8, 1e-5, "at the base"}, seeps_at_base)});
}

}  // namespace thawslide::config
