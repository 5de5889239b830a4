#include "sim/records/output_columns.hpp"

namespace thawslide::sim {

const std::vector<ColumnGroup>& probe_columns() {
  static const std::vector<ColumnGroup> groups{
      {"Time", "", {{"time_s", "s", "simulated time"}}},
      {"Points",
       "for each `[probe.NAME]` with a `point`",
       {{"thickness_m", "m", "vertical thickness in the map cell at the point"},
        {"speed_m_s", "m/s", "depth-averaged speed in that cell"}}},
      {"Cross sections",
       "for each `[probe.NAME]` with a `line`",
       {{"flow_area_m2", "m2", "vertical area of the flow in the section"},
        {"discharge_m3_s", "m3/s", "discharge through the section, positive downstream"},
        {"mean_speed_m_s", "m/s", "magnitude of the discharge divided by the flow area; 0 without flow"},
        {"max_thickness_m", "m", "maximum vertical thickness in the section"}}},
  };
  return groups;
}

const ColumnGroup& base_columns() {
  static const ColumnGroup group{
      "Basal segments",
      "with `band.model = \"columns\"`, from the first contact on",
      {{"position_m", "m", "centre of the segment on the ground; three components, z = 0 in 2D"},
       {"area_m2", "m2", "area of the segment"},
       {"thickness_m", "m", "thickness of the band"},
       {"normal_pressure_Pa", "Pa", "normal pressure N, averaged over `band.load_time`"},
       {"pore_pressure_Pa", "Pa", "mean pore pressure of the band"},
       {"temperature_C", "C", "mean temperature of the band"},
       {"max_temperature_C", "C", "maximum temperature of the column above the ground"},
       {"liquid_saturation", "1", "mean liquid saturation of the band"},
       {"opening_m", "m", "opening along the base by water at P = N"},
       {"slip_m", "m", "accumulated slip"},
       {"slip_speed_m_s", "m/s", "slip speed"}}};
  return group;
}

const ColumnGroup& block_columns() {
  static const ColumnGroup group{
      "Table of the rigid block",
      "by `thawslide block CASE --output FILE`",
      {{"time_s", "s", "simulated time"},
       {"velocity_m_s", "m/s", "velocity along the ground, positive in the direction of travel"},
       {"displacement_m", "m", "displacement along the ground, positive in the same direction"},
       {"front_position_m", "m", "x of the front; in 3D the distance along the path"},
       {"travel_distance_m", "m", "horizontal distance from the rear at t = 0 to the front, in 3D along the path"},
       {"drop_height_m", "m", "highest particle at t = 0, in 3D top of the release, above the ground at the front"},
       {"normal_pressure_Pa", "Pa", "mean normal pressure at the base"},
       {"pore_pressure_Pa", "Pa", "pore pressure at the base; 0 if pore pressure or pressurization is disabled"},
       {"sliding_strength_Pa", "Pa", "sliding strength of the base"},
       {"driving_traction_Pa", "Pa", "component of the weight along the ground, over the area of the base"},
       {"band_temperature_C", "C", "temperature of the band"},
       {"band_saturation", "1", "liquid saturation of the band"},
       {"band_pore_pressure_Pa", "Pa", "pore pressure of the band"},
       {"band_friction_coefficient", "1", "friction coefficient mu_e"},
       {"friction_work_J_m2", "J/m2", "friction work per area of the base"},
       {"friction_heat_J_m2", "J/m2", "part of that work that heated the material"},
       {"heat_gain_J_m2", "J/m2", "gain of heat of the column per area of the base"},
       {"valley_factor", "1", "area of the base over that of the profile, by which valley sides increase friction"}}};
  return group;
}

}  // namespace thawslide::sim
