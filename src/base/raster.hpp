// Values on a regular grid of points in the horizontal plane: a DEM, a thickness, a map.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace thawslide {

struct Raster {
  double x = 0.0, y = 0.0;  // of the first point, in the south-west: the centre of a file's lower left pixel [m]
  double cell_x = 1.0, cell_y = 1.0;  // distance of the points [m]
  int columns = 0, rows = 0;
  std::vector<double> values;  // shape [rows, columns], rows from south to north; NaN: no data
  std::string crs;             // coordinate reference system as WKT; empty: unknown

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] double at(int column, int row) const { return values[index(column, row)]; }
  [[nodiscard]] double x_of(int column) const { return x + column * cell_x; }
  [[nodiscard]] double y_of(int row) const { return y + row * cell_y; }
  [[nodiscard]] double x_end() const { return x_of(columns - 1); }
  [[nodiscard]] double y_end() const { return y_of(rows - 1); }
  // The same points, with or without values, with a uniform value.
  [[nodiscard]] Raster filled(double value) const {
    Raster other = *this;
    other.values.assign(index(0, rows), value);
    return other;
  }
};

// Calls work(column, row, value) for each point, from south to north; value: a reference.
template <class SomeRaster, class Work>
void for_each_point(SomeRaster& raster, const Work& work) {
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      work(column, row, raster.values[raster.index(column, row)]);
    }
  }
}

// Points without data. unknown: the result is NaN; nothing: they are omitted; zero: they are 0, as outside the raster.
enum class Missing { unknown, nothing, zero };

// Bilinear interpolation; NaN without data, and outside the outermost points unless `missing` is zero.
[[nodiscard]] double bilinear(const Raster& raster, double x, double y, Missing missing);

// Volume of a thickness [m3]: sum of the values times the area of a cell. Points without data count as 0.
[[nodiscard]] double volume_of(const Raster& thickness);

// Sets points without data (NaN) to the value of the nearest point with data, which must exist, in linear time.
void fill_from_nearest_known(Raster& raster);

}  // namespace thawslide
