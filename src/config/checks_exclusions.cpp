// Options that exclude each other: switches, band columns, cells on terrain, contact, and the width of a section.
#include <array>
#include <cmath>
#include <set>

#include "config/body_layers.hpp"
#include "config/checks.hpp"

namespace thawslide::config {

namespace {

const std::array side_names{"heat.boundary.x_min", "heat.boundary.x_max", "heat.boundary.y_min",
                            "heat.boundary.y_max", "heat.boundary.z_min", "heat.boundary.z_max"};

// Checks keys that make each other ineffective.
void check_switches(const Case& checked, Reading& reading) {
  const bool has_ground = checked.terrain.kind != TerrainKind::none;
  const Mechanics& mechanics = checked.mechanics;
  reading.refuse_if(!mechanics.enabled && !checked.heat.enabled && !checked.pressure.enabled,
                    {"mechanics.enabled", "heat.enabled", "pressure.enabled"},
                    "mechanics.enabled, heat.enabled and pressure.enabled are all false: nothing is left to compute. "
                    "Set at least one of them to true.");
  reading.refuse_if(
      mechanics.slope_shear && mechanics.initial_stress != InitialStress::geostatic,
      {"mechanics.slope_shear", "mechanics.initial_stress"},
      "mechanics.slope_shear is true, and mechanics.initial_stress is not \"geostatic\"; only that stress "
      "takes the shear. Set mechanics.initial_stress = \"geostatic\", or mechanics.slope_shear = false.");
  reading.refuse_if(checked.band.region == BandRegion::first_layer && !has_ground, {"band.region", "terrain.type"},
                    "band.region is \"first_layer\", and the case has no terrain; there is no layer above it. Set "
                    "band.region = \"all\", or give terrain.type.");
  reading.refuse_if(mechanics.split_stretched && !has_ground, {"mechanics.split_stretched", "terrain.type"},
                    "mechanics.split_stretched is true, and the case has no terrain; particles are stretched along it. "
                    "Set mechanics.split_stretched = false, or give terrain.type.");
  reading.refuse_if(mechanics.effective_stress && !checked.pressure.enabled,
                    {"mechanics.effective_stress", "pressure.enabled"},
                    "mechanics.effective_stress is true, and pressure.enabled is false; there is no pore pressure to "
                    "subtract. Set pressure.enabled = true, or mechanics.effective_stress = false.");
  reading.refuse_if(mechanics.transfer == Transfer::fmpm && checked.time.stepping == Stepping::fixed &&
                        mechanics.fmpm_interval < checked.time.step,
                    {"mechanics.fmpm_interval", "time.step", "mechanics.transfer"},
                    "mechanics.fmpm_interval is {} s, shorter than time.step, which is {} s; velocities are filtered "
                    "once a step at most. Make the interval longer.",
                    mechanics.fmpm_interval, checked.time.step);
  reading.refuse_if(checked.heat.advection_form == AdvectionForm::conservative && water_seeps(checked) &&
                        checked.heat.update != HeatUpdate::enthalpy,
                    {"heat.advection_form", "heat.update"},
                    "heat.advection_form is \"conservative\", and heat.update is \"apparent_capacity\", which still "
                    "creates heat. Set "
                    "heat.update = \"enthalpy\", or heat.advection_form = \"as_published\".");
  reading.refuse_if(
      std::isfinite(checked.pressure.residual_stress) && checked.pressure.frozen != FrozenPressure::none,
      {"pressure.residual_stress", "pressure.frozen"},
      "pressure.residual_stress is {} Pa, and pressure.frozen is not \"none\"; if ice has a pressure, water "
      "starts from it. Set pressure.frozen = \"none\", or remove pressure.residual_stress.",
      checked.pressure.residual_stress);
}

// With band columns, particles keep temperature and pore pressure, so keys that act on them have no effect.
void check_band_columns(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"band.model"}) || !has_band_columns(checked)) {
    return;
  }
  const auto require = [&](bool met, const char* key, const char* found, const char* allowed) {
    reading.refuse_if(!met, {key, "band.model"},
                      "band.model is \"columns\", and {0} is {1}; allowed with it: {2}. Set {0} so, or band.model = "
                      "\"scaled\".",
                      key, found, allowed);
  };
  require(checked.terrain.kind != TerrainKind::none, "terrain.type", "\"none\"", "any terrain");
  require(checked.band.thickness.is_given(), "band.thickness", "not given", "a thickness in m, constant or over time");
  require(checked.mechanics.enabled, "mechanics.enabled", "false", "true");
  require(!checked.mechanics.effective_stress, "mechanics.effective_stress", "true", "false");
  require(checked.heat.enabled, "heat.enabled", "false", "true");
  require(checked.heat.advection, "heat.advection", "false", "true");
  require(checked.heat.advection_form == AdvectionForm::conservative, "heat.advection_form", "\"as_published\"",
          "\"conservative\"");
  require(!checked.pressure.volumetric_term, "pressure.volumetric_term", "true", "false");
  require(checked.pressure.frozen == FrozenPressure::none, "pressure.frozen", "\"ice_pressure\"", "\"none\"");
  require(checked.pressure.frozen_rows != FrozenRows::draining, "pressure.frozen_rows", "\"draining\"",
          "\"sealed\" or \"vented\"");
  require(checked.pressure.melt_contraction, "pressure.melt_contraction", "false", "true");
  require(checked.band.thickness_change == ThicknessChange::conserving, "band.thickness_change", "\"as_published\"",
          "\"conserving\"");
  for (std::size_t side = 0; side < side_names.size(); ++side) {
    require(checked.heat.boundary[side].kind == HeatBoundaryKind::insulated, side_names[side], "not \"insulated\"",
            "\"insulated\"");
  }
}

constexpr std::size_t most_layers = 15;           // limit of mpm::Tile
constexpr std::size_t most_layers_in_stages = 7;  // held bodies have separate layers

// Checks that each pair names two existing bodies, and that no two pairs name the same bodies.
bool check_names(const Case& checked, Reading& reading) {
  std::set<std::set<std::string>> seen;
  bool are_right = true;
  for (const auto& [name, pair] : checked.contact_pairs) {
    const std::string key = "contact_pair." + name + ".bodies";
    if (!reading.are_valid({key})) {
      are_right = false;
      continue;
    }
    const std::set<std::string> names(pair.bodies.begin(), pair.bodies.end());
    if (pair.bodies.size() != 2 || names.size() != 2) {
      reading.report({key},
                     "{} has {} names of {} bodies; allowed: the names of two. Name the two bodies, as "
                     "in bodies = [\"ice\", \"rock\"].",
                     key, pair.bodies.size(), names.size());
      are_right = false;
      continue;
    }
    for (const std::string& body : pair.bodies) {
      if (checked.bodies.count(body) == 0) {
        std::vector<std::string> known;
        for (const auto& [known_body, unused] : checked.bodies) {
          known.push_back(known_body);
        }
        reading.report({key}, "{} names '{}', and there is no [body.{}]{} Allowed: {}.", key, body, body,
                       did_you_mean(body, known, "."), comma_list(known));
        are_right = false;
      }
    }
    if (are_right && !seen.insert(names).second) {
      reading.report({key}, "{} names two bodies that another [contact_pair.NAME] names too. Remove one.", key);
      are_right = false;
    }
  }
  return are_right;
}

void check_contact(const Case& checked, Reading& reading) {
  if (checked.bodies.empty() || !check_names(checked, reading) || !reading.are_valid({"contact.between_bodies"})) {
    return;
  }
  for (const auto& [name, pair] : checked.contact_pairs) {
    if (!reading.are_valid({"contact_pair." + name + ".contact", "contact_pair." + name + ".friction_angle"})) {
      return;
    }
  }
  std::string contradiction, of_pair;
  const BodyLayers layers = body_layers(checked, &contradiction, &of_pair);
  if (!contradiction.empty()) {
    reading.report({"contact_pair." + of_pair + ".contact"}, "{}", contradiction);
    return;
  }
  const std::string key =
      checked.contact.between_bodies == BodyContact::frictional ? "contact.between_bodies" : "contact_pair";
  const bool is_staged = has_stages(checked);
  const std::size_t most = is_staged ? most_layers_in_stages : most_layers;
  reading.refuse_if(
      layers.count > most, {key},
      "{}: too many bodies, or groups of bonded ones, in frictional contact (found {}; allowed {}{}). Bond "
      "those that move as one by [contact_pair.NAME] with contact = \"bonded\".",
      key, layers.count, most, is_staged ? " with a body.NAME.release_time" : "");
  // Each of these is reported, although the first report marks `key` as invalid.
  const auto exclude = [&](bool is_chosen, const char* other, const char* what, const char* remedy) {
    if (layers.count > 1 && reading.are_valid({other}) && is_chosen) {
      reading.report({key, other},
                     "{}: frictional contact between bodies and {} exclude each other. Set "
                     "contact.between_bodies = \"bonded\", or {}.",
                     key, what, remedy);
    }
  };
  exclude(has_band_columns(checked), "band.model", "band.model = \"columns\"", "band.model = \"scaled\"");
  exclude(checked.bed.law != BedLaw::none, "bed.law", "an erodible bed (bed.law)", "remove [bed]");
}

// True if some bodies have frictional contact; false while the case has problems.
bool bodies_are_apart(const Case& checked, const Reading& reading) {
  return reading.problems.empty() && !checked.bodies.empty() && body_layers(checked).count > 1;
}

}  // namespace

void check_cells(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"terrain.type"}) || checked.terrain.kind == TerrainKind::none) {
    return;
  }
  const auto v = static_cast<std::size_t>(checked.general.dimension - 1);
  const auto is_prescribed = [&](std::size_t side) {
    return checked.heat.boundary[side].kind != HeatBoundaryKind::insulated;
  };
  const auto is_closed = [&](std::size_t side) { return checked.grid.boundary[side] != BoundaryKind::open; };
  const struct {
    bool is_requested;
    const char* what;
  } options[] = {
      {!checked.frames.empty() && checked.terrain.kind != TerrainKind::flat, "a [frame] on ground that is not flat"},
      {is_closed(2 * v) || is_closed(2 * v + 1), "grid.boundary at the bottom or top of the domain"},
      {is_prescribed(2 * v) || is_prescribed(2 * v + 1), "heat.boundary at the bottom or top of the domain"},
  };
  std::string found;
  for (const auto& option : options) {
    found += option.is_requested ? (found.empty() ? "" : ", ") + std::string(option.what) : "";
  }
  if (!found.empty()) {
    reading.report({"terrain.type"},
                   "terrain.type: cells that follow the terrain do not support all options of this case "
                   "(found {}; allowed: none of these). Remove them: the terrain is the lower boundary. A "
                   "[frame] needs terrain.type = \"flat\".",
                   found);
  }
  reading.refuse_if(
      checked.terrain.kind == TerrainKind::plane && std::abs(checked.terrain.slope) > checked.grid.steepest,
      {"terrain.slope", "grid.steepest"},
      "terrain.slope is {:g} degrees, steeper than cells may follow the terrain (grid.steepest is {:g} "
      "degrees; allowed: up to 85). Increase grid.steepest, or reduce terrain.slope.",
      checked.terrain.slope, checked.grid.steepest);
}

void check_exclusions(const Case& checked, Reading& reading) {
  check_contact(checked, reading);
  check_switches(checked, reading);
  check_band_columns(checked, reading);
}

void check_width(const Case& checked, Reading& reading) {
  const std::string key = "case.width";
  if (!reading.are_valid({key}) || !checked.general.width.varies()) {
    return;
  }
  const struct {
    bool is_given;
    const char* what;
  } others[] = {
      {reading.are_valid({"bed.law"}) && checked.bed.law != BedLaw::none, "an erodible bed ([bed])"},
      {!checked.frames.empty(), "a rigid frame ([frame.NAME])"},
      {has_stages(checked), "a release in stages (body.NAME.release_time)"},
      {bodies_are_apart(checked, reading), "frictional contact between bodies ([contact])"},
  };
  for (const auto& other : others) {
    if (other.is_given) {
      reading.report({key},
                     "{}: a width that varies along x and {} exclude each other. Give one "
                     "width, or remove the latter.",
                     key, other.what);
      return;
    }
  }
}

}  // namespace thawslide::config
