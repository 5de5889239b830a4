// Case: all typed and validated inputs of a run, constant after reading. Units are SI, angles in degrees, temperatures
// in degrees Celsius. parameters_*.cpp declare each member once (key, unit, range, default).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/table.hpp"
#include "config/case_sections.hpp"
#include "physics/mixture.hpp"
#include "physics/options.hpp"

namespace thawslide::config {

using Point = std::array<double, 3>;  // x, y in 2D (third 0); x, y, z in 3D

using physics::BandGrowth;
using physics::BandRegion;
using physics::BoundaryKind;
using physics::EndOfWater;
using physics::FrozenRows;
using physics::HeatBoundaryKind;
using physics::ShapeFunction;
using physics::WaterExpansionLaw;

enum class Stepping { fixed, adaptive };
enum class TerrainKind { none, flat, plane, profile, dem };
enum class LawKind { elastic, mohr_coulomb };
enum class CurveKind { power_law, linear };
enum class BodyShape { box, polygon, surface, release };
enum class ThicknessAlong { vertical, normal };
enum class Placement { on_top, cut };
enum class Policy { stop, remove };
enum class Transfer { flip, blend, apic, fmpm };
enum class InitialStress { geostatic, none, settle };
enum class BandKind { scaled, columns };
enum class ThicknessChange { as_published, conserving };
enum class AdvectionForm { as_published, conservative };
enum class FrozenPressure { ice_pressure, none };
enum class HeatUpdate { enthalpy, apparent_capacity };
enum class ThicknessDirection { normal, vertical };
enum class ThicknessUpdate { each_step, frozen };
enum class BodyContact { bonded, frictional };

struct General {
  std::string based_on;  // case file in the same folder; empty: none
  std::string title;
  int dimension = 2;
  WidthOverX width;  // m; 0: extensive results are per metre of width (2D)
  double gravity = 9.81;
  double gravity_tilt = 0.0;  // degrees, rotated from -up towards +x
};

struct Time {
  double end = 0.0;
  Stepping stepping = Stepping::fixed;
  double step = 0.0;              // s; fixed step, or maximum adaptive step
  double safety = 0.8;            // factor on the limits, adaptive
  double output_interval = 1.0;   // s between snapshots
  double history_interval = 0.0;  // s between history rows; 0: every step
  double stop_at_rest = -1.0;     // m/s, maximum speed at rest; 0 or not specified: the run continues to time.end
  double rest_time = 10.0;        // s, minimum duration of rest
  double moved_distance = 1.0;    // m, beyond which mass counts for front, runout and travel distance
};

struct Grid {
  double cell = 0.0;
  Point min{};  // domain
  Point max{};
  Policy leaving = Policy::stop;  // treatment of particles that leave the domain or the DEM
  double steepest = 65.0;         // degrees, slope to which columns of nodes are lowered
  // boundary types at x_min, x_max, y_min, y_max, z_min, z_max
  std::array<BoundaryKind, 6> boundary{};
};

// Limits beyond which a failing run is aborted, or particles are removed from it.
struct Guards {
  Policy not_finite = Policy::stop, volume = Policy::stop;
  double smallest_volume = 0.25;                                    // relative to t = 0
  double largest_volume = std::numeric_limits<double>::infinity();  // relative to t = 0
  double removed_mass = 0.01;                                       // fraction of the total mass
  double energy_growth = 0.25;                                      // fraction of the total energy so far
  double smallest_step = 0.001;                                     // fraction of the first one
  double most_steps = 1e9;                                          // to the end
};

// Number, or the keyword "auto" for automatic choice.
struct NumberOrAuto {
  bool is_auto = false;
  double number = 0.0;
};

struct Terrain {
  TerrainKind kind = TerrainKind::none;
  double elevation = 0.0;  // m: of the flat ground, or of the plane at x = 0
  double slope = 0.0;      // degrees, the plane falls towards +x
  std::string file;        // of the profile or DEM; absolute once read
  bool extend = false;
  std::string crs;                          // of a DEM file without one, or with a wrong one; "EPSG:31287"
  double resample = 0.0;                    // m, new spacing of the DEM; 0: as in the file
  NumberOrAuto smooth = {.is_auto = true};  // m, standard deviation of a Gaussian filter over the DEM; 0: none
};

struct Phases : physics::Phases {
  WaterExpansionLaw water_expansion_law = WaterExpansionLaw::by_temperature;

  Phases()
      : physics::Phases{.rock_density = 2750,
                        .ice_density = 917,
                        .water_density = 1000,
                        .rock_heat_capacity = 858,
                        .ice_heat_capacity = 2040,
                        .water_heat_capacity = 4180,
                        .rock_conductivity = 3.0,
                        .ice_conductivity = 2.22,
                        .water_conductivity = 0.58,
                        .rock_expansion = 3e-5,
                        .ice_expansion = 5.1e-5,
                        .water_expansion = 2.75e-4,
                        .water_bulk_modulus = 1e9,
                        .latent_heat = 333.5e3,
                        .water_unit_weight = 9810,
                        .ice_to_rock_density_ratio = 1.0 / 3.0} {}  // as rounded in the paper
};

struct Freezing {
  CurveKind curve = CurveKind::power_law;
  double exponent = 5.0;  // power law, Eq. 24
  double slope = 0.5;     // 1/K, linear curve m of Sec. 3.1
  double reference_temperature = 0.0;
};

struct Material {
  LawKind law = LawKind::mohr_coulomb;
  double youngs_modulus = 0, poisson_ratio = 0;
  double friction_angle = 0, residual_friction_angle = 0, dilation_angle = 0;
  double cohesion = 0, residual_cohesion = 0;       // softening: c_f + (c_0 - c_f) exp(-eps/eps_c); equal: none
  double softening_strain = 0, softening_slip = 0;  // eps_c, s_c [m]: softening uses the one that is not 0
  double tension_cutoff = std::numeric_limits<double>::infinity();  // Pa; infinity: none
  bool gaps_close_first = true;    // separated material carries no stress until its gap has closed
  double viscosity_number = 0.01;  // viscosity time over that of a wave across a cell; decides if viscosity_time is NaN
  double viscosity_time = std::numeric_limits<double>::quiet_NaN();  // s, Kelvin-Voigt
  double hydraulic_conductivity = 0;                                 // m/s
};

// Quantity of a release; a thickness may also be the difference between a raster of the former surface and the DEM.
struct MapValue {
  enum class From { number, attribute, raster, surface };
  From from = From::number;
  double number = 0.0;
  std::string source;  // name of the attribute, or path of the raster (absolute once read)
};

// Time at which a body is released: a number [s], or an attribute of its release polygons.
struct ReleaseTime {
  double number = 0.0;
  std::string attribute;  // empty: the number
};

struct Body {
  std::string material;
  BodyShape shape = BodyShape::box;
  Point min{}, max{};                           // box
  std::vector<std::array<double, 2>> vertices;  // polygon (2D)
  int particles_per_axis = 2;                   // per cell and axis
  InitialField temperature{-10.0};
  InitialField porosity{0.375};
  InitialField saturation;   // liquid saturation of the pores; if given, the freezing curve determines the temperature
  InitialField ice_content;  // volume fraction; if given, porosity is ice_content / (1 - saturation)
  Point velocity{};
  std::string release;                // file of polygons; absolute once read; empty: a raster specifies the thickness
  std::vector<std::string> polygons;  // names of the polygons that form the body; empty: all
  std::string name_attribute = "name";
  MapValue thickness;
  ReleaseTime release_time;  // held until then
  ThicknessAlong thickness_along = ThicknessAlong::vertical;
  Placement placement = Placement::on_top;
  double taper = 0.0;               // m, width over which the thickness falls to 0 at the edge
  double surface_tolerance = 0.01;  // m, difference between two surfaces that counts as zero
  double largest_volume = 2e8;      // m3; a larger volume must be confirmed by a larger value
};

struct Frame {
  Point min{}, max{};   // box at t = 0; moves with its velocity
  std::string axis;     // x, y or z: prescribed component
  double velocity = 0;  // m/s
};

struct Initial {
  double noise =
      0.0;       // maximum displacement of a particle from its regular position, as a fraction of the particle spacing
  int seed = 0;  // of the random displacements
};

struct Mechanics {
  bool enabled = true;
  ShapeFunction shape_function = ShapeFunction::ugimp;
  Transfer transfer = Transfer::flip;
  double pic_fraction = 0.0;   // Transfer::blend
  int fmpm_order = 2;          // Transfer::fmpm
  double fmpm_interval = 0.0;  // s, Transfer::fmpm
  InitialStress initial_stress = InitialStress::geostatic;
  double k0 = -1.0;  // negative: nu / (1 - nu)
  bool slope_shear = false;
  bool effective_stress = false;  // pore pressure also acts inside the body
  double settle_time = 0.0;       // s, InitialStress::settle
  double settle_damping = 0.0;    // 1/s, during settling
  double mass_damping = 0.0;      // 1/s, during the run
  bool split_stretched = false;
  double split_limit = 8.0;  // of the number of particles, relative to t = 0
};

// Contact between bodies: [contact] for all, [contact_pair.NAME] for two.
struct Contact {
  BodyContact between_bodies = BodyContact::bonded;
  double friction_angle = 0;  // degrees
};

struct ContactPair {
  std::vector<std::string> bodies;  // names of the two bodies
  BodyContact contact = BodyContact::frictional;
  double friction_angle = 0;  // degrees
};

struct Mechanisms {  // Sec. 3.3
  bool deformation = true, lubrication = true, pressurization = true;
};

struct Band {
  BandKind model = BandKind::scaled;  // default of a case file: parameters_model.cpp
  BandThickness thickness;            // m over time; not given: no band, xi = 1
  BandRegion region = BandRegion::all;
  ThicknessChange thickness_change = ThicknessChange::conserving;
  BandGrowth growth = BandGrowth::none;
  double grain_size = 0.05;                                      // m, BandGrowth::inertial
  double inertial_number = 0.3;                                  // BandGrowth::inertial
  double growth_per_slip = 0;                                    // BandGrowth::slip
  double mixing_slip = std::numeric_limits<double>::infinity();  // m, over which shear mixes the band; infinity: none
  double load_time = 1.0;                                        // s, averaging time of N
  double column_step = 0.1;                                      // s, maximum time step of a column
  double ground_temperature = std::numeric_limits<double>::quiet_NaN();  // C; NaN: temperature of the body's base
};

struct HeatBoundary {
  HeatBoundaryKind kind = HeatBoundaryKind::insulated;
  double value = 0;  // C, or W/m2 into the body
};

struct Heat {
  bool enabled = true;
  HeatUpdate update = HeatUpdate::enthalpy;
  bool latent = true;
  bool steam = true;
  bool conduction = true;
  bool advection = true;
  AdvectionForm advection_form = AdvectionForm::conservative;
  std::array<HeatBoundary, 6> boundary{};
};

struct Pressure {
  bool enabled = true;
  bool thermal_pressurization = true;  // off: once melted, the liquid keeps r^-1 P_I
  bool volumetric_term = false;
  FrozenPressure frozen = FrozenPressure::none;
  double residual_stress = std::numeric_limits<double>::infinity();  // Pa, s0; infinity: no excess pressure on thawing
  bool melt_contraction = true;                                      // melting leaves a void that fills before P rises
  double skeleton_compressibility = 2e-9;                            // 1/Pa, m_v; 0: rigid pore
  bool seepage = true;
  FrozenRows frozen_rows = FrozenRows::sealed;
  EndOfWater column_top = EndOfWater::vented;
  double water_to_steam_viscosity = 0;  // ratio; 0: steam does not seep
  ThicknessDirection thickness_direction = ThicknessDirection::normal;
  ThicknessUpdate thickness_update = ThicknessUpdate::each_step;
};

struct Block {
  bool bends = true;  // include the pressure due to bends
};

struct Probe {
  Point point{};     // x, y
  std::string line;  // file of a cross section; absolute once read; empty: a point
};

// Text of a case file when it was read.
struct CaseFile {
  std::filesystem::path file;
  std::string text;
};

// One `--set key=value`: value is the text of a TOML value, or a bare word for a string.
struct Override {
  std::string key;
  std::string value;
  std::filesystem::path folder{};  // to which paths in the value are relative
};

struct Case {
  std::string name;  // of the run
  std::string file;  // absolute path of the case file
  std::map<std::string, std::string>
      locations;  // locations of each given table and key by dotted name: "case.toml:12:7", "--set ..."
  std::set<std::string> not_given;   // those of `locations` that a resolved case contains as defaults
  std::vector<CaseFile> case_files;  // the case file and those it is based on, absolute
  std::vector<std::string> notes;    // changes that reading made
  General general;
  Time time;
  Grid grid;
  Guards guards;
  Terrain terrain;
  Phases phases;
  Freezing freezing;
  std::map<std::string, Material> materials;
  std::map<std::string, Body> bodies;
  std::map<std::string, Frame> frames;
  Initial initial;
  Mechanics mechanics;
  Basal basal;
  std::map<std::string, Substrate> substrates;
  Bed bed;
  Contact contact;
  std::map<std::string, ContactPair> contact_pairs;
  Mechanisms mechanisms;
  Band band;
  Heat heat;
  Pressure pressure;
  Block block;
  Checkpoint checkpoint;
  Maps maps;
  std::map<std::string, Probe> probes;
  Report report;
};

// Initial fields of a body with their keys.
inline std::array<std::pair<const char*, const InitialField*>, 4> fields_of(const Body& body) {
  return {{{"temperature", &body.temperature},
           {"saturation", &body.saturation},
           {"porosity", &body.porosity},
           {"ice_content", &body.ice_content}}};
}

// Whether the ground is a profile or a DEM.
inline bool has_terrain(const Case& parameters) {
  return parameters.terrain.kind == TerrainKind::profile || parameters.terrain.kind == TerrainKind::dem;
}
inline bool has_band_columns(const Case& parameters) { return parameters.band.model == BandKind::columns; }
inline bool guards_remove(const Case& parameters) {
  return parameters.guards.not_finite == Policy::remove || parameters.guards.volume == Policy::remove;
}
inline bool has_pore_water(const Case& parameters) { return parameters.pressure.enabled && parameters.heat.enabled; }
inline bool water_seeps(const Case& parameters) {
  const auto conducts = [](const auto& each) { return each.second.hydraulic_conductivity > 0.0; };
  return has_pore_water(parameters) && parameters.pressure.seepage &&
         std::any_of(parameters.materials.begin(), parameters.materials.end(), conducts);
}

// True if the user specified a key; the case in a run folder records this from the original case.
inline bool was_given(const Case& parameters, const std::string& dotted) {
  return parameters.locations.count(dotted) > 0 && parameters.not_given.count(dotted) == 0;
}

// Location of a key for messages; the case file if the key is not given.
inline const std::string& location_of(const Case& parameters, const std::string& dotted) {
  const auto found = parameters.locations.find(dotted);
  return found == parameters.locations.end() ? parameters.file : found->second;
}

}  // namespace thawslide::config
