// Areas of the horizontal plane, bounded by straight lines.
#pragma once

#include <vector>

#include "config/site.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

using config::Polyline2;

// Rings are closed: the last corner is the first one.
struct Polygon {
  Polyline2 outline;
  std::vector<Polyline2> holes;
};

using Polygons = std::vector<Polygon>;

[[nodiscard]] Polygon box_polygon(const Rectangle& box);

// Area that a closed ring bounds [m2], by the trapezoid formula (Gauss) from its first corner; positive if it runs
// anticlockwise.
[[nodiscard]] double signed_area(const Polyline2& ring);
// Outlines less holes [m2].
[[nodiscard]] double area_of(const Polygons& polygons);
[[nodiscard]] Rectangle extent_of(const Polygons& polygons);
[[nodiscard]] Rectangle extent_of(const Polyline2& line);

// Counts what several cover once (GEOS).
[[nodiscard]] Polygons union_of(const Polygons& polygons);
// What both cover (GEOS).
[[nodiscard]] Polygons intersection_of(const Polygons& first, const Polygons& second);

}  // namespace thawslide::gis
