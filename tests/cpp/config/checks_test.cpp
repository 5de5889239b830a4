// Inconsistent values of a case: domain, bodies, terrain, profiles, materials. Messages are compared completely, with
// their location.
#include "case_messages.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

const Change plane{"type = \"flat\"\nelevation = 0.0", "type = \"plane\"\nelevation = 10.0\nslope = 45.0"};
const Change profile{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"profile.csv\""};
const Change surface{"shape = \"box\"\nmin = [0.0, 0.0]\nmax = [40.0, 20.0]", "shape = \"surface\""};
const std::string header = "distance_m,terrain_elevation_m\n";
const std::string header_with_surface = "distance_m,terrain_elevation_m,surface_elevation_m\n";

Change box(const std::string& min, const std::string& max) {
  return {"min = [0.0, 0.0]\nmax = [40.0, 20.0]", "min = " + min + "\nmax = " + max};
}
Change polygon(const std::string& vertices) {
  return {"shape = \"box\"\nmin = [0.0, 0.0]\nmax = [40.0, 20.0]", "shape = \"polygon\"\nvertices = " + vertices};
}

// Error for a body that extends below the terrain at a position.
std::string below(const std::string& place, const std::string& x, const std::string& height,
                  const std::string& ground) {
  return "FOLDER/case.toml:" + place + ": body.block is below the terrain: at x = " + x + " m its elevation is " +
         height + " m and the ground's " + ground +
         " m; allowed: on the ground or above it. Lift the body, or lower the terrain.";
}

TEST(Domain, IsAWholeNumberOfCells) {
  const std::string found = ": the domain is 101 m long along x, which is 20.2 cells of 5 m; allowed: a whole number. ";
  EXPECT_EQ(error_of_changed({{"max = [100.0, 50.0]", "max = [101.0, 50.0]"}}),
            "FOLDER/case.toml:7:7" + found + "Move grid.max along x to 100.")
      << "5.05 m fit x, and not the 60 m along y";
  EXPECT_EQ(error_of_changed({{"cell = 5.0", "cell = 0.1"}}), "no error") << "1000 cells but for rounding";
}

TEST(Domain, IsAWholeNumberOfCellsAndTheErrorNamesSetKeys) {
  EXPECT_EQ(error_of_text(valid_case, {"grid.cell=8", "grid.min=[0, -14]"}),
            "--set grid.cell=8: the domain is 100 m long along x, which is 12.5 cells of 8 m; allowed: a whole number. "
            "Move grid.max along x to 104.");
  EXPECT_EQ(error_of_text(valid_case, {"grid.min=[-1, -10]"}),
            "--set grid.min=[-1, -10]: the domain is 101 m long along x, which is 20.2 cells of 5 m; allowed: a whole "
            "number. Move grid.max along x to 99.");
  EXPECT_EQ(error_of_text(valid_case, {"grid.max=[101, 50]", "grid.cell=10"}),
            "--set grid.max=[101, 50]: the domain is 101 m long along x, which is 10.1 cells of 10 m; allowed: a whole "
            "number. Move grid.max along x to 100.");
}

TEST(Domain, GrowsToWholeCellsIfTheCellIsSet) {
  using testing_support::case_from_text;
  const Case padded = case_from_text(valid_case, {"grid.cell=8"});
  EXPECT_EQ(padded.grid.max, (Point{104.0, 54.0, 0.0}));
  EXPECT_EQ(padded.notes, (std::vector<std::string>{
                              "note: --set grid.cell=8: grid.max is [104, 54] for whole cells of 8 m, in place of "
                              "[100, 50]"}));
  const Case whole = case_from_text(valid_case, {"grid.cell=10"});
  EXPECT_EQ(whole.grid.max, (Point{100.0, 50.0, 0.0}));
  EXPECT_TRUE(whole.notes.empty());
}

// An interval shorter than a billionth of the run is probably unintended.
TEST(Intervals, AreLongerThanABillionthOfTheRun) {
  const auto expected_error = [](const std::string& set, const std::string& key, const std::string& or_none) {
    return "--set " + set + ": " + key +
           " is 1e-12 s, and the run of 2 s has 2e+12 times as much; allowed: 2e-09 s and more, 1,000,000,000 of them "
           "in the "
           "run" +
           or_none + ". Make it longer, or the run shorter.";
  };
  const std::string rows = "; 0: a row every step", none = "; 0: none by simulated time";
  for (const auto& [key, or_none] :
       {std::pair(std::string("time.output_interval"), std::string()),
        std::pair(std::string("time.history_interval"), rows), std::pair(std::string("checkpoint.interval"), none)}) {
    const std::string set = key + "=1e-12";
    EXPECT_EQ(error_of_text(valid_case, {set}), expected_error(set, key, or_none));
    EXPECT_EQ(error_of_text(valid_case, {key + "=2e-9"}), "no error");
  }
  EXPECT_EQ(error_of_text(valid_case, {"time.history_interval=0", "checkpoint.interval=0"}), "no error");
  EXPECT_NE(error_of_text(valid_case, {"time.end=1e300"}).find("--set time.end=1e300: time.output_interval is "),
            std::string::npos)
      << "the key that was given is named";
}

TEST(Domain, HasAnExtent) {
  EXPECT_EQ(
      error_of_changed({{"max = [100.0, 50.0]", "max = [100.0, -10.0]"}}),
      "FOLDER/case.toml:7:7: grid.max is -10 along y, not above grid.min, which is -10; give the domain a highest "
      "corner above its lowest one.");
  EXPECT_EQ(error_of_changed({{"cell = 5.0", "cell = 50.0"}}),
            "FOLDER/case.toml:5:8: grid.cell is 50 m, and the domain is 60 m long along y; allowed: at least 2 cells "
            "along each axis. Make the cell smaller or the domain larger.");
}

TEST(Domain, HasNoMoreCellsThanTheGridCanNumber) {
  EXPECT_EQ(
      error_of_changed({{"cell = 5.0", "cell = 1e-4"}}),
      "FOLDER/case.toml:5:8: grid.cell is 0.0001 m, and the domain is 100 m long along x: 1,000,000 cells; allowed: "
      "at most 500,000. Make the cell larger or the domain smaller.");
}

TEST(Domain, ContainsTheBody) {
  const std::string remedy =
      ", outside the domain, which is (0, -10) to (100, 50); move the body, or widen grid.min and grid.max.";
  EXPECT_EQ(error_of_changed({box("[0.0, 0.0]", "[140.0, 20.0]")}),
            "FOLDER/case.toml:19:7: body.block reaches from (0, 0) to (140, 20)" + remedy);
  EXPECT_EQ(error_of_changed({box("[0.0, 0.0]", "[40.0, 50.5]")}),
            "FOLDER/case.toml:19:7: body.block reaches from (0, 0) to (40, 50.5)" + remedy);
  EXPECT_EQ(error_of_changed({box("[-0.5, 0.0]", "[40.0, 20.0]")}),
            "FOLDER/case.toml:18:7: body.block reaches from (-0.5, 0) to (40, 20)" + remedy);
  EXPECT_EQ(
      error_of_text(valid_case, {"grid.max=[30, 50]"}),
      "--set grid.max=[30, 50]: body.block reaches from (0, 0) to (40, 20), outside the domain, which is (0, -10) "
      "to (30, 50); move the body, or widen grid.min and grid.max.");
  EXPECT_EQ(error_of_changed({polygon("[[-1, 0], [40, 0], [20, 30]]")}),
            "FOLDER/case.toml:18:12: body.block reaches from (-1, 0) to (40, 30)" + remedy);
  EXPECT_EQ(error_of_changed({box("[0.0, 0.0]", "[100.0, 50.0]")}), "no error") << "up to the sides";
  write_next_to_the_case("profile.csv", header_with_surface + "0,0,0\n50,0,60\n100,2,2\n");
  EXPECT_EQ(error_of_changed({profile, surface}),
            "FOLDER/case.toml:17:9: body.block reaches from (0, 0) to (100, 60)" + remedy)
      << "one row above the ground contains a body that thins out to its neighbours";
}

TEST(Bodies, HaveAnExtent) {
  EXPECT_EQ(error_of_changed({box("[0.0, 0.0]", "[0.0, 20.0]")}),
            "FOLDER/case.toml:19:7: body.block.max is (0, 20), not above body.block.min, which is (0, 0), in every "
            "direction; give the highest corner of the box.");
  EXPECT_EQ(error_of_changed({polygon("[[0, 0], [40, 0], [20, 0]]")}),
            "FOLDER/case.toml:18:12: body.block.vertices are 3 points that hold no area; allowed: at least 3 that are "
            "not on one line. Give the corners in order around the body.");
  EXPECT_EQ(error_of_changed({polygon("[[0.1, 0.1], [33.3, 33.3], [20.2, 20.2]]")}),
            "FOLDER/case.toml:18:12: body.block.vertices are 3 points that hold no area; allowed: at least 3 that are "
            "not on one line. Give the corners in order around the body.")
      << "an area at round-off level is zero";
  EXPECT_EQ(error_of_changed({polygon("[[0, 0], [40, 20], [40, 0], [0, 20]]")}),
            "FOLDER/case.toml:18:12: body.block.vertices make sides that cross: the one after vertex 1 and the one "
            "after vertex 3; allowed: corners in order around the body. Put them in order.");
  EXPECT_EQ(
      error_of_changed({polygon("[[0, 0], [40, 0]]")}),
      "FOLDER/case.toml:18:12: body.block.vertices is an array of 2; allowed: an array of at least 3 pairs [x, y] "
      "[m].");
  EXPECT_EQ(error_of_changed({polygon("[[0, 0], [40, 0, 3], [3, 4]]")}),
            "FOLDER/case.toml:18:21: body.block.vertices holds a vertex of 3 numbers; allowed: pairs [x, y].");
}

TEST(Bodies, AreNeeded) {
  const std::string without =
      valid_case.substr(0, valid_case.find("[body.block]")) + "[basal]\nfriction_angle = 20.0\n";
  const std::string message = "the case has no body; add a table [body.NAME] with its material and shape.";
  EXPECT_EQ(error_of_text(without), "FOLDER/case.toml: " + message);
  EXPECT_EQ(error_of_text(without + "[body]\n"), "FOLDER/case.toml:17:1: " + message);
}

TEST(Bodies, HaveAKnownMaterial) {
  const std::string start = "FOLDER/case.toml:16:12: body.block.material is ";
  EXPECT_EQ(error_of_changed({{"material = \"rock\"", "material = \"rok\""}}),
            start + "'rok', and there is no [material.rok]; did you mean 'rock'? Allowed: rock.");
  EXPECT_EQ(error_of_changed({{"material = \"rock\"", "material = \"granite\""}}),
            start + "'granite', and there is no [material.granite]. Allowed: rock.");
  EXPECT_EQ(error_of_changed({{"[material.rock]\nlaw = \"elastic\"\nyoungs_modulus = 5e8\npoisson_ratio = 0.2\n", ""}}),
            "FOLDER/case.toml:12:12: body.block.material is 'rock', and there is no [material.rock]. Allowed: none, as "
            "the case has no [material.NAME].");
}

TEST(BelowTerrain, BoxOnFlatGround) {
  EXPECT_EQ(error_of_changed({box("[0.0, -5.0]", "[40.0, 20.0]")}), below("18:7", "0", "-5", "0"));
  EXPECT_EQ(error_of_changed({box("[0.0, -0.006]", "[40.0, 20.0]")}), below("18:7", "0", "-0.006", "0"));
  EXPECT_EQ(error_of_changed({box("[0.0, -0.004]", "[40.0, 20.0]")}), "no error") << "a thousandth of a cell is 5 mm";
}

TEST(BelowTerrain, BoxOnAPlane) {
  EXPECT_EQ(error_of_changed({plane, box("[5.0, 3.0]", "[40.0, 20.0]")}), below("19:7", "5", "3", "5"));
  EXPECT_EQ(error_of_changed({plane, box("[5.0, 5.0]", "[40.0, 20.0]")}), "no error");
}

TEST(BelowTerrain, BoxOnAProfile) {
  write_next_to_the_case("profile.csv", header + "0,0\n20,5\n40,0\n100,0\n");
  EXPECT_EQ(error_of_changed({profile}), below("18:7", "20", "0", "5")) << "a hill between the box's ends";
  EXPECT_EQ(error_of_changed({profile, box("[10.0, 1.0]", "[15.0, 20.0]")}), below("18:7", "10", "1", "2.5"));
  EXPECT_EQ(error_of_changed({profile, box("[10.0, 5.0]", "[50.0, 20.0]")}), "no error");
}

TEST(BelowTerrain, PolygonOnFlatGround) {
  EXPECT_EQ(error_of_changed({polygon("[[0, 0], [40, -1], [40, 20]]")}), below("18:12", "40", "-1", "0"));
  EXPECT_EQ(error_of_changed({polygon("[[0, 0], [40, 0], [40, 20]]")}), "no error");
}

TEST(BelowTerrain, PolygonOnAPlane) {
  EXPECT_EQ(error_of_changed({plane, polygon("[[0, 11], [5, 4], [40, 20]]")}), below("19:12", "5", "4", "5"));
  EXPECT_EQ(error_of_changed({plane, polygon("[[0, 10], [5, 5], [40, 20]]")}), "no error");
}

TEST(BelowTerrain, PolygonOnAProfile) {
  write_next_to_the_case("profile.csv", header + "0,0\n20,5\n40,0\n100,0\n");
  EXPECT_EQ(error_of_changed({profile, polygon("[[10, 1], [40, 20], [0, 20]]")}), below("18:12", "10", "1", "2.5"));
  EXPECT_EQ(error_of_changed({profile, polygon("[[0, 0], [40, 4], [40, 20]]")}), below("18:12", "20", "2", "5"))
      << "a hill between two vertices on the ground";
  EXPECT_EQ(error_of_changed({profile, polygon("[[0, 0], [20, 5], [40, 0], [40, 20]]")}), "no error");
}

TEST(Profile, CoversTheDomain) {
  write_next_to_the_case("profile.csv", header + "0,0\n90,0\n");
  EXPECT_EQ(error_of_changed({profile}),
            "FOLDER/case.toml:10:8: the profile reaches from 0 to 90 m and the domain from 0 to 100 m; allowed: a "
            "profile that covers the domain. Set terrain.extend = true to continue its last gradients, or make the "
            "domain shorter.");
  EXPECT_EQ(error_of_changed({profile}, {"terrain.extend=true"}), "no error");
}

TEST(Profile, GivesTheSurfaceOfABody) {
  EXPECT_EQ(
      error_of_changed({surface}),
      "FOLDER/case.toml:17:9: body.block.shape is \"surface\", and terrain.type is not \"profile\"; that shape "
      "takes the body from the profile's surface_elevation_m. Set terrain.type and terrain.file, or use the shape "
      "\"box\" or \"polygon\".");
  write_next_to_the_case("profile.csv", header + "0,0\n100,2\n");
  EXPECT_EQ(
      error_of_changed({profile, surface}),
      "FOLDER/case.toml:17:9: body.block.shape is \"surface\", and the profile has no column surface_elevation_m; "
      "add it to FOLDER/profile.csv, or use the shape \"box\" or \"polygon\".");
  write_next_to_the_case("profile.csv", header_with_surface + "0,0,0\n100,2,2\n");
  EXPECT_EQ(error_of_changed({profile, surface}),
            "FOLDER/case.toml:17:9: body.block.shape is \"surface\", and surface_elevation_m is nowhere above the "
            "terrain in FOLDER/profile.csv: the body holds nothing. Raise the surface there, or use the shape \"box\" "
            "or \"polygon\".");
  write_next_to_the_case("profile.csv", header_with_surface + "0,0,0\n50,1,9\n100,2,2\n");
  EXPECT_EQ(error_of_changed({profile, surface}), "no error");
}

TEST(Values, AreConsistent) {
  const std::string too_long =
      ": time.step is 3 s, longer than the run, which ends at time.end = 2 s; allowed: at most that. Make the step "
      "smaller, or the run longer.";
  EXPECT_EQ(error_of_changed({{"step = 0.001", "step = 3"}}), "FOLDER/case.toml:3:8" + too_long);
  EXPECT_EQ(error_of_changed({{"step = 0.001", "step = 3"}}, {"time.end=2"}), "--set time.end=2" + too_long);
  EXPECT_EQ(error_of_changed({{"[basal]", "[basal]\ncohesion = 1.0\nresidual_cohesion = 2.0\nslip_distance = 1.0"}}),
            "FOLDER/case.toml:22:21: basal.residual_cohesion is 2 Pa, above basal.cohesion, which is 1 Pa; cohesion "
            "along the ground is only lost. Give a residual at most the cohesion.");
  EXPECT_EQ(
      error_of_changed({{"[basal]", "[basal]\nmin_solid_fraction = 0.9"}}),
      "FOLDER/case.toml:20:1: basal.max_solid_fraction is 0.85, not above basal.min_solid_fraction, which is 0.9; "
      "Eq. 25 divides by their difference. Make the one larger or the other smaller.");
  EXPECT_EQ(error_of_changed({{"[body.block]", "dilation_angle = 10.0\nfriction_angle = 5.0\n[body.block]"}}),
            "FOLDER/case.toml:15:18: material.rock.dilation_angle is 10 degrees, above material.rock.friction_angle, "
            "which is 5 degrees; allowed: at most the friction angle, otherwise plastic flow creates energy.");
  EXPECT_EQ(error_of_changed({{"[body.block]", "residual_cohesion = 10.0\ncohesion = 5.0\n[body.block]"}}),
            "FOLDER/case.toml:15:21: material.rock.residual_cohesion is 10 Pa, above material.rock.cohesion, which is "
            "5 Pa; softening cannot increase cohesion. Give a residual at most the cohesion.");
  EXPECT_EQ(error_of_changed({{"[body.block]", "residual_friction_angle = 10.0\nfriction_angle = 5.0\n[body.block]"}}),
            "FOLDER/case.toml:15:27: material.rock.residual_friction_angle is 10 degrees, above "
            "material.rock.friction_angle, which is 5 degrees; softening cannot increase friction. Give a residual at "
            "most the friction angle.");
  EXPECT_EQ(error_of_changed(
                {{"[body.block]",
                  "residual_friction_angle = 10.0\nsoftening_slip = 1.0\nfriction_angle = 30.0\ndilation_angle = "
                  "12.0\n[body.block]"}}),
            "FOLDER/case.toml:15:27: material.rock.residual_friction_angle is 10 degrees, below "
            "material.rock.dilation_angle, which is 12 degrees; allowed: at least the dilation angle, which does not "
            "soften, otherwise plastic flow creates energy.");
}

TEST(Values, OfSofteningAreASlipOrAStrain) {
  const std::string softens = "friction_angle = 30.0\nresidual_friction_angle = 20.0\ncohesion = 5.0\n";
  EXPECT_EQ(error_of_changed({{"law = \"elastic\"", softens + "softening_slip = 0.5"}}), "no error");
  EXPECT_EQ(error_of_changed({{"law = \"elastic\"", softens + "softening_strain = 0.5"}}), "no error");
  EXPECT_EQ(error_of_changed({{"law = \"elastic\"", "friction_angle = 30.0\ncohesion = 5.0"}}), "no error");
  EXPECT_EQ(error_of_changed({{"law = \"elastic\"", softens}}),
            "FOLDER/case.toml:11:1: key 'material.rock.softening_slip' is missing: it is needed when cohesion or "
            "friction softens and softening_strain is not given. Add 'softening_slip = ...' to [material.rock]: slip "
            "s_c across a rupture surface over which the softening part of cohesion and friction decreases to 1/e, for "
            "any cell size: eps_c = s_c/(sqrt(3) grid.cell), a number, > 0 [m].");
  EXPECT_EQ(
      error_of_changed({{"law = \"elastic\"", softens + "softening_slip = 0.5\nsoftening_strain = 0.5"}}),
      "FOLDER/case.toml:16:20: material.rock.softening_strain has a meaning only when softening_slip is not given. "
      "Remove it, or change material.rock.softening_slip.");
}

TEST(Values, OfTheFilterNeedItsTransfer) {
  const std::string rest =
      " is given, and mechanics.transfer is not \"fmpm\"; no other transfer has it. Set "
      "mechanics.transfer = \"fmpm\", or remove mechanics.";
  EXPECT_EQ(error_of_changed({{"[basal]", "[mechanics]\nfmpm_order = 3\n[basal]"}}),
            "FOLDER/case.toml:21:14: mechanics.fmpm_order" + rest + "fmpm_order.");
  EXPECT_EQ(error_of_changed({{"[basal]", "[mechanics]\nfmpm_interval = 0.5\n[basal]"}}),
            "FOLDER/case.toml:21:17: mechanics.fmpm_interval" + rest + "fmpm_interval.");
  EXPECT_EQ(error_of_changed({{"[basal]", "[mechanics]\ntransfer = \"fmpm\"\nfmpm_interval = 1e-4\n[basal]"}}),
            "FOLDER/case.toml:22:17: mechanics.fmpm_interval is 0.0001 s, shorter than time.step, which is 0.001 s; "
            "velocities are filtered once a step at most. Make the interval longer.");
  EXPECT_EQ(error_of_text(valid_case, {"mechanics.transfer=fmpm"}),
            "--set mechanics.transfer=fmpm: key 'mechanics.fmpm_interval' is missing: it is needed when "
            "mechanics.transfer is \"fmpm\". Add 'fmpm_interval = ...' to [mechanics]: simulated time between "
            "applications of the filter FMPM, a number, > 0 [s].");
}

TEST(Values, ThatHaveNoEffectAreRefused) {
  EXPECT_EQ(
      error_of_text(valid_case, {"heat.enabled=false", "pressure.enabled=false", "mechanics.enabled=false"}),
      "--set mechanics.enabled=false: mechanics.enabled, heat.enabled and pressure.enabled are all false: nothing "
      "is left to compute. Set at least one of them to true.");
  EXPECT_EQ(error_of_changed({{"[basal]", "[mechanics]\nslope_shear = true\ninitial_stress = \"none\"\n[basal]"}}),
            "FOLDER/case.toml:21:15: mechanics.slope_shear is true, and mechanics.initial_stress is not \"geostatic\"; "
            "only that stress takes the shear. Set mechanics.initial_stress = \"geostatic\", or mechanics.slope_shear "
            "= false.");
  EXPECT_EQ(error_of_changed({{"[basal]", "[band]\nregion = \"first_layer\"\n[basal]"}}, {"terrain.type=none"}),
            "--set terrain.type=none: band.region is \"first_layer\", and the case has no terrain; there is no layer "
            "above it. Set band.region = \"all\", or give terrain.type.");
  EXPECT_EQ(error_of_changed({{"[basal]", "[band]\ncut_cells = \"equal_thickness\"\n[basal]"}}, {"terrain.type=none"}),
            "--set terrain.type=none: band.cut_cells is \"equal_thickness\", and the case has no terrain; nothing cuts "
            "through cells. Set band.cut_cells = \"as_they_are\", or give terrain.type.");
  EXPECT_EQ(
      error_of_changed({{"[basal]", "[mechanics]\neffective_stress = true\n[basal]"}}, {"pressure.enabled=false"}),
      "--set pressure.enabled=false: mechanics.effective_stress is true, and pressure.enabled is false; there is no "
      "pore pressure to subtract. Set pressure.enabled = true, or mechanics.effective_stress = false.");
  EXPECT_EQ(error_of_changed({{"[basal]", "[heat]\nadvection_form = \"conservative\"\nmasses = \"current\"\n[basal]"}},
                             {"material.rock.hydraulic_conductivity=1e-7"}),
            "FOLDER/case.toml:21:18: heat.advection_form is \"conservative\", and heat.update or heat.masses is as "
            "published, which still creates heat; allowed with it: heat.update = \"enthalpy\" and heat.masses = "
            "\"initial\". Set both so, or heat.advection_form = \"as_published\".");
  EXPECT_EQ(
      error_of_changed({{"[basal]", "[pressure]\nresidual_stress = 2e5\nfrozen = \"ice_pressure\"\n[basal]"}}),
      "FOLDER/case.toml:21:19: pressure.residual_stress is 200000 Pa, and pressure.frozen is not \"none\"; if ice has "
      "a pressure, water starts from it. Set pressure.frozen = \"none\", or remove pressure.residual_stress.");
  EXPECT_EQ(
      error_of_changed({{"elevation = 0.0", "slope = 30.0"}}),
      "FOLDER/case.toml:10:9: terrain.slope is 30 degrees, and terrain.type is not \"plane\"; no other ground has "
      "it. Set terrain.type = \"plane\", or remove terrain.slope.");
}

TEST(Values, OfStartingNoiseAreASmallFractionAndASeed) {
  const auto with_initial = [](const std::string& lines) {
    return error_of_changed({{"[basal]", "[initial]\n" + lines + "\n[basal]"}});
  };
  EXPECT_EQ(with_initial("noise = 0.1\nseed = 5"), "no error");
  EXPECT_EQ(with_initial("seed = 5"),
            "FOLDER/case.toml:21:8: initial.seed has a meaning only when initial.noise is above 0. Remove it, or "
            "change initial.noise.");
  const std::string too_large = with_initial("noise = 0.5");
  EXPECT_EQ(too_large.find("FOLDER/case.toml:21:9: initial.noise is 0.5; allowed: >= 0 and < 0.5 (maximum "), 0U)
      << too_large;
  const std::string negative = with_initial("noise = 0.1\nseed = -1");
  EXPECT_EQ(
      negative.find("FOLDER/case.toml:22:8: initial.seed is -1; allowed: between 0 and 2147483647, ends included"), 0U)
      << negative;
}

TEST(Frames, MeetTheDomain) {
  const auto with_frame = [](const std::string& min, const std::string& max, const std::string& rest) {
    return error_of_text(valid_case + "[frame.wall]\nmin = " + min + "\nmax = " + max + "\n" + rest);
  };
  EXPECT_EQ(with_frame("[0, 0]", "[1, 1]", "axis = \"z\"\nvelocity = 1\n"),
            "FOLDER/case.toml:25:8: frame.wall.axis is \"z\" in a 2D case; allowed: \"x\" or \"y\". Up is \"y\" "
            "there.");
  EXPECT_EQ(with_frame("[0, 0]", "[1, 0]", "axis = \"y\"\nvelocity = 1\n"),
            "FOLDER/case.toml:24:7: frame.wall.max is (1, 0), not above frame.wall.min, which is (0, 0), in every "
            "direction; give the highest corner of the box.");
  const std::string outside =
      "FOLDER/case.toml:23:7: frame.wall reaches from (-9, 0) to (-5, 9) and stays outside the domain, which is (0, "
      "-10) to (100, 50), until time.end; move the frame, or widen grid.min and grid.max.";
  EXPECT_EQ(with_frame("[-9, 0]", "[-5, 9]", "axis = \"y\"\nvelocity = 3\n"), outside) << "it moves along the side";
  EXPECT_EQ(with_frame("[-9, 0]", "[-5, 9]", "axis = \"x\"\nvelocity = 2\n"), outside) << "it is 1 m short";
  EXPECT_EQ(with_frame("[-9, 0]", "[-5, 9]", "axis = \"x\"\nvelocity = 3\n"), "no error") << "it comes in time";
  EXPECT_EQ(with_frame("[-9, 0]", "[5, 9]", "axis = \"x\"\nvelocity = -3\n"), "no error") << "it leaves";
}

TEST(Bodies, InThreeDimensionsAreBoxesAndReleases) {
  const std::vector<Change> in_3d{{"[time]", "[case]\ndimension = 3\n[time]"},
                                  {"min = [0.0, -10.0]", "min = [0.0, 0.0, -10.0]"},
                                  {"max = [100.0, 50.0]", "max = [100.0, 50.0, 50.0]"},
                                  {"shape = \"box\"\nmin = [0.0, 0.0]\nmax = [40.0, 20.0]", "shape = \"surface\""}};
  EXPECT_EQ(error_of_changed(in_3d),
            "FOLDER/case.toml:19:9: body.block.shape is for 2D cases; allowed in 3D: \"box\", \"release\". Use the "
            "shape \"box\" with min and max, or on a DEM the shape \"release\".");
}

TEST(Transfers, PicFractionBelongsToTheBlend) {
  const Change fraction{"[basal]", "[mechanics]\npic_fraction = 0.1\n[basal]"};
  EXPECT_EQ(error_of_changed({fraction}),
            "FOLDER/case.toml:21:16: mechanics.pic_fraction is 0.1, and mechanics.transfer is not \"blend\"; no other "
            "transfer has it. Set mechanics.transfer = \"blend\", or remove mechanics.pic_fraction.");
  EXPECT_EQ(error_of_changed({fraction}, {"mechanics.transfer=blend"}), "no error");
}

}  // namespace
}  // namespace thawslide::config
