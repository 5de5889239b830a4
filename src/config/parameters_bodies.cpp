// Parameters of [phases], [freezing], [material.NAME], [body.NAME], [frame.NAME], [initial].
#include <limits>

#include "config/table_declaration.hpp"
#include "physics/mixture.hpp"

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

void declare_material(Tables& tables) {
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
           .required_if({"when cohesion or friction softens and softening_strain is not given", "softening_strain",
                         [](const Case&, const Material& material) {
                           return softens(material) && !(material.softening_strain > 0.0);
                         }}),
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

void declare_body(Tables& tables) {
  const auto box = if_is(&Body::shape, BodyShape::box, "the shape", "shape");
  const auto polygon = if_is(&Body::shape, BodyShape::polygon, "the shape", "shape");
  const auto release = if_is(&Body::shape, BodyShape::release, "the shape", "shape");
  const Condition<Body> no_release{"when the shape is not \"release\"", "shape",
                                   [](const Case&, const Body& body) { return body.shape != BodyShape::release; }};
  const Condition<Body> polygons{
      "when the shape is \"release\" and release is given", "release",
      [](const Case&, const Body& body) { return body.shape == BodyShape::release && !body.release.empty(); }};
  declare(
      tables, "body", "A body of particles with a name of your choice", &Case::bodies,
      {parameter(&Body::material, "material", "name of the body's material").required(),
       parameter(&Body::shape, "shape", "geometry of the body"),
       parameter(&Body::min, "min", "m", {}, "minimum coordinates of the box").required_if(box).only_if(no_release),
       parameter(&Body::max, "max", "m", {}, "maximum coordinates of the box").required_if(box).only_if(no_release),
       parameter(&Body::vertices, "vertices", "m", {}, "vertices of the polygon, in order", {.dimension = 2})
           .required_if(polygon),
       parameter(&Body::release, "release", "file of the release polygons: Shapefile, GeoPackage or GeoJSON",
                 {.is_path = true})
           .required_if({"when the shape is \"release\" and thickness is a number or an attribute", "thickness",
                         [](const Case&, const Body& body) {
                           const bool by_polygons = body.thickness.from == MapValue::From::number ||
                                                    body.thickness.from == MapValue::From::attribute;
                           return body.shape == BodyShape::release && by_polygons;
                         }})
           .only_if(release),
       parameter(&Body::polygons, "polygons", "names of the polygons that form the body; []: all polygons of the file")
           .only_if(polygons),
       parameter(&Body::name_attribute, "name_attribute", "attribute that contains the names of the polygons")
           .only_if(polygons),
       parameter(&Body::thickness, "thickness", "m", above(0),
                 "release thickness: a number, an attribute of the polygons, a raster of thickness, or a raster of the "
                 "surface before the event, from which the DEM is subtracted")
           .required_if(release)
           .only_if(release),
       parameter(&Body::thickness_along, "thickness_along", "direction of the thickness").only_if(release),
       parameter(&Body::placement, "placement", "position of the body relative to the DEM").only_if(release),
       parameter(&Body::taper, "taper", "m", at_least(0),
                 "width of the edge zone in which the thickness decreases to 0")
           .only_if(release),
       parameter(&Body::surface_tolerance, "surface_tolerance", "m", at_least(0),
                 "vertical noise of surface and DEM: thinner material counts as zero, and within polygons the surface "
                 "may be this far below the DEM")
           .only_if({"when the shape is \"release\" and thickness is a surface", "thickness",
                     [](const Case&, const Body& body) {
                       return body.shape == BodyShape::release && body.thickness.from == MapValue::From::surface;
                     }}),
       parameter(&Body::largest_volume, "largest_volume", "m3", above(0),
                 "maximum volume of the body; a larger release must be confirmed by a larger value")
           .only_if(release),
       parameter(&Body::particles_per_axis, "particles_per_axis", "", between(1, 16),
                 "number of particles per cell along each axis; 2 gives 4 per cell in 2D, 8 in 3D"),
       parameter(&Body::temperature, "temperature", "C", {.low = -273.15, .high = 100, .low_open = true},
                 "temperature at t = 0; depth is vertical, below the surface of the body [m]")
           .only_if({"when saturation is not given", "saturation",
                     [](const Case&, const Body& body) { return !body.saturation.is_given(); }}),
       parameter(&Body::saturation, "saturation", "", between(0, 1),
                 "liquid saturation at t = 0, instead of temperature: fraction of the pores that is filled with water",
                 {.source = "Lei et al., Eq. 24"})
           .otherwise("from temperature by the freezing curve"),
       parameter(&Body::porosity, "porosity", "", {.low = 0, .high = physics::largest_porosity, .low_open = true},
                 "porosity n at t = 0: volume fraction of ice and water", {.source = "Lei et al., Eq. 1, Table 2"})
           .only_if({"when ice_content is not given", "ice_content",
                     [](const Case&, const Body& body) { return !body.ice_content.is_given(); }}),
       parameter(&Body::ice_content, "ice_content", "", {.low = 0, .high = physics::largest_porosity, .low_open = true},
                 "volume fraction of ice at t = 0, instead of porosity, which is then ice_content / (1 - saturation)",
                 {.source = "Lei et al., Eq. 1"})
           .otherwise("from porosity and saturation"),
       parameter(&Body::velocity, "velocity", "m/s", {}, "velocity at t = 0"),
       parameter(&Body::release_time, "release_time", "s", at_least(0),
                 "time until which the body is held in place, as a wall without tension for other bodies; an attribute "
                 "has one value for all polygons of the body")});
}

}  // namespace

void declare_bodies(Tables& tables) {
  declare_phases(tables);
  declare_material(tables);
  declare_body(tables);
  declare(tables, "frame", "A rigid box with a name of your choice, in which one velocity component is prescribed",
          &Case::frames,
          {parameter(&Frame::min, "min", "m", {}, "minimum coordinates of the box at t = 0").required(),
           parameter(&Frame::max, "max", "m", {}, "maximum coordinates of the box at t = 0").required(),
           parameter(&Frame::axis, "axis", "velocity component that is prescribed inside the box",
                     {.keywords = {{"x", "along x"}, {"y", "along y, up in 2D"}, {"z", "along z, up in 3D"}}})
               .required(),
           parameter(&Frame::velocity, "velocity", "m/s", {}, "prescribed velocity component; the box moves with it",
                     {.source = "Lei et al., Sec. 3.2"})
               .required()});
  declare(tables, "initial", "Initial positions of particles", &Case::initial,
          {parameter(&Initial::noise, "noise", "", {.low = 0, .high = 0.5, .high_open = true},
                     "maximum random displacement of particles along each axis, as a fraction of the particle spacing; "
                     "particles that would leave their body are not displaced; 0: none"),
           parameter(&Initial::seed, "seed", "", between(0, static_cast<double>(std::numeric_limits<int>::max())),
                     "seed of the random displacements")
               .only_if({"when initial.noise is above 0", "noise",
                         [](const Case&, const Initial& initial) { return initial.noise > 0.0; }})});
}

}  // namespace thawslide::config
