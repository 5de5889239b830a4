#include "gis/polygons.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "gis/gdal_messages.hpp"

namespace thawslide::gis {

Polygon box_polygon(const Rectangle& box) {
  return {{{box.min_x, box.min_y},
           {box.max_x, box.min_y},
           {box.max_x, box.max_y},
           {box.min_x, box.max_y},
           {box.min_x, box.min_y}},
          {}};
}

double signed_area(const Polyline2& ring) {
  double twice = 0.0;
  for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
    const double x = ring[k][0] - ring[0][0], y = ring[k][1] - ring[0][1];
    const double next_x = ring[k + 1][0] - ring[0][0], next_y = ring[k + 1][1] - ring[0][1];
    twice += x * next_y - next_x * y;
  }
  return 0.5 * twice;
}

double area_of(const Polygons& polygons) {
  double area = 0.0;
  for (const Polygon& polygon : polygons) {
    area += std::abs(signed_area(polygon.outline));
    for (const Polyline2& hole : polygon.holes) {
      area -= std::abs(signed_area(hole));
    }
  }
  return area;
}

Rectangle extent_of(const Polyline2& line) {
  THAWSLIDE_ASSERT(!line.empty(), "a line without corners");
  Rectangle extent{line[0][0], line[0][1], line[0][0], line[0][1]};
  for (const auto& corner : line) {
    extent.include(corner[0], corner[1]);
  }
  return extent;
}

Rectangle extent_of(const Polygons& polygons) {
  THAWSLIDE_ASSERT(!polygons.empty(), "no polygons");
  Rectangle extent = extent_of(polygons.front().outline);
  for (const Polygon& polygon : polygons) {
    const Rectangle one = extent_of(polygon.outline);
    extent.include(one.min_x, one.min_y);
    extent.include(one.max_x, one.max_y);
  }
  return extent;
}

OGRPolygon to_geometry(const Polygon& polygon) {
  const auto ring_of = [](const Polyline2& corners) {
    auto ring = std::make_unique<OGRLinearRing>();
    for (const auto& corner : corners) {
      ring->addPoint(corner[0], corner[1]);
    }
    return ring;
  };
  OGRPolygon geometry;
  geometry.addRingDirectly(ring_of(polygon.outline).release());
  for (const Polyline2& hole : polygon.holes) {
    geometry.addRingDirectly(ring_of(hole).release());
  }
  return geometry;
}

OGRMultiPolygon to_geometry(const Polygons& polygons) {
  OGRMultiPolygon geometry;
  for (const Polygon& polygon : polygons) {
    const OGRPolygon one = to_geometry(polygon);
    geometry.addGeometry(&one);
  }
  return geometry;
}

OGRLineString to_geometry(const Polyline2& line) {
  OGRLineString geometry;
  for (const auto& corner : line) {
    geometry.addPoint(corner[0], corner[1]);
  }
  return geometry;
}

Polyline2 from_geometry(const OGRSimpleCurve& curve) {
  Polyline2 line;
  for (int k = 0; k < curve.getNumPoints(); ++k) {
    line.push_back({curve.getX(k), curve.getY(k)});
  }
  return line;
}

Polygon from_geometry(const OGRPolygon& polygon) {
  Polygon result;
  result.outline = from_geometry(*polygon.getExteriorRing());
  for (int k = 0; k < polygon.getNumInteriorRings(); ++k) {
    if (!polygon.getInteriorRing(k)->IsEmpty()) {
      result.holes.push_back(from_geometry(*polygon.getInteriorRing(k)));
    }
  }
  return result;
}

Polygons areas_of(const OGRGeometry& geometry) {
  Polygons areas;
  const auto kind = wkbFlatten(geometry.getGeometryType());
  if (kind == wkbPolygon) {
    if (!geometry.IsEmpty()) {
      areas.push_back(from_geometry(*geometry.toPolygon()));
    }
  } else if (OGR_GT_IsSubClassOf(kind, wkbGeometryCollection)) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
      const Polygons more = areas_of(*part);
      areas.insert(areas.end(), more.begin(), more.end());
    }
  }
  return areas;
}

Polygons polygons_of_rings(const std::vector<Polyline2>& rings) {
  const GdalMessages messages;
  std::vector<OGRGeometry*> parts;  // organizePolygons takes ownership
  for (const Polyline2& ring : rings) {
    parts.push_back(to_geometry(Polygon{ring, {}}).clone());
  }
  if (parts.empty()) {
    return {};
  }
  const std::unique_ptr<OGRGeometry> areas(
      OGRGeometryFactory::organizePolygons(parts.data(), static_cast<int>(parts.size()), nullptr, nullptr));
  return areas_of(*areas);
}

std::vector<Polyline2> rings_of(const Polygons& polygons) {
  std::vector<Polyline2> rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outline);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

bool make_nested_rings_holes(Polygons& polygons) {
  Polygons areas = polygons_of_rings(rings_of(polygons));
  const GdalMessages messages;
  const bool is_valid =
      std::ranges::all_of(areas, [](const Polygon& area) { return to_geometry(area).IsValid() != 0; });
  // A hole outside every outline would be an area.
  if (!is_valid || areas.size() > polygons.size()) {
    return false;
  }
  const double change = area_of(areas) - area_of(polygons);
  polygons = std::move(areas);
  return std::abs(change) > 1e-9 * area_of(polygons);
}

Polygons union_of(const Polygons& polygons) {
  if (polygons.empty()) {
    return {};
  }
  const GdalMessages messages;
  const OGRMultiPolygon all = to_geometry(polygons);
  const std::unique_ptr<OGRGeometry> geometry(all.UnionCascaded());
  THAWSLIDE_ASSERT(geometry != nullptr, "no union of {} polygons{}", polygons.size(), messages.remark());
  return areas_of(*geometry);
}

Polygons intersection_of(const Polygons& first, const Polygons& second) {
  if (first.empty() || second.empty() || !extent_of(first).touches(extent_of(second))) {
    return {};
  }
  const GdalMessages messages;
  const OGRMultiPolygon one = to_geometry(union_of(first)), other = to_geometry(union_of(second));
  const std::unique_ptr<OGRGeometry> geometry(one.Intersection(&other));
  THAWSLIDE_ASSERT(geometry != nullptr, "no intersection of {} and {} polygons{}", first.size(), second.size(),
                   messages.remark());
  return areas_of(*geometry);
}

std::optional<Overlap> overlap_of(const Polygons& first, const Polygons& second, double tolerance) {
  const Polygons both = intersection_of(first, second);
  const double area = area_of(both), allowed = tolerance * std::min(area_of(first), area_of(second));
  if (area <= allowed) {
    return std::nullopt;
  }
  const Rectangle extent = extent_of(both);
  return Overlap{area, allowed,
                 fmt::format("{}, {}", coordinate_text(0.5 * (extent.min_x + extent.max_x)),
                             coordinate_text(0.5 * (extent.min_y + extent.max_y)))};
}

}  // namespace thawslide::gis
