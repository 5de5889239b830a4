// Bytes of a map file: the first selects its kind, the others are the file, or changes to a valid one. GDAL reads
// them first, therefore findings can be errors of GDAL.
#include <algorithm>
#include <memory>

#include "gis/raster_file.hpp"
#include "gis/reference_system.hpp"
#include "gis/vector_file.hpp"
#include "map_files.hpp"

namespace {

using namespace thawslide;
using fuzz::Provider;

constexpr std::size_t most_points = 1U << 22U;  // of a raster that is read completely

void read_raster(const std::string& file) {
  fuzz::gives_value(file, [&] {
    const gis::RasterFile raster(file, gis::Quantity::length);
    const Raster& layout = raster.layout();
    const gis::Rectangle corner{layout.x, layout.y, layout.x + 3.0 * layout.cell_x, layout.y + 3.0 * layout.cell_y};
    const bool small = static_cast<std::size_t>(layout.columns) * static_cast<std::size_t>(layout.rows) <= most_points;
    static_cast<void>(small ? raster.read() : raster.read(corner));
  });
}

void read_features(const std::string& file) {
  static const std::string ground = gis::reference_system_named("EPSG:31287");
  for (const auto& read : {gis::read_polygons, gis::read_lines}) {
    fuzz::gives_value(file, [&] { static_cast<void>(read(file, ground)); });
  }
}

std::string bytes_of(const std::string& file) {
  vsi_l_offset size = 0;
  const GByte* const bytes = VSIGetMemFileBuffer(file.c_str(), &size, FALSE);
  return bytes == nullptr ? "" : std::string(reinterpret_cast<const char*>(bytes), size);
}

// A layer of a square with attributes, as the driver writes it.
void write_layer(const char* driver, const std::string& file) {
  const GDALDatasetUniquePtr dataset(
      GetGDALDriverManager()->GetDriverByName(driver)->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference system;
  system.importFromEPSG(31287);
  OGRLayer& layer = *dataset->CreateLayer("area", &system, wkbPolygon, nullptr);
  OGRFieldDefn name("name", OFTString), thickness("thickness", OFTReal);
  layer.CreateField(&name);
  layer.CreateField(&thickness);
  const std::unique_ptr<OGRFeature> feature(OGRFeature::CreateFeature(layer.GetLayerDefn()));
  feature->SetField("name", "a");
  feature->SetField("thickness", 12.5);
  OGRGeometry* square = nullptr;
  OGRGeometryFactory::createFromWkt("POLYGON ((400000 300000,400100 300000,400100 300100,400000 300100,400000 300000))",
                                    &system, &square);
  feature->SetGeometryDirectly(square);
  static_cast<void>(layer.CreateFeature(feature.get()));
}

struct ValidFiles {
  std::string geopackage, shape, shape_index, shape_table, tiff, tiled;
};

const ValidFiles& valid_files() {
  static const ValidFiles made = [] {
    ValidFiles files;
    const std::string folder = fuzz::memory + "valid/";
    write_layer("GPKG", folder + "area.gpkg");
    write_layer("ESRI Shapefile", folder + "area.shp");
    files.geopackage = bytes_of(folder + "area.gpkg");
    files.shape = bytes_of(folder + "area.shp");
    files.shape_index = bytes_of(folder + "area.shx");
    files.shape_table = bytes_of(folder + "area.dbf");
    Raster raster;
    raster.x = fuzz::west;
    raster.y = fuzz::south;
    raster.columns = raster.rows = 8;
    raster.values.assign(64, 1000.0);
    raster.crs = gis::reference_system_named("EPSG:31287");
    gis::write_geotiff((fuzz::folder() / "tiled.tif").string(), raster, {"m", "elevation"});
    std::ifstream tiled(fuzz::folder() / "tiled.tif", std::ios::binary);
    files.tiled.assign(std::istreambuf_iterator<char>(tiled), {});
    Provider nothing(nullptr, 0);
    files.tiff = bytes_of(fuzz::raster_from(nothing, "valid/plain.tif", 1000.0, 1100.0));
    return files;
  }();
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  fuzz::prepare_gdal();
  if (size == 0) {
    return 0;
  }
  const ValidFiles& valid = valid_files();
  // The first byte, the file that it selects, a valid one whose bytes are changed (none: the input is the file), and
  // the reader.
  const struct {
    unsigned char letter;
    const char* name;
    const std::string* valid;
    void (*read)(const std::string&);
  } kinds[] = {{'t', "map.tif", nullptr, read_raster},        {'a', "map.asc", nullptr, read_raster},
               {'j', "area.geojson", nullptr, read_features}, {'p', "map.tif", &valid.tiff, read_raster},
               {'d', "map.tif", &valid.tiled, read_raster},   {'g', "area.gpkg", &valid.geopackage, read_features},
               {'s', "area.shp", &valid.shape, read_features}};
  const auto* kind =
      std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& k) { return k.letter == data[0]; });
  if (kind == std::end(kinds)) {
    return -1;
  }
  Provider bytes(data + 1, size - 1);
  if (kind->valid == &valid.shape) {
    fuzz::in_memory("area.shx", valid.shape_index);
    fuzz::in_memory("area.dbf", valid.shape_table);
  }
  kind->read(fuzz::in_memory(
      kind->name, kind->valid == nullptr ? bytes.ConsumeRemainingBytesAsString() : fuzz::changed(*kind->valid, bytes)));
  VSIRmdirRecursive(fuzz::memory.c_str());
  return 0;
}
