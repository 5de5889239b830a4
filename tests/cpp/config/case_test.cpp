// A case as read: values of the file, and defaults for all other keys.
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "case_messages.hpp"
#include "config/declaration.hpp"
#include "config/describe.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;
using testing_support::case_from_text;

// `valid_case`, constructed from member initializers.
Case valid_case_from_initializers() {
  Case expected;
  expected.time.end = 2.0;
  expected.time.step = 0.001;
  expected.grid.cell = 5.0;
  expected.grid.min = {0.0, -10.0, 0.0};
  expected.grid.max = {100.0, 50.0, 0.0};
  expected.terrain.kind = TerrainKind::flat;
  Material& rock = expected.materials["rock"];
  rock.law = LawKind::elastic;
  rock.youngs_modulus = 5e8;
  rock.poisson_ratio = 0.2;
  Body& block = expected.bodies["block"];
  block.material = "rock";
  block.max = {40.0, 20.0, 0.0};
  expected.basal.numbers[physics::basal::friction_angle] = 20.0;
  return expected;
}

TEST(CaseFile, UsesMemberInitialisersForKeysNotGiven) {
  const Case found = case_from_text(valid_case);
  EXPECT_EQ(without_marks(resolved_toml(found, "inputs")),
            without_marks(resolved_toml(valid_case_from_initializers(), "inputs")));
  // Keys that the resolved case omits if they are not given.
  EXPECT_EQ(found.mechanics.k0, Mechanics{}.k0);
  EXPECT_FALSE(found.band.thickness.is_given());
  EXPECT_TRUE(found.terrain.file.empty());
  EXPECT_TRUE(std::isinf(found.materials.at("rock").tension_cutoff));
}

// Default of a key in the reference, which DefaultsOfTheReferenceAreThoseApplied compares with the one applied.
std::string default_of(const std::string& key) {
  for (const auto& table : tables()) {
    for (const Entry& entry : table->entries()) {
      if (table->name + "." + entry.rule->key == key) {
        return entry.default_text;
      }
    }
  }
  return "no key";
}

// Values of Tables 1 to 3 of the paper, and the interpretations of it chosen in Thawslide. The defaults of the base
// differ from the published formulation if the latter creates heat or water, or allows pore pressure above the load.
TEST(CaseFile, DefaultsAreThoseOfThePaperButConserveHeatAndWater) {
  const std::string of_paper = R"(
phases.rock_density = 2750.0 | phases.ice_density = 917.0 | phases.latent_heat = 333500.0 | freezing.exponent = 5.0
freezing.curve = "power_law" | basal.friction = "lubricated" | basal.cohesion_law = "slip" | basal.cohesion = 0.0
basal.lubrication_exponent = 2.0 | basal.min_solid_fraction = 0.05 | basal.max_solid_fraction = 0.85
basal.residual_cohesion = 0.0 | basal.clamp = "keep_cohesion" | body.porosity = 0.375
mechanics.shape_function = "ugimp" | mechanics.transfer = "flip" | mechanics.fmpm_order = 2 | bed.friction_angle = 0.0
bed.temperature = -10.0 | bed.porosity = 0.9 | bed.particles_per_axis = 2)";
  const std::string conserving = R"(
phases.water_expansion_law = "by_temperature" | pressure.frozen = "none" | pressure.residual_stress = inf
pressure.melt_contraction = true | pressure.skeleton_compressibility = 2e-09 | pressure.frozen_rows = "sealed"
band.thickness_change = "conserving" | heat.advection_form = "conservative" | material.gaps_close_first = true
block.bends = true)";
  const std::string of_maps = R"(
terrain.crs = "" | terrain.resample = 0.0 | terrain.smooth = "auto" | grid.leaving = "stop" | body.polygons = []
body.name_attribute = "name" | body.thickness_along = "vertical" | body.placement = "on_top" | body.taper = 0.0
body.largest_volume = 200000000.0 | maps.cell = 0.0 | maps.arrival_thickness = 0.1 | maps.path = "")";
  std::istringstream lines(replaced((of_paper + conserving + of_maps).substr(1), " | ", "\n"));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find(" = ");
    EXPECT_EQ(default_of(line.substr(0, equals)), line.substr(equals + 3)) << line;
  }
  const Case found = case_from_text(valid_case);
  EXPECT_EQ(found.phases.ice_to_rock_density_ratio, 1.0 / 3.0);
  EXPECT_EQ(found.bed.law, BedLaw::none);
  EXPECT_EQ(found.band.model, BandKind::scaled) << "no band";
}

TEST(CaseFile, UsesBandColumnsIfThereIsABase) {
  const std::string with_band = changed({{"[basal]", "[band]\nthickness = 0.1\n[basal]"}});
  EXPECT_EQ(case_from_text(with_band).band.model, BandKind::columns);
  for (const char* without :
       {"terrain.type=none", "heat.enabled=false", "mechanics.enabled=false", "band.model=scaled"}) {
    EXPECT_EQ(case_from_text(with_band, {without}).band.model, BandKind::scaled) << without;
  }
}

// First table of a kind with names in the case, such as "body.block"; empty if there is none.
std::string first_table(const Case& parameters, const std::string& kind) {
  const auto found = parameters.locations.lower_bound(kind + ".");
  const bool is_there = found != parameters.locations.end() && found->first.starts_with(kind + ".");
  return is_there ? found->first.substr(0, found->first.find('.', kind.size() + 1)) : "";
}

TEST(CaseFile, DefaultsOfTheReferenceAreThoseApplied) {
  write_map_files();
  const std::string wall = "[frame.wall]\nmin = [90.0, 0.0]\nmax = [95.0, 5.0]\naxis = \"x\"\nvelocity = 0.0\n";
  const std::set<std::string> given{"case.dimension", "terrain.type", "material.law", "body.shape", "bed.law"};
  const std::string noise = "[initial]\nnoise = 0.1\n", splitting = "[mechanics]\nsplit_stretched = true\n";
  const std::string filtered = "[mechanics]\ntransfer = \"fmpm\"\nfmpm_interval = 0.1\n";
  const std::string plane = changed({{"type = \"flat\"", "type = \"plane\""}});
  const std::string columns = "[band]\nthickness = 0.5\n", growth = "growth = \"inertial\"\n";
  std::map<std::string, bool> in_force;  // whether the default of a key has an effect in one of the cases
  std::string of_surface = valid_case_on_dem;
  const std::string number = "thickness = 10.0";
  of_surface.replace(of_surface.find(number), number.size(), "thickness = { surface = \"map.tif\" }");
  const std::string bed =
      "[bed]\nlaw = \"momentum\"\ndepth = 2.0\nstrength = 0.0\ndepth_per_slip = 0.5\nmaterial = \"rock\"\n";
  const std::string ice = "[substrate.ice]\nfriction_angle = 5.0\n";
  const std::string resting = changed({{"step = 0.001", "step = 0.001\nstop_at_rest = 0.1"}});
  write_next_to_the_case("force.csv", "time_s,up_N,north_N,east_N\n0,0,0,0\n1,0,0,0\n");
  const std::string record = "[report]\nforce_record = \"force.csv\"\nforce_periods = [10.0, 200.0]\n";
  for (const std::string& text :
       {valid_case + record, valid_case + wall + ice + "x_min = 50.0\n", valid_case + noise, valid_case + splitting,
        valid_case + filtered, plane, valid_case + bed, valid_case + columns, valid_case + columns + growth,
        valid_case_on_dem, of_surface, resting, valid_case_on_dem + ice + "outline = \"release.geojson\"\n",
        valid_case_on_dem + bed + "outline = \"release.geojson\"\n"}) {
    const Case found = case_from_text(text);
    const std::string before = without_marks(resolved_toml(found, "inputs"));
    for (const auto& table : tables()) {
      const std::string name = table->is_named() ? first_table(found, table->name) : table->name;
      for (const Entry& entry : table->entries()) {
        const std::string key = table->name + "." + entry.rule->key;
        const bool is_given = (key == "initial.noise" && text.find(noise) != std::string::npos) ||
                              (key == "mechanics.split_stretched" && text.find(splitting) != std::string::npos) ||
                              (key == "mechanics.transfer" && text.find(filtered) != std::string::npos) ||
                              (key == "band.growth" && text.find(growth) != std::string::npos) ||
                              (key == "report.force_record" && text.find(record) != std::string::npos);
        if (entry.default_text.empty() || given.count(key) > 0 || is_given || name.empty()) {
          continue;
        }
        const std::string set = name + "." + entry.rule->key + "=" + entry.default_text;
        // The reference describes points by two numbers.
        const std::string error = error_of_text(text, {set});
        const bool has_meaning = error.find("has a meaning only") == std::string::npos &&
                                 error.find("as case.dimension is 3") == std::string::npos;
        in_force[key] = in_force[key] || has_meaning;
        if (has_meaning) {
          EXPECT_EQ(without_marks(resolved_toml(case_from_text(text, {set}), "inputs")), before) << key;
        }
      }
    }
  }
  EXPECT_GT(in_force.size(), 80U);
  for (const auto& [key, is_tested] : in_force) {
    EXPECT_TRUE(is_tested) << key;
  }
}

TEST(CaseFile, FillsInDependentKeys) {
  const Case found = case_from_text(changed(
      {{"step = 0.001", "stepping = \"adaptive\""}, {"law = \"elastic\"", "friction_angle = 30.0\ncohesion = 2e5"}}));
  EXPECT_EQ(found.time.step, 2.0) << "no limit except the end";
  EXPECT_EQ(found.materials.at("rock").residual_cohesion, 2e5) << "no softening";
  EXPECT_EQ(found.materials.at("rock").residual_friction_angle, 30.0) << "no softening";
}

TEST(CaseFile, IsNamedByItsFolder) {
  const Case found = case_from_text(valid_case);
  EXPECT_EQ(found.name, "CaseFile.IsNamedByItsFolder");
  EXPECT_EQ(found.file, (folder_of_this_test() / "case.toml").string());
}

}  // namespace
}  // namespace thawslide::config
