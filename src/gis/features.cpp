// Features of vector files by names and values.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

namespace {

// Names within a file may contain characters that control a terminal.
std::vector<std::string> all_shown(std::vector<std::string> names) {
  std::ranges::transform(names, names.begin(), config::shown);
  return names;
}

double value_of(const VectorLayer& layer, const Feature& feature, const std::string& attribute) {
  const auto number = feature.numbers.find(attribute);
  if (number != feature.numbers.end() && std::isfinite(number->second)) {
    return number->second;
  }
  const auto text = feature.texts.find(attribute);
  throw UserError("{}: the attribute '{}' of {} is {}; needed: a number. Fill it in.", layer.file, attribute,
                  feature.title, text == feature.texts.end() ? "empty" : "'" + config::shown(text->second) + "'");
}

}  // namespace

std::string attribute_named(const VectorLayer& layer, const std::string& name, const std::string& key) {
  if (std::ranges::count(layer.attributes, name) == 1) {
    return name;
  }
  std::vector<std::string> alike;
  std::ranges::copy_if(layer.attributes, std::back_inserter(alike),
                       [&](const std::string& attribute) { return lower_case(attribute) == lower_case(name); });
  if (alike.size() > 1) {
    throw UserError(
        "{}: several attributes are called like '{}', which {} asks for: {}; allowed: one, or one of exactly this "
        "name. Write the name as the file does, or rename the others.",
        layer.file, name, key, config::comma_list(all_shown(alike)));
  }
  if (alike.size() == 1) {
    return alike.front();
  }
  const std::vector<std::string> there = all_shown(layer.attributes);
  throw UserError("{}: there is no attribute '{}', which {} asks for; the file has: {}{}", layer.file, name, key,
                  there.empty() ? "none" : config::comma_list(there),
                  config::did_you_mean(name, there, ". Correct the name, or add the attribute."));
}

std::vector<Feature> features_named(const VectorLayer& layer, const std::vector<std::string>& names,
                                    const std::string& name_attribute) {
  if (names.empty()) {
    return layer.features;
  }
  const std::string attribute = attribute_named(layer, name_attribute, "name_attribute");
  std::vector<std::string> all;
  std::vector<Feature> chosen;
  std::set<std::string> found;
  for (const Feature& feature : layer.features) {
    const auto text = feature.texts.find(attribute);
    if (text == feature.texts.end()) {
      continue;
    }
    if (std::ranges::find(all, text->second) == all.end()) {
      all.push_back(text->second);
    }
    if (std::ranges::find(names, text->second) != names.end()) {
      chosen.push_back(feature);
      found.insert(text->second);
    }
  }
  const std::vector<std::string> there = all_shown(all);
  for (const std::string& name : names) {
    if (found.count(name) == 0) {
      throw UserError("{}: no polygon has the {} '{}'; the file has: {}{}", layer.file, config::shown(attribute), name,
                      there.empty() ? "none" : config::comma_list(there), config::did_you_mean(name, there));
    }
  }
  return chosen;
}

std::vector<ValuedArea> areas_by_value(const VectorLayer& layer, const std::string& attribute, const std::string& key) {
  const std::string name = attribute_named(layer, attribute, key);
  std::map<double, std::vector<const Feature*>> groups;
  for (const Feature& feature : layer.features) {
    groups[value_of(layer, feature, name)].push_back(&feature);
  }
  std::vector<ValuedArea> areas;
  for (const auto& [value, features] : groups) {
    Polygons all;
    for (const Feature* feature : features) {
      all.insert(all.end(), feature->polygons.begin(), feature->polygons.end());
      for (const auto& [other_value, others] : groups) {
        if (other_value == value) {
          break;
        }
        for (const Feature* other : others) {
          constexpr double rounding = 1e-6;
          if (const auto shared = overlap_of(other->polygons, feature->polygons, rounding)) {
            throw UserError(
                "{}: {} and {} overlap by {} m2 about {}, and their '{}' differs: {:g} and {:g}. Give them the same "
                "value, or draw them apart.",
                layer.file, other->title, feature->title, rounded_text(shared->area, 3), shared->place, name,
                other_value, value);
          }
        }
      }
    }
    areas.push_back({value, union_of(all)});
  }
  return areas;
}

VectorLayer read_named_polygons(const PolygonRequest& request, const std::string& crs,
                                std::vector<std::string>& warnings) {
  VectorLayer layer = at_place(request.file.place, [&] { return read_polygons(request.file.value, crs); });
  warnings.insert(warnings.end(), layer.warnings.begin(), layer.warnings.end());
  layer.features =
      at_place(request.names.place, [&] { return features_named(layer, request.names.value, request.name_attribute); });
  return layer;
}

Polygons union_of_features(const VectorLayer& layer) {
  Polygons all;
  for (const Feature& feature : layer.features) {
    all.insert(all.end(), feature.polygons.begin(), feature.polygons.end());
  }
  return union_of(all);
}

Polygons part_in_domain(const PolygonRequest& request, const Polygons& polygons, const Rectangle& domain) {
  Polygons inside = intersection_of(polygons, {box_polygon(domain)});
  if (!(area_of(inside) > 0.0)) {
    throw UserError(
        "{}: {}: the polygons ({}) lie outside the domain ({}). Check that both have the same place and reference "
        "system.",
        request.file.place, request.file.value, format_range(extent_of(polygons)), format_range(domain));
  }
  return inside;
}

}  // namespace thawslide::gis
