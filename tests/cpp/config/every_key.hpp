// Cases that contain every key, none with its default value.
#pragma once

#include <string>

#include "case_messages.hpp"

namespace thawslide::config {

using case_messages::one_key_per_line;

// Every key of a 2D case, none with its default value, in the format of the program. Keys for 3D cases only are in the
// other texts.
inline const std::string every_key = one_key_per_line(R"(
[case] title = "Every \"key\"" | width = 12.5 | gravity = 9.75 | gravity_tilt = -1.5
[time] end = 4.5 | stepping = "adaptive" | step = 0.25 | safety = 0.5 | output_interval = 1.5 |
  history_interval = 0.125 | stop_at_rest = 0.0625 | rest_time = 5.0 | moved_distance = 0.5
[grid] cell = 2.5 | min = [-5.0, -10.0] | max = [95.0, 40.0] | leaving = "remove" | steepest = 70.0
[grid.boundary] x_min = "fixed" | x_max = "roller"
[guards] not_finite = "remove" | volume = "remove" | smallest_volume = 0.125 | largest_volume = 20.0 |
  removed_mass = 0.0625 | energy_growth = 0.5 | smallest_step = 0.25 | most_steps = 1000000.0
[terrain] type = "profile" | elevation = -1.0 | file = "inputs/profile.csv" | extend = true
[checkpoint] wall_interval = 60.0 | interval = 3.0
[report] author = "an office" | scenario = "Ice falls." | logo = "inputs/logo.png" |
  times = [1.0, 2.5] | targets = "inputs/targets.csv" | force_record = "inputs/force.csv" |
  force_periods = [10.0, 200.0] | force_source = "a survey"
[phases] rock_density = 2700.5 | ice_density = 900.5 | water_density = 1001.5 | rock_heat_capacity = 801.5 |
  ice_heat_capacity = 2001.5 | water_heat_capacity = 4001.5 | rock_conductivity = 3.5 | ice_conductivity = 2.5 |
  water_conductivity = 0.75 | rock_expansion = 0.001 | ice_expansion = 0.002 | water_expansion = 0.003 |
  water_expansion_law = "constant" | water_bulk_modulus = 2000000000.0 | latent_heat = 330000.0 |
  water_unit_weight = 9800.0 | ice_to_rock_density_ratio = 0.325
[freezing] curve = "linear" | exponent = 4.0 | slope = 0.25 | reference_temperature = -0.5
[material.rock] law = "elastic" | youngs_modulus = 400000000.0 | poisson_ratio = 0.25 | friction_angle = 31.0 |
  dilation_angle = 4.0 | cohesion = 200000.0 | residual_cohesion = 100000.0 | residual_friction_angle = 22.0 |
  softening_strain = 0.02 | tension_cutoff = 10000.0 | gaps_close_first = false | viscosity_time = 0.03 |
  hydraulic_conductivity = 0.0001
[body.block] material = "rock" | shape = "polygon" | min = [1.0, 2.0] | max = [3.0, 4.0] |
  vertices = [[0.0, 0.0], [40.0, 0.0], [40.0, 20.0]] | particles_per_axis = 3 |
  temperature = { depth = [0.0, 5.0], value = [-1.0, -2.0] } | porosity = { x = [0.0, 40.0], value = [0.3, 0.4] } |
  velocity = [1.5, -0.5]
[initial] noise = 0.125 | seed = 7
[mechanics] enabled = false | shape_function = "quadratic" | transfer = "blend" | pic_fraction = 0.125 |
  initial_stress = "settle" | k0 = 0.4 | effective_stress = true | settle_time = 6.0 | settle_damping = 7.0 |
  mass_damping = 8.0
[basal] friction = "constant" | friction_angle = 25.0 | lubrication_exponent = 3.0 | min_solid_fraction = 0.1 |
  max_solid_fraction = 0.9 | clamp = "joint" | cap_pressure = true | heat_fraction = 0.35 | distance_check = false |
  cohesion = 300000.0 | cohesion_law = "time" | residual_cohesion = 150000.0 | slip_distance = 400.0 |
  cohesion_loss_time = 20.0
[substrate.ice] x_min = 5.0 | x_max = 50.0 | friction = "constant" | friction_angle = 15.0 |
  lubrication_exponent = 4.0 | min_solid_fraction = 0.15 | max_solid_fraction = 0.95 | cohesion = 30000.0 |
  cohesion_law = "bonds" | residual_cohesion = 15000.0 | slip_distance = 40.0 | cohesion_loss_time = 30.0
[bed] law = "momentum" | depth = { x = [0.0, 40.0], value = [0.5, 1.5] } | strength = 2000.0 | friction_angle = 12.0 |
  depth_per_slip = 0.125 | material = "rock" | temperature = -2.5 | porosity = 0.75 | particles_per_axis = 4
[mechanisms] deformation = false | lubrication = false | pressurization = false
[band] thickness = { time = [0.0, 75.0, 75.0], value = [0.05, 0.05, 0.5] } | region = "first_layer" |
  thickness_change = "as_published"
[heat] enabled = false | update = "apparent_capacity" | latent = false | steam = false |
  conduction = false | advection = false | advection_form = "as_published"
[heat.boundary] x_min = { temperature = -6.0 } | x_max = { flux = 12.5 }
[pressure] thermal_pressurization = false | volumetric_term = true |
  frozen = "ice_pressure" | melt_contraction = false | skeleton_compressibility = 0.001 | seepage = false |
  column_top = "sealed" | water_to_steam_viscosity = 20.0 | frozen_rows = "vented" |
  thickness_direction = "vertical" | thickness_update = "frozen"
[block] bends = false
)");

inline const std::string rest_in_3d = one_key_per_line(R"(
[case] dimension = 3
[time] end = 4.5 | step = 0.25
[grid] cell = 2.5 | min = [-5.0, 0.0, -10.0] | max = [95.0, 10.0, 40.0]
[grid.boundary] y_min = "roller" | y_max = "fixed"
[terrain] type = "plane" | slope = 5.0
[material.rock] law = "elastic" | youngs_modulus = 400000000.0 | poisson_ratio = 0.25 | softening_slip = 0.75
[probe.gauge] point = [12.5, -3.0]
[body.block] material = "rock" | min = [0.0, 0.0, 1.0] | max = [40.0, 5.0, 20.0] | velocity = [1.5, -0.5, 0.25]
[mechanics] transfer = "fmpm" | fmpm_order = 3 | fmpm_interval = 0.5 | slope_shear = true |
  split_stretched = true | split_limit = 4.5
[basal] friction = "voellmy" | friction_coefficient = 0.125 | turbulent_friction = 250.0
[band] model = "columns" | thickness = 0.5 | growth = "slip" | growth_per_slip = 0.125 | mixing_slip = 250.0 |
  load_time = 1.5 | column_step = 0.125 | ground_temperature = -3.0
[pressure] enabled = false | residual_stress = 20000.0
)");

// No terrain, which excludes these.
inline const std::string between_walls = one_key_per_line(R"(
[case] dimension = 3
[time] end = 4.5 | step = 0.25
[grid] cell = 2.5 | min = [-5.0, 0.0, -10.0] | max = [95.0, 10.0, 40.0]
[grid.boundary] z_min = "fixed" | z_max = "roller"
[material.rock] law = "elastic" | youngs_modulus = 400000000.0 | poisson_ratio = 0.25
[body.block] material = "rock" | min = [0.0, 0.0, 1.0] | max = [40.0, 5.0, 20.0]
[frame.wall] min = [50.0, 0.0, 0.0] | max = [60.0, 9.0, 9.0] | axis = "y" | velocity = 2.25
[heat.boundary] z_min = { temperature = -8.0 } | z_max = { flux = 3.5 }
)");

// A release on a DEM, with all fields from maps.
inline const std::string release_on_dem = one_key_per_line(R"(
[case] dimension = 3
[time] end = 4.5 | step = 0.25
[grid] cell = 2.5 | min = [-5.0, 0.0, -10.0] | max = [95.0, 10.0, 40.0]
[terrain] type = "dem" | file = "inputs/dem.tif" | crs = "EPSG:31287" | resample = 10.0 | smooth = 2.5
[maps] cell = 20.0 | arrival_thickness = 0.5 | area_thickness = 0.2 | path = "inputs/path.geojson"
[probe.gauge] line = "inputs/section.geojson"
[material.rock] law = "elastic" | youngs_modulus = 400000000.0 | poisson_ratio = 0.25 | viscosity_number = 0.5
[body.block] material = "rock" | shape = "release" | release = "inputs/release.shp" |
  polygons = ["upper \"part\"", "lower"] | name_attribute = "part" | thickness = { raster = "inputs/thickness.tif" } |
  thickness_along = "normal" | placement = "cut" | taper = 5.0 | largest_volume = 300000000.0 |
  saturation = { raster = "inputs/saturation.tif" } | ice_content = { attribute = "ice" } |
  release_time = { attribute = "from" }
[basal] friction_angle = 25.0
[substrate.ice] outline = "inputs/release.shp" | polygons = ["glacier"] | name_attribute = "kind" |
  friction = "voellmy" | friction_coefficient = 0.125 | turbulent_friction = 250.0
[heat.boundary] y_min = { temperature = -7.0 } | y_max = { flux = -2.0 }
[body.upper] material = "rock" | shape = "release" | release = "inputs/release.shp" | polygons = ["upper"] |
  thickness = 5.0 | release_time = 2.5
[contact] between_bodies = "frictional" | friction_angle = 25.0
[contact_pair.seam] bodies = ["block", "upper"] | contact = "frictional" | friction_angle = 12.5
)");

// The same release between two surfaces, with growing band columns, the substrate from a raster, and a bed in polygons.
inline std::string release_of_a_surface() {
  using namespace case_messages;
  std::string text =
      changed({{"outline = \"inputs/release.shp\"\npolygons = [\"glacier\"]\nname_attribute = \"kind\"\n",
                "raster = \"inputs/codes.tif\"\ncode = 3\n"},
               {"[heat.boundary]\ny_min = { temperature = -7.0 }\ny_max = { flux = -2.0 }\n",
                "[band]\nthickness = 0.5\ngrowth = \"inertial\"\ngrain_size = 0.0625\ninertial_number = 0.25\n"}},
              release_on_dem);
  text.resize(text.find("[contact]"));  // refused with columns and with a bed
  text += one_key_per_line(R"(
[bed] law = "strength" | depth = { attribute = "depth" } | outline = "inputs/release.shp" | polygons = ["valley"] |
  name_attribute = "kind" | strength = 2000.0 | depth_per_slip = 0.125 | material = "rock"
)");
  const auto begin = text.find("\nthickness = ") + 1, end = text.find("taper = ");
  return text.replace(begin, end - begin, "thickness = { surface = \"inputs/before.tif\" }\nsurface_tolerance = 0.5\n");
}

}  // namespace thawslide::config
