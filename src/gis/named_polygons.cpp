#include "gis/named_polygons.hpp"

#include "gis/error_location.hpp"

namespace thawslide::gis {

VectorLayer read_named_polygons(const config::Case& parameters, const PolygonRequest& request, const std::string& crs,
                                std::vector<std::string>& warnings) {
  VectorLayer layer =
      with_error_location(parameters, request.table + request.key, [&] { return read_polygons(request.file, crs); });
  warnings.insert(warnings.end(), layer.warnings.begin(), layer.warnings.end());
  layer.features = with_error_location(parameters, request.table + "polygons",
                                       [&] { return features_named(layer, request.names, request.name_attribute); });
  return layer;
}

Polygons union_of_features(const VectorLayer& layer) {
  Polygons all;
  for (const Feature& feature : layer.features) {
    all.insert(all.end(), feature.polygons.begin(), feature.polygons.end());
  }
  return union_of(all);
}

Polygons part_in_domain(const config::Case& parameters, const PolygonRequest& request, const Polygons& polygons) {
  const Rectangle domain = domain_of(parameters);
  Polygons inside = intersection_of(polygons, {box_polygon(domain)});
  if (!(area_of(inside) > 0.0)) {
    fail_at(
        parameters, request.table + request.key,
        "{}: the polygons ({}) lie outside the domain ({}). Check that both have the same place and reference system.",
        request.file, format_range(extent_of(polygons)), format_range(domain));
  }
  return inside;
}

}  // namespace thawslide::gis
