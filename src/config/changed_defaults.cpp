#include "config/changed_defaults.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thawslide::config {

namespace {

bool yields(const Case& parameters) {
  return parameters.mechanics.enabled && parameters.mechanisms.deformation &&
         std::any_of(parameters.materials.begin(), parameters.materials.end(),
                     [](const auto& each) { return each.second.law == LawKind::mohr_coulomb; });
}

bool has_bends(const Case& parameters) {
  return parameters.terrain.kind == TerrainKind::profile || parameters.terrain.kind == TerrainKind::dem;
}

bool is_given(const Case& parameters, const ChangedDefault& changed) {
  if (changed.table != "material.NAME") {
    return parameters.locations.count(changed.table + "." + changed.key) > 0;
  }
  return std::any_of(parameters.materials.begin(), parameters.materials.end(), [&](const auto& each) {
    return parameters.locations.count("material." + each.first + "." + changed.key) > 0;
  });
}

}  // namespace

const std::vector<ChangedDefault>& changed_defaults() {
  static const std::vector<ChangedDefault> all{
      {"band", "model", "\"scaled\"", "\"columns\"", has_band_columns},
      {"band", "thickness_change", "\"as_published\"", "\"conserving\"", has_band_columns},
      {"heat", "advection_form", "\"as_published\"", "\"conservative\"", water_seeps},
      {"pressure", "frozen", "\"ice_pressure\"", "\"none\"", has_pore_water},
      {"pressure", "frozen_rows", "\"draining\"", "\"sealed\"", water_seeps},
      {"pressure", "melt_contraction", "false", "true", has_pore_water},
      {"pressure", "skeleton_compressibility", "0.0", "2e-09", has_pore_water},
      {"phases", "water_expansion_law", "\"constant\"", "\"by_temperature\"", has_pore_water},
      {"material.NAME", "gaps_close_first", "false", "true", yields},
      {"block", "bends", "false", "true", has_bends},
  };
  return all;
}

std::string changed_defaults_warning(const Case& parameters) {
  std::string changed;
  for (const ChangedDefault& each : changed_defaults()) {
    if (is_given(parameters, each)) {
      return "";
    }
    if (each.affects(parameters)) {
      changed += fmt::format("\n  {}.{} = {}  # was {}", each.table, each.key, each.now, each.before);
    }
  }
  if (changed.empty()) {
    return "";
  }
  return fmt::format(
      "{}: defaults of these keys have changed, and the file sets none of them:{}\n  The comments show the earlier "
      "values; setting them restores the earlier results. Set one of the keys to silence this warning "
      "(docs/choosing-the-base.md).",
      parameters.file, changed);
}

}  // namespace thawslide::config
