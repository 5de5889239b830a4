#include "gis/valued_areas.hpp"

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "config/input_limits.hpp"

namespace thawslide::gis {

namespace {

double value_of(const VectorLayer& layer, const Feature& feature, const std::string& attribute) {
  const auto number = feature.numbers.find(attribute);
  if (number != feature.numbers.end() && std::isfinite(number->second)) {
    return number->second;
  }
  const auto text = feature.texts.find(attribute);
  throw UserError("{}: the attribute '{}' of {} is {}; needed: a number. Fill it in.", layer.file, attribute,
                  feature.title, text == feature.texts.end() ? "empty" : "'" + config::shown(text->second) + "'");
}

// Fraction of the smaller area: overlap of adjacent outlines due to rounding, which is ignored.
constexpr double rounding = 1e-6;

void check_apart(const VectorLayer& layer, const std::string& attribute, const Feature& first, const Feature& second) {
  const Polygons both = intersection_of(first.polygons, second.polygons);
  const double shared = area_of(both);
  if (shared <= rounding * std::min(area_of(first.polygons), area_of(second.polygons))) {
    return;
  }
  const Rectangle extent = extent_of(both);
  throw UserError(
      "{}: {} and {} overlap by {} m2 about {}, {}, and their '{}' differs: {:g} and {:g}. Give them the same value, "
      "or draw them apart.",
      layer.file, first.title, second.title, rounded_text(shared, 3),
      coordinate_text(0.5 * (extent.min_x + extent.max_x)), coordinate_text(0.5 * (extent.min_y + extent.max_y)),
      attribute, first.numbers.at(attribute), second.numbers.at(attribute));
}

}  // namespace

std::vector<ValuedArea> areas_by_value(const VectorLayer& layer, const std::string& attribute, const std::string& key) {
  const std::string name = attribute_named(layer, attribute, key);
  std::map<double, std::vector<const Feature*>> groups;
  for (const Feature& feature : layer.features) {
    groups[value_of(layer, feature, name)].push_back(&feature);
  }
  std::vector<ValuedArea> areas;
  for (auto group = groups.begin(); group != groups.end(); ++group) {
    Polygons all;
    for (const Feature* feature : group->second) {
      all.insert(all.end(), feature->polygons.begin(), feature->polygons.end());
      for (auto other = groups.begin(); other != group; ++other) {
        for (const Feature* before : other->second) {
          check_apart(layer, name, *before, *feature);
        }
      }
    }
    areas.push_back({group->first, union_of(all)});
  }
  return areas;
}

}  // namespace thawslide::gis
