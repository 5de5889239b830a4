// Units of rasters: known ones are converted, unknown ones are refused.
#include "base/raster.hpp"
#include "gis/raster_file.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

double computed(const std::string& unit, Quantity quantity, double stated) {
  const UnitConversion conversion = conversion_from({"folder/map.tif", unit, "", 1.0}, quantity);
  return conversion.factor * stated + conversion.offset;
}

std::string error_of_unit(const StatedUnits& stated, Quantity quantity) {
  return error_of([&] { static_cast<void>(conversion_from(stated, quantity)); });
}

TEST(ValueUnitTest, LengthsInEverySpellingAreMetres) {
  const std::vector<std::pair<double, std::vector<const char*>>> units{
      {1.0, {"", "m", "Metre", "meters", "[m]", "m a.s.l.", "unknown"}},
      {0.001, {"mm"}},
      {0.01, {"cm", "CM", "centimetre"}},
      {0.1, {"dm"}},
      {1000.0, {"km"}},
      {0.0254, {"in"}},
      {0.3048, {"ft", "feet", "Foot"}},
      {0.9144, {"yd"}},
      {1200.0 / 3937.0, {"US survey foot", "us-ft", "ftUS", "US_survey_foot", "Foot_US"}}};
  for (const auto& [metres, names] : units) {
    for (const char* unit : names) {
      EXPECT_NEAR(computed(unit, Quantity::length, 50.0), 50.0 * metres, 1e-12) << unit;
      const std::string warning = conversion_from({"folder/map.tif", unit, "", 1.0}, Quantity::length).warning;
      EXPECT_EQ(warning,
                metres == 1.0
                    ? ""
                    : fmt::format("note: map.tif states the unit '{}': its values were converted to metres", unit));
    }
  }
}

TEST(ValueUnitTest, TemperaturesAndFractionsAreConverted) {
  for (const char* unit : {"", "C", "°C", "degC", "Celsius"}) {
    EXPECT_EQ(computed(unit, Quantity::temperature, -5.0), -5.0) << unit;
  }
  for (const char* unit : {"K", "kelvin", "Kelvin"}) {
    EXPECT_NEAR(computed(unit, Quantity::temperature, 273.15), 0.0, 1e-12) << unit;
  }
  for (const char* unit : {"F", "°F", "degF", "Fahrenheit"}) {
    EXPECT_NEAR(computed(unit, Quantity::temperature, 32.0), 0.0, 1e-12) << unit;
    EXPECT_NEAR(computed(unit, Quantity::temperature, 23.0), -5.0, 1e-12) << unit;
  }
  EXPECT_NEAR(computed("%", Quantity::fraction, 30.0), 0.3, 1e-15);
  EXPECT_EQ(computed("1", Quantity::fraction, 0.3), 0.3);
  EXPECT_EQ(computed("whatever", Quantity::code, 7.0), 7.0);
  EXPECT_EQ(conversion_from({"map.tif", "K", "", 1.0}, Quantity::temperature).warning,
            "note: map.tif states the unit 'K': its values were converted to degrees Celsius");
}

TEST(ValueUnitTest, UnknownUnitsAndThoseOfAnotherQuantityAreRefused) {
  expect_message(error_of_unit({"map.tif", "furlong", "", 1.0}, Quantity::length));
  expect_message(error_of_unit({"map.tif", "m", "", 1.0}, Quantity::temperature));
  expect_message(error_of_unit({"map.tif", "kg", "", 1.0}, Quantity::fraction));
}

// GDAL assigns the unit of heights of its reference system to a band without a unit, whatever the band's quantity.
TEST(ValueUnitTest, HeightUnitOfTheReferenceSystemAppliesToLengthsOnly) {
  const StatedUnits heights{"map.tif", "US survey foot", "US survey foot", 1200.0 / 3937.0};
  EXPECT_NEAR(conversion_from(heights, Quantity::length).factor, 1200.0 / 3937.0, 1e-15);
  EXPECT_EQ(conversion_from(heights, Quantity::temperature).factor, 1.0);
  EXPECT_EQ(conversion_from(heights, Quantity::fraction).factor, 1.0);
  EXPECT_NEAR(conversion_from({"map.tif", "", "clarke's foot", 0.3047972654}, Quantity::length).factor, 0.3047972654,
              1e-15);
  EXPECT_EQ(conversion_from({"map.tif", "cm", "", 1.0}, Quantity::length).factor, 0.01);
  expect_message(error_of_unit({"map.tif", "m", "US survey foot", 1200.0 / 3937.0}, Quantity::length));
}

TEST(ValueUnitTest, UnitIsThatOfTheScaledValues) {
  const std::string file = scaled(foreign("map.tif", {.type = GDT_Int16, .unit = "cm"}), 10.0, 500.0);
  EXPECT_NEAR(RasterFile(file, Quantity::length).read().at(0, 2), 0.01 * (10.0 * 1.0 + 500.0), 1e-12);
  scaled(file, 0.0, 0.0);
  expect_message(error_of([&] { return RasterFile(file, Quantity::length).layout(); }));
}

std::string write_in_unit(const std::string& file, Raster raster, double per_metre, const std::string& unit) {
  for (double& value : raster.values) {
    value *= per_metre;
  }
  write_geotiff(in_folder(file), raster, {unit, "values"});
  return in_folder(file);
}

Raster square(const std::string& crs = "EPSG:31287") {
  const auto thickness = [](double x, double y) {
    return std::abs(x - west - 350.0) < 50.0 && std::abs(y - south - 350.0) < 50.0 ? 8 : 0;
  };
  return raster_of(thickness, west, south, 5.0, 201, 161, crs);
}

// The release is the same for all units of the ground and the thickness.
TEST(ValueUnitTest, VolumesAreTheSameInEveryUnit) {
  const Raster thickness = square();
  for (const auto& [unit, metres] : {std::pair("ft", 0.3048), {"cm", 0.01}, {"dm", 0.1}, {"km", 1000.0}}) {
    const config::Case parameters = case_with_raster(thickness);
    write_in_unit("dem.tif", ground(), 1.0 / metres, unit);
    write_in_unit("thickness.tif", thickness, 1.0 / metres, unit);
    const SiteAndWarnings loaded = load_site(parameters);
    EXPECT_NEAR(volume_of(loaded.site.releases.at("rock").thickness), volume_of(thickness), 1e-6) << unit;
    EXPECT_NEAR(bilinear(*loaded.site.ground, west + 400.0, south + 400.0, Missing::unknown), 1700.0, 1e-6) << unit;
    EXPECT_EQ(loaded.warnings,
              (std::vector<std::string>{
                  fmt::format("note: dem.tif states the unit '{}': its values were converted to metres", unit),
                  fmt::format("note: thickness.tif states the unit '{}': its values were converted to metres", unit)}));
    std::filesystem::remove(in_folder("thickness.tif"));
  }
}

TEST(ValueUnitTest, CompoundSystemsUseTheirHorizontalPart) {
  const Raster thickness = square("EPSG:31287+6360");
  const config::Case parameters = case_with_raster(thickness);
  write_in_unit("thickness.tif", thickness, 3937.0 / 1200.0, "");
  const SiteAndWarnings loaded = load_site(parameters);
  EXPECT_NEAR(volume_of(loaded.site.releases.at("rock").thickness), volume_of(thickness), 1e-6);
  EXPECT_EQ(loaded.warnings,
            std::vector<std::string>{"note: thickness.tif states the unit 'US survey foot': its values were "
                                     "converted to metres"});
}

TEST(ValueUnitTest, UnitOfAnotherQuantityIsReportedAtTheKey) {
  config::Case parameters = case_with_release({{"", box_at(250, 250, 450, 450)}});
  parameters.locations["body.rock.temperature"] = "case.toml:11:3";
  parameters.bodies.at("rock").temperature = raster_field(write_in_unit("temperature.tif", ground(), 1.0, "m"));
  expect_message(error_of_site(parameters));
}

}  // namespace
}  // namespace thawslide::gis
