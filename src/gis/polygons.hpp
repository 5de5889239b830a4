// Polygonal areas in the horizontal plane.
#pragma once

#include <vector>

#include "config/site.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

using config::Polyline2;

// Rings are closed: the last corner equals the first.
struct Polygon {
  Polyline2 outline;
  std::vector<Polyline2> holes;
};

using Polygons = std::vector<Polygon>;

[[nodiscard]] Polygon box_polygon(const Rectangle& box);

// Area of a closed ring [m2], by the trapezoid formula (Gauss) relative to its first corner; positive if it is
// anticlockwise.
[[nodiscard]] double signed_area(const Polyline2& ring);
// Outlines minus holes [m2].
[[nodiscard]] double area_of(const Polygons& polygons);
[[nodiscard]] Rectangle extent_of(const Polygons& polygons);
[[nodiscard]] Rectangle extent_of(const Polyline2& line);

// Areas bounded by closed rings, in which a ring inside another one is a hole.
[[nodiscard]] Polygons polygons_of_rings(const std::vector<Polyline2>& rings);

// Union: areas covered several times count once (GEOS).
[[nodiscard]] Polygons union_of(const Polygons& polygons);
// Area covered by both (GEOS).
[[nodiscard]] Polygons intersection_of(const Polygons& first, const Polygons& second);

}  // namespace thawslide::gis
