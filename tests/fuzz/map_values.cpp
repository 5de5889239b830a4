// Contents of maps: the input specifies layout, values, reference systems and geometry of small files, and their keys.
#include "gis/site.hpp"
#include "map_files.hpp"

namespace {

using namespace thawslide;
using fuzz::Provider;

InitialField field_from(Provider& bytes, const std::string& raster) {
  InitialField field;
  if (fuzz::chance(bytes, 2)) {
    field.over = InitialField::Over::raster;
    field.source = raster;
  } else {
    field.over = InitialField::Over::attribute;
    field.source = fuzz::chance(bytes, 8) ? "none" : "warm";
  }
  return field;
}

config::Body body_from(Provider& bytes, const std::string& name, const std::string& thickness_file) {
  config::Body body;
  body.shape = config::BodyShape::release;
  body.largest_volume = 1e12;
  body.release = fuzz::chance(bytes, 8) ? "" : fuzz::features_from(bytes, name, false);
  body.thickness.from = static_cast<config::MapValue::From>(bytes.ConsumeIntegralInRange(0, 3));
  body.thickness.number = 5.0;
  body.thickness.source = body.thickness.from == config::MapValue::From::attribute ? "thickness" : thickness_file;
  // As in the checks of a case.
  const bool is_surface = body.thickness.from == config::MapValue::From::surface;
  if (!is_surface && fuzz::chance(bytes, 4)) {
    body.thickness_along = config::ThicknessAlong::normal;
  }
  if (!is_surface && fuzz::chance(bytes, 2)) {
    body.placement = config::Placement::cut;
  }
  body.taper = fuzz::chance(bytes, 4) ? bytes.ConsumeIntegralInRange(1, 60) : 0.0;
  if (fuzz::chance(bytes, 8)) {
    body.polygons = {"a"};
  }
  if (fuzz::chance(bytes, 4)) {
    body.temperature = field_from(bytes, thickness_file);
  }
  return body;
}

config::Case case_from(Provider& bytes) {
  config::Case made;
  made.file = "case.toml";
  made.general.dimension = 3;
  made.terrain.kind = config::TerrainKind::dem;
  made.terrain.file = fuzz::raster_from(bytes, "dem.tif", 1000.0, 1100.0);
  made.terrain.resample = fuzz::chance(bytes, 8) ? bytes.ConsumeIntegralInRange(1, 40) : 0.0;
  made.terrain.smooth.is_auto = fuzz::chance(bytes, 2);
  made.terrain.smooth.number = fuzz::chance(bytes, 4) ? bytes.ConsumeIntegralInRange(1, 40) : 0.0;
  made.terrain.crs = fuzz::chance(bytes, 8) ? "EPSG:31287" : "";
  made.grid.cell = bytes.ConsumeIntegralInRange(1, 20);
  made.grid.min = {fuzz::west + bytes.ConsumeIntegralInRange(-1, 6) * 10.0,
                   fuzz::south + bytes.ConsumeIntegralInRange(-1, 6) * 10.0, 500.0};
  made.grid.max = {made.grid.min[0] + bytes.ConsumeIntegralInRange(1, 12) * 10.0,
                   made.grid.min[1] + bytes.ConsumeIntegralInRange(1, 12) * 10.0, 2500.0};
  const bool has_map = fuzz::chance(bytes, 2);
  const std::string map = has_map ? fuzz::raster_from(bytes, "map.tif", 0.0, 20.0) : made.terrain.file;
  for (int left = bytes.ConsumeIntegralInRange(0, 2); left > 0; --left) {
    const std::string name = left == 1 ? "one" : "two";
    made.bodies[name] = body_from(bytes, name, map);
  }
  if (fuzz::chance(bytes, 4)) {
    config::Substrate& substrate = made.substrates["ice"];
    substrate.code = bytes.ConsumeIntegralInRange(0, 2);
    (fuzz::chance(bytes, 2) ? substrate.raster : substrate.outline) =
        substrate.outline.empty() && has_map ? map : fuzz::features_from(bytes, "ice", false);
  }
  if (fuzz::chance(bytes, 4)) {
    made.bed.law = static_cast<config::BedLaw>(1);
    made.bed.depth = field_from(bytes, map);
  }
  if (fuzz::chance(bytes, 4)) {
    made.maps.path = fuzz::features_from(bytes, "path", true);
    made.probes["gauge"].line = made.maps.path;
  }
  return made;
}

bool fits(const Raster& raster) {
  return raster.columns > 0 && raster.rows > 0 &&
         raster.values.size() == static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows);
}

// Assumptions of the simulation.
void check(const config::Site& site) {
  if (site.ground == nullptr || !fits(*site.ground)) {
    fuzz::fail("a terrain whose values do not fit its size");
  }
  for (const auto& [name, release] : site.releases) {
    for (const double thickness : release.thickness.values) {
      if (!fits(release.thickness) || !(thickness >= 0.0 && std::isfinite(thickness))) {
        fuzz::fail("a thickness that is none");
      }
    }
    for (const config::Polyline2& ring : release.outlines) {
      if (ring.size() < 4 || ring.front() != ring.back()) {
        fuzz::fail("an outline that does not close");
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  fuzz::prepare_gdal();
  Provider bytes(data, size);
  const config::Case parameters = case_from(bytes);
  // A message names the case file or the map.
  fuzz::gives_value("", [&] { check(gis::load_site(parameters).site); });
  VSIRmdirRecursive(fuzz::memory.c_str());
  return 0;
}
