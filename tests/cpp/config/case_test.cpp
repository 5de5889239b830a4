// A case as read: values of the file, and defaults for all other keys.
#include <cmath>
#include <map>
#include <set>

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

// Values of Tables 1 to 3 of the paper, and the interpretations of it chosen in Thawslide.
TEST(CaseFile, DefaultsAreThoseOfThePaper) {
  const Case found = case_from_text(valid_case);
  EXPECT_EQ(found.phases.rock_density, 2750.0);
  EXPECT_EQ(found.phases.ice_density, 917.0);
  EXPECT_EQ(found.phases.latent_heat, 333.5e3);
  EXPECT_EQ(found.phases.ice_to_rock_density_ratio, 1.0 / 3.0);
  EXPECT_EQ(found.freezing.curve, CurveKind::power_law);
  EXPECT_EQ(found.freezing.exponent, 5.0);
  EXPECT_EQ(found.basal.friction, "lubricated");
  EXPECT_EQ(found.basal.numbers(physics::basal::lubrication_exponent), 2.0);
  EXPECT_EQ(found.basal.numbers(physics::basal::min_solid_fraction), 0.05);
  EXPECT_EQ(found.basal.numbers(physics::basal::max_solid_fraction), 0.85);
  EXPECT_EQ(found.basal.cohesion_law, "slip");
  EXPECT_EQ(found.basal.numbers(physics::basal::initial_cohesion), 0.0);
  EXPECT_EQ(found.basal.numbers(physics::basal::residual_cohesion), 0.0);
  EXPECT_EQ(found.basal.clamp, FrictionClamp::keep_cohesion);
  EXPECT_EQ(found.pressure.clapeyron, ClapeyronSign::usual);
  EXPECT_EQ(found.mechanics.shape_function, ShapeFunction::ugimp);
  EXPECT_EQ(found.bed.law, BedLaw::none);
  EXPECT_EQ(found.bed.friction_angle, 0.0);
  EXPECT_EQ(found.bed.temperature, -10.0);
  EXPECT_EQ(found.bed.porosity, 0.9);
  EXPECT_EQ(found.bed.particles_per_axis, 2);
  EXPECT_EQ(found.mechanics.transfer, Transfer::flip);
  EXPECT_EQ(found.mechanics.fmpm_order, 2);
  EXPECT_EQ(found.bodies.at("block").porosity.at(0.0, 0.0), 0.375);
}

// The defaults differ from the published formulation if the latter creates heat or water, or allows pore pressure above
// the load.
TEST(CaseFile, DefaultsOfTheBaseConserveHeatAndWater) {
  const Case found = case_from_text(valid_case);
  EXPECT_EQ(found.band.model, BandKind::scaled) << "no band";
  EXPECT_EQ(found.phases.water_expansion_law, WaterExpansionLaw::by_temperature);
  EXPECT_EQ(found.pressure.frozen, FrozenPressure::none);
  EXPECT_TRUE(std::isinf(found.pressure.residual_stress));
  EXPECT_TRUE(found.pressure.melt_contraction);
  EXPECT_EQ(found.pressure.skeleton_compressibility, 2e-9);
  EXPECT_EQ(found.pressure.frozen_rows, FrozenRows::sealed);
  EXPECT_EQ(found.band.thickness_change, ThicknessChange::conserving);
  EXPECT_EQ(found.heat.advection_form, AdvectionForm::conservative);
  EXPECT_TRUE(found.materials.at("rock").gaps_close_first);
  EXPECT_TRUE(found.block.bends);
}

TEST(CaseFile, UsesBandColumnsIfThereIsABase) {
  const std::string with_band = changed({{"[basal]", "[band]\nthickness = 0.1\n[basal]"}});
  EXPECT_EQ(case_from_text(with_band).band.model, BandKind::columns);
  for (const char* without :
       {"terrain.type=none", "heat.enabled=false", "mechanics.enabled=false", "band.model=scaled"}) {
    EXPECT_EQ(case_from_text(with_band, {without}).band.model, BandKind::scaled) << without;
  }
}

TEST(CaseFile, DefaultsOfTheReferenceAreThoseApplied) {
  write_map_files();
  const std::string wall = "[frame.wall]\nmin = [90.0, 0.0]\nmax = [95.0, 5.0]\naxis = \"x\"\nvelocity = 0.0\n";
  const std::set<std::string> given{"case.dimension", "terrain.type", "material.law", "body.shape", "bed.law"};
  const std::string noise = "[initial]\nnoise = 0.1\n", splitting = "[mechanics]\nsplit_stretched = true\n";
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
        valid_case + bed, valid_case + columns, valid_case + columns + growth, valid_case_on_dem, of_surface, resting,
        valid_case_on_dem + ice + "outline = \"release.geojson\"\n",
        valid_case_on_dem + bed + "outline = \"release.geojson\"\n"}) {
    const Case found = case_from_text(text);
    const std::string before = without_marks(resolved_toml(found, "inputs"));
    for (const auto& table : tables()) {
      const std::vector<std::string> names = table->is_named() ? table->names(found) : std::vector<std::string>{""};
      for (const Entry& entry : table->entries()) {
        const std::string key = table->name + "." + entry.rule->key;
        const bool is_given = (key == "initial.noise" && text.find(noise) != std::string::npos) ||
                              (key == "mechanics.split_stretched" && text.find(splitting) != std::string::npos) ||
                              (key == "band.growth" && text.find(growth) != std::string::npos) ||
                              (key == "report.force_record" && text.find(record) != std::string::npos);
        if (entry.default_text.empty() || given.count(key) > 0 || is_given || names.empty()) {
          continue;
        }
        const std::string own_name = names[0].empty() ? "" : "." + names[0];
        const std::string set = table->name + own_name + "." + entry.rule->key + "=" + entry.default_text;
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
