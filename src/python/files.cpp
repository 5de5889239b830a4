// Files of a user for commands in Python: lists of input files, rasters and polygons.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "config/case.hpp"
#include "gis/raster_file.hpp"
#include "python/bindings.hpp"
#include "run/input_files.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/dem.hpp"
#include "gis/geopackage.hpp"
#include "gis/reference_system.hpp"
#include "gis/vector_file.hpp"
#endif

namespace thawslide::python {

namespace nb = nanobind;

namespace {

#ifdef THAWSLIDE_WITH_GIS

nb::object values_of(const Raster& raster) {
  return copied(raster.values, {static_cast<std::size_t>(raster.rows), static_cast<std::size_t>(raster.columns)});
}

nb::object corners_of(const gis::Polyline2& ring) {
  std::vector<double> numbers;
  for (const auto& corner : ring) {
    numbers.insert(numbers.end(), corner.begin(), corner.end());
  }
  return copied(numbers, {ring.size(), 2});
}

// Polygons of all features: lists of rings, the outline first; their names, which may be empty; and warnings.
nb::tuple polygons_in(const std::string& file, const std::string& crs) {
  const gis::VectorLayer layer = gis::read_polygons(file, crs);
  nb::list polygons;
  std::vector<std::string> names;
  for (const gis::Feature& feature : layer.features) {
    for (const gis::Polygon& polygon : feature.polygons) {
      nb::list rings;
      rings.append(corners_of(polygon.outline));
      for (const gis::Polyline2& hole : polygon.holes) {
        rings.append(corners_of(hole));
      }
      polygons.append(rings);
      names.push_back(feature.name);
    }
  }
  return nb::make_tuple(polygons, names, layer.warnings);
}

gis::Polyline2 ring_of(const nb::handle& corners) {
  const auto array = nb::cast<nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>>(corners);
  gis::Polyline2 ring;
  for (std::size_t k = 0; k < array.shape(0); ++k) {
    ring.push_back({array(k, 0), array(k, 1)});
  }
  return ring;
}

// One feature per list of polygons, which are lists of rings. Columns: their values, numbers or texts, by name.
void write_polygons(const std::string& file, const std::string& layer, const nb::list& features,
                    const nb::dict& columns, const std::string& crs) {
  std::vector<gis::Polygons> written;
  for (const nb::handle polygons : features) {
    gis::Polygons& feature = written.emplace_back();
    for (const nb::handle rings : polygons) {
      gis::Polygon& polygon = feature.emplace_back();
      for (const nb::handle ring : rings) {
        (polygon.outline.empty() ? polygon.outline : polygon.holes.emplace_back()) = ring_of(ring);
      }
    }
  }
  std::vector<gis::Attribute> attributes;
  for (const auto& [name, values] : columns) {
    attributes.push_back({nb::cast<std::string>(name), nb::cast<decltype(gis::Attribute::values)>(values)});
  }
  gis::write_geopackage(file, {{layer, std::move(written), std::move(attributes)}}, crs);
}

void bind_map_files(nb::module_& module) {
  // Points from south to north.
  nb::class_<Raster>(module, "Raster")
      .def_ro("x", &Raster::x)
      .def_ro("y", &Raster::y)
      .def_ro("cell_x", &Raster::cell_x)
      .def_ro("cell_y", &Raster::cell_y)
      .def_ro("columns", &Raster::columns)
      .def_ro("rows", &Raster::rows)
      .def_ro("crs", &Raster::crs)
      .def_prop_ro("values", &values_of, nb::sig("def values(self) -> object"));
  nb::class_<gis::RasterFile>(module, "RasterFile")
      .def(nb::init<const std::string&, gis::Quantity>())
      .def_prop_ro("layout", &gis::RasterFile::layout)
      .def_prop_ro("warning", [](const gis::RasterFile& self) { return self.conversion().warning; })
      .def(
          "read",
          [](const gis::RasterFile& self, int first_column, int first_row, int columns, int rows) {
            return values_of(self.read_points({first_column, first_row, columns, rows}));
          },
          nb::sig("def read(self, first_column: int, first_row: int, columns: int, rows: int, /) -> object"));
  module.def("read_dem", [](const std::string& file, const std::string& crs) {
    std::vector<std::string> warnings;
    return std::pair(gis::DemFile({file, ""}, {crs, ""}, {0.0, ""}, warnings).read_own_points(), warnings);
  });
  module.def("read_polygons", &polygons_in,
             nb::sig("def read_polygons(file: str, crs: str, /) -> tuple[list[list[object]], list[str], list[str]]"));
  module.def("write_raster", [](const std::string& file, const Raster& layout,
                                const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& values,
                                const std::string& unit, const std::string& description) {
    Raster raster = layout;
    raster.values.assign(values.data(), values.data() + values.size());
    gis::write_geotiff(file, raster, {unit, description});
  });
  module.def("write_polygons", &write_polygons,
             nb::sig("def write_polygons(file: str, layer: str, features: object, columns: dict[str, list[float] | "
                     "list[str]], crs: str, /) -> None"));
  module.def("is_same_system", [](const std::string& one, const std::string& other) {
    return one.empty() == other.empty() && gis::Reprojection(one, other).changes_nothing();
  });
}

#endif

}  // namespace

void bind_files(nb::module_& module) {
  module.def("input_files", [](const config::Case& parameters) {
    std::vector<std::string> files;
    for (const auto& file : run::input_files(parameters)) {
      files.push_back(file.string());
    }
    return files;
  });
  nb::enum_<gis::Quantity>(module, "Quantity")
      .value("LENGTH", gis::Quantity::length)
      .value("SPEED", gis::Quantity::speed)
      .value("TIME", gis::Quantity::time);
#ifdef THAWSLIDE_WITH_GIS
  bind_map_files(module);
#endif
}

}  // namespace thawslide::python
