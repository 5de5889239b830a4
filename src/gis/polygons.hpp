// Polygonal areas in the horizontal plane.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/site.hpp"
#include "gis/point_window.hpp"

namespace thawslide::gis {

using config::Polyline2;

// Rings are closed: the last corner equals the first.
struct Polygon {
  Polyline2 outline;
  std::vector<Polyline2> holes;
};

using Polygons = std::vector<Polygon>;

[[nodiscard]] Polygon box_polygon(const Rectangle& box);

// Area of a closed ring [m2], positive if it is anticlockwise.
[[nodiscard]] double signed_area(const Polyline2& ring);
// Outlines minus holes [m2].
[[nodiscard]] double area_of(const Polygons& polygons);
[[nodiscard]] Rectangle extent_of(const Polygons& polygons);
[[nodiscard]] Rectangle extent_of(const Polyline2& line);

// Areas bounded by closed rings, in which a ring inside another one is a hole.
[[nodiscard]] Polygons polygons_of_rings(const std::vector<Polyline2>& rings);

// Makes rings within others holes, and rings within holes areas. Returns whether anything has changed.
bool make_nested_rings_holes(Polygons& polygons);

// Fraction of the smaller area: adjacent outlines drawn by hand, or transformed, overlap in slivers.
inline constexpr double overlap_tolerance = 1e-3;

// Outlines and holes.
[[nodiscard]] std::vector<Polyline2> rings_of(const Polygons& polygons);

// Union: areas covered several times count once (GEOS).
[[nodiscard]] Polygons union_of(const Polygons& polygons);
// Area covered by both (GEOS).
[[nodiscard]] Polygons intersection_of(const Polygons& first, const Polygons& second);

struct Overlap {
  double area = 0.0, allowed = 0.0;  // [m2]
  std::string place;                 // coordinates of its middle: "1200, 300"
};
// Overlap of two areas if it exceeds a fraction of the smaller one.
[[nodiscard]] std::optional<Overlap> overlap_of(const Polygons& first, const Polygons& second,
                                                double tolerance = overlap_tolerance);

// Fraction of each point's cell covered by polygons, exact to round-off. They must not overlap, and must lie within the
// cells. Bisects and clips them at edges of cells (Sutherland and Hodgman 1974, Communications of the ACM 17, 32-42).
[[nodiscard]] Raster coverage_of(const Polygons& polygons, const Raster& layout);

// Areas with holes of the cells around points whose value is neither 0 nor NaN; cells that share an edge are joined.
[[nodiscard]] Polygons areas_of_mask(const Raster& mask);

}  // namespace thawslide::gis
