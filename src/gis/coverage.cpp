// Conversion between polygons and rasters.
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

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

// Adds the area of a ring in each cell of the columns and rows from `first` up to but excluding `last`, which contain
// all of it.
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
