// Valid map files and profiles in unusual but correct forms: their result must equal that of the plain form.
#include "map_forms.hpp"

#include "config/profile_csv.hpp"
#include "gis/site.hpp"

namespace {

using namespace thawslide;
using fuzz::Provider;

// Contents of the files of a case, in multiples that every form can store exactly.
struct Contents {
  fuzz::Grid ground, thickness, temperature, bed, codes;
  std::vector<fuzz::Area> release, ice;
  std::vector<std::array<double, 2>> path;
  bool thickness_of_raster, codes_of_raster, selects_name;
};

Contents contents_from(Provider& bytes) {
  Contents made{fuzz::grid_from(bytes, 1000.0, 0.5),
                fuzz::grid_from(bytes, 0.0, 0.5),
                fuzz::grid_from(bytes, -20.0, 0.0625),
                fuzz::grid_from(bytes, 0.0, 0.03125),
                fuzz::grid_from(bytes, 0.0, 1.0),
                fuzz::areas_from(bytes),
                fuzz::areas_from(bytes),
                {},
                bytes.ConsumeBool(),
                bytes.ConsumeBool(),
                bytes.ConsumeBool()};
  for (double& code : made.codes.values) {
    code = std::fmod(code, 3.0);
  }
  for (int k = 0; k < 3; ++k) {
    made.path.push_back({fuzz::west + 30.0 + 40.0 * k, fuzz::south + bytes.ConsumeIntegralInRange(30, 120)});
  }
  return made;
}

// Case with its files in plain or, with bytes, in other forms.
config::Case case_of(const Contents& contents, Provider* forms) {
  using gis::Quantity;
  config::Case made;
  made.file = "case.toml";
  made.general.dimension = 3;
  made.terrain.kind = config::TerrainKind::dem;
  made.terrain.smooth = {.is_auto = false};
  made.terrain.file = fuzz::write_grid(contents.ground, "dem", Quantity::length, forms);
  made.grid.cell = 10.0;
  made.grid.min = {fuzz::west + 20.0, fuzz::south + 20.0, 500.0};
  made.grid.max = {fuzz::west + 140.0, fuzz::south + 140.0, 2500.0};
  config::Body& body = made.bodies["slide"];
  body.shape = config::BodyShape::release;
  body.largest_volume = 1e12;
  if (contents.thickness_of_raster) {
    body.thickness.from = config::MapValue::From::raster;
    body.thickness.source = fuzz::write_grid(contents.thickness, "thickness", Quantity::length, forms);
  } else {
    body.thickness.from = config::MapValue::From::attribute;
    body.thickness.source = "thickness";
  }
  body.release = fuzz::write_areas(contents.release, "release", !contents.thickness_of_raster, forms);
  if (contents.selects_name) {
    body.polygons = {fuzz::first_name};
  }
  body.temperature.over = InitialField::Over::raster;
  body.temperature.source = fuzz::write_grid(contents.temperature, "temperature", Quantity::temperature, forms);
  config::Substrate& ice = made.substrates["ice"];
  if (contents.codes_of_raster) {
    ice.raster = fuzz::write_grid(contents.codes, "codes", Quantity::code, forms);
    ice.code = 1;
  } else {
    ice.outline = fuzz::write_areas(contents.ice, "ice", false, forms);
  }
  made.bed.law = static_cast<config::BedLaw>(1);
  made.bed.depth.over = InitialField::Over::raster;
  made.bed.depth.source = fuzz::write_grid(contents.bed, "bed", Quantity::length, forms);
  made.maps.path = fuzz::write_line(contents.path, "path", forms);
  made.probes["gauge"].line = made.maps.path;
  return made;
}

// Sums of a raster and of its moments, whatever points without a value surround it.
std::array<double, 3> sums_of(const Raster& raster) {
  std::array<double, 3> sums{};
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const double value = raster.at(column, row);
      if (!std::isnan(value)) {
        sums[0] += value;
        sums[1] += value * (raster.x_of(column) - fuzz::west) / fuzz::wide;
        sums[2] += value * (raster.y_of(row) - fuzz::south) / fuzz::wide;
      }
    }
  }
  return sums;
}

// Numbers of a site that its files determine, by name.
std::map<std::string, double> numbers_of(const config::Site& site) {
  std::map<std::string, double> numbers;
  const auto add_raster = [&](const std::string& name, const Raster& raster) {
    const std::array<double, 3> sums = sums_of(raster);
    numbers[name] = sums[0];
    numbers[name + ", moment along x"] = sums[1];
    numbers[name + ", moment along y"] = sums[2];
  };
  const auto add_line = [&](const std::string& name, const config::Polyline2& line) {
    for (std::size_t k = 0; k < line.size(); ++k) {
      numbers[fmt::format("{}, x{}", name, k)] = line[k][0] - fuzz::west;
      numbers[fmt::format("{}, y{}", name, k)] = line[k][1] - fuzz::south;
    }
  };
  add_raster("ground", *site.ground);
  add_raster("bed", site.bed_depth);
  for (const auto& [name, release] : site.releases) {
    add_raster("thickness", release.thickness);
    Raster weighted = release.fields.at("temperature");
    for (std::size_t k = 0; k < weighted.values.size(); ++k) {
      weighted.values[k] *= release.thickness.values[k];
    }
    add_raster("temperature", weighted);
    numbers["area of the release"] = release.area;
  }
  for (const auto& [name, ice] : site.substrates) {
    numbers["area of the ice"] = ice.area;
    if (ice.codes != nullptr) {
      add_raster("codes", *ice.codes);
    }
  }
  add_line("path", site.path);
  add_line("probe", site.probes.at("gauge"));
  return numbers;
}

// Coordinates in degrees differ by half a millimetre after the transformation and its inverse, which changes values at
// points by up to 1e-4 of their differences to the next point.
void compare(const std::map<std::string, double>& plain, const std::map<std::string, double>& found) {
  for (const auto& [name, number] : plain) {
    const auto other = found.find(name);
    if (other == found.end() || !(std::abs(other->second - number) <= 1e-4 * std::max(100.0, std::abs(number)))) {
      fuzz::fail(fmt::format("{} is {} in another form, not {}", name,
                             other == found.end() ? "absent" : fmt::format("{}", other->second), number));
    }
  }
  if (plain.size() != found.size()) {
    fuzz::fail("more numbers in another form");
  }
}

void compare_profiles(Provider& bytes) {
  std::vector<std::array<double, 3>> rows;
  for (int left = bytes.ConsumeIntegralInRange(2, 6); left > 0; --left) {
    const double x = rows.empty() ? 0.0 : rows.back()[0] + bytes.ConsumeIntegralInRange(1, 800) / 8.0;
    const double z = bytes.ConsumeIntegralInRange(-800, 8000) / 8.0;
    rows.push_back({x, z, z + bytes.ConsumeIntegralInRange(0, 400) / 8.0});
  }
  const auto plain = config::read_profile(fuzz::write("plain.csv", fuzz::profile_text(rows, nullptr)));
  const auto other = config::read_profile(fuzz::write("other.csv", fuzz::profile_text(rows, &bytes)));
  if (plain.distance != other.distance || plain.terrain != other.terrain || plain.surface != other.surface) {
    fuzz::fail("another form of a profile has other numbers");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  fuzz::prepare_gdal();
  Provider bytes(data, size);
  const Contents contents = contents_from(bytes);
  std::map<std::string, double> plain;
  const bool is_valid =
      fuzz::gives_value("", [&] { plain = numbers_of(gis::load_site(case_of(contents, nullptr)).site); });
  VSIRmdirRecursive(fuzz::memory.c_str());
  try {
    if (is_valid) {
      compare(plain, numbers_of(gis::load_site(case_of(contents, &bytes)).site));
    }
    compare_profiles(bytes);
  } catch (const UserError& error) {
    fuzz::fail(fmt::format("a valid file is refused: {}", error.what()));
  }
  VSIRmdirRecursive(fuzz::memory.c_str());
  return 0;
}
