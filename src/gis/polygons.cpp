#include "gis/polygons.hpp"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

namespace {

using Ring = std::vector<std::array<double, 2>>;  // in units of cells, from the corner of the first; not closed

// Part of a ring on one side of a line across an axis: side = 1 beyond it, -1 before it.
Ring cut(const Ring& ring, std::size_t axis, double line, double side) {
  Ring left;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto& corner = ring[k];
    const auto& next = ring[(k + 1) % ring.size()];
    const double here = side * (corner[axis] - line);
    const double there = side * (next[axis] - line);
    if (here >= 0.0) {
      left.push_back(corner);
    }
    if ((here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0)) {
      const double t = here / (here - there);
      std::array<double, 2> crossing{};
      crossing[axis] = line;
      crossing[1 - axis] = corner[1 - axis] + t * (next[1 - axis] - corner[1 - axis]);
      left.push_back(crossing);
    }
  }
  return left;
}

double area_in_cell(const Ring& ring, int column, int row) {
  double twice = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto& corner = ring[k];
    const auto& next = ring[(k + 1) % ring.size()];
    twice += (corner[0] - column) * (next[1] - row) - (next[0] - column) * (corner[1] - row);
  }
  return 0.5 * twice;
}

// Adds the area of a ring in each cell of the columns and rows from `first` to before `last`, which contain all of it.
void add_area(const Ring& ring, double sign, std::array<int, 2> first, std::array<int, 2> last, Raster& fractions) {
  if (ring.size() < 3) {
    return;
  }
  const std::array<int, 2> count{last[0] - first[0], last[1] - first[1]};
  if (count[0] == 1 && count[1] == 1) {
    fractions.values[fractions.index(first[0], first[1])] += sign * area_in_cell(ring, first[0], first[1]);
    return;
  }
  const std::size_t axis = count[0] >= count[1] ? 0 : 1;
  const int middle = first[axis] + count[axis] / 2;
  std::array<int, 2> before_last = last, beyond_first = first;
  before_last[axis] = middle;
  beyond_first[axis] = middle;
  add_area(cut(ring, axis, middle, -1.0), sign, first, before_last, fractions);
  add_area(cut(ring, axis, middle, 1.0), sign, beyond_first, last, fractions);
}

void add_ring(const Polyline2& corners, bool is_hole, Raster& fractions) {
  Ring ring;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    ring.push_back({(corners[k][0] - fractions.x) / fractions.cell_x + 0.5,
                    (corners[k][1] - fractions.y) / fractions.cell_y + 0.5});
    THAWSLIDE_ASSERT(ring.back()[0] >= 0.0 && ring.back()[0] <= fractions.columns && ring.back()[1] >= 0.0 &&
                         ring.back()[1] <= fractions.rows,
                     "a corner at {}, {}, beyond the raster", corners[k][0], corners[k][1]);
  }
  const double orientation = signed_area(corners) > 0.0 ? 1.0 : -1.0;
  add_area(ring, is_hole ? -orientation : orientation, {0, 0}, {fractions.columns, fractions.rows}, fractions);
}

}  // namespace

Raster coverage_of(const Polygons& polygons, const Raster& layout) {
  Raster fractions = layout.filled(0.0);
  for (const Polygon& polygon : polygons) {
    add_ring(polygon.outline, false, fractions);
    for (const Polyline2& hole : polygon.holes) {
      add_ring(hole, true, fractions);
    }
  }
  constexpr double rounding = 1e-12;  // fraction of a cell: smaller differences from 0 and 1 are round-off
  for (double& fraction : fractions.values) {
    THAWSLIDE_ASSERT(fraction > -1e-9 && fraction < 1.0 + 1e-9, "a fraction of {}", fraction);
    fraction = fraction < rounding ? 0.0 : fraction > 1.0 - rounding ? 1.0 : fraction;
  }
  return fractions;
}

Polygons areas_of_mask(const Raster& mask) {
  const GdalMessages messages;
  std::vector<std::uint8_t> bytes(mask.values.size());
  std::ranges::transform(mask.values, bytes.begin(), [](double value) { return value != 0.0 && !std::isnan(value); });
  const auto create = [](const char* driver, int columns, int rows, int bands) {
    return GDALDatasetUniquePtr(
        GetGDALDriverManager()->GetDriverByName(driver)->Create("", columns, rows, bands, GDT_Byte, nullptr));
  };
  const GDALDatasetUniquePtr dataset = create("MEM", mask.columns, mask.rows, 1), found = create("Memory", 0, 0, 0);
  double transform[6] = {mask.x - 0.5 * mask.cell_x, mask.cell_x, 0.0, mask.y - 0.5 * mask.cell_y, 0.0, mask.cell_y};
  dataset->SetGeoTransform(transform);
  OGRLayer* const layer = found->CreateLayer("areas", nullptr, wkbPolygon, nullptr);
  GDALRasterBand* const band = dataset->GetRasterBand(1);
  // The mask serves as its own mask: no polygons where it is 0.
  const bool is_done = band->RasterIO(GF_Write, 0, 0, mask.columns, mask.rows, bytes.data(), mask.columns, mask.rows,
                                      GDT_Byte, 0, 0, nullptr) == CE_None &&
                       GDALPolygonize(band, band, layer, -1, nullptr, nullptr, nullptr) == CE_None;
  THAWSLIDE_ASSERT(is_done, "no areas of {} x {} points{}", mask.columns, mask.rows, messages.remark());
  Polygons areas;
  for (const auto& feature : *layer) {
    const Polygons more = areas_of(*feature->GetGeometryRef());
    areas.insert(areas.end(), more.begin(), more.end());
  }
  return areas;
}

}  // namespace thawslide::gis
