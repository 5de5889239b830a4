// A slide with every mechanism on a DEM, part of which leaves it: budgets, threads, messages. No particle gets below
// the ground.
#include <regex>

#include "../support/fields.hpp"
#include "../support/slide_on_dem.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "terrain/height_field.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const Sets slide{"grid.cell=2.5; grid.min=[-60,-40,-80]; grid.max=[120,40,60]",
                 "material.debris.youngs_modulus=5e7; material.debris.hydraulic_conductivity=1e-9",
                 "body.slide.temperature=-2; body.slide.porosity=0.375; body.slide.velocity=[8,0,-4.8]",
                 "basal.friction=lubricated; band.thickness=0.1; heat.enabled=true; pressure.enabled=true",
                 "mechanisms.pressurization=true"};

// Slope of 31 degrees along x, with a gully and bumps; it ends at x = 40.
double slope(double x, double y) {
  return -0.6 * x + 0.01 * y * y + 0.8 * std::sin(0.2 * x + 0.1) * std::cos(0.15 * y);
}

Raster heap() {
  return thickness_between(Place(-14.0, -12.0), Place(14.0, 12.0), 0.25,
                           [](double x, double y) { return std::hypot(x, y) < 11.0 ? 6.0 : 0.0; });
}

// hole: whether points have no data.
Simulation<3> run_onto(double end_of_dem, const Sets& sets, const std::function<bool(double, double)>& hole = nullptr) {
  const Raster ground = raster_between(Place(-70.0, -50.0), Place(end_of_dem, 50.0), 4.0,
                                       [&](double x, double y) { return hole && hole(x, y) ? no_data : slope(x, y); });
  return Simulation<3>(case_on_dem(base_text("release"), slide + sets), site_of(ground, heap()));
}

struct Seen {
  std::map<std::string, std::vector<double>> fields;
  sim::HistoryRow row;
  double mass = 0.0, momentum = 0.0, heat = 0.0, energy = 0.0;  // maximum relative residuals of the budgets
};

// Runs until about half of the slide has left; records the residuals of all budgets every half second.
Seen leave(int threads) {
  const int threads_before = thread_count();
  set_thread_count(threads);
  auto simulation = run_onto(42.0, "grid.leaving=remove");
  const double mass = value_of(history_row(simulation), "mass_kg");
  Seen seen;
  const auto update = [](double& largest, double fraction) { largest = std::max(largest, std::abs(fraction)); };
  for (double time = 0.5; time < 4.1; time += 0.5) {
    run_until(simulation, time);
    seen.row = history_row(simulation);
    const auto value = [&](const std::string& column) { return value_of(seen.row, column); };
    update(seen.mass, value("mass_residual_kg") / mass);
    update(seen.mass, (value("mass_kg") + value("left_mass_kg")) / mass - 1.0);
    update(seen.mass, (value("rock_kg") + value("ice_kg") + value("water_kg")) / value("mass_kg") - 1.0);
    for (const std::string axis : {"x", "y", "z"}) {
      update(seen.momentum, value("momentum_residual_" + axis + "_N_s") / (mass * 9.81 * time));
    }
    update(seen.heat, value("thermal_residual_J") / value("friction_heat_J"));
    update(seen.energy, value("mechanical_residual_J") / value("kinetic_J"));
  }
  set_thread_count(threads_before);
  seen.fields = fields_by_id(simulation.particles());
  return seen;
}

TEST(LeavingDem, BudgetsCloseForAnyNumberOfThreads) {
  Record record("A slide that leaves the DEM",
                "Debris with heat and pore pressure runs 4 s down a gully; particles beyond the edge of the DEM are "
                "removed and counted. Maximum residual of the budgets, every half second.",
                "budgets close; results of one and two threads are bitwise identical", "conservation");
  const Seen one = leave(1), two = leave(2);
  record.expect_near("mass, over the slide's", one.mass, 0.0, 1e-12);
  record.expect_near("momentum, over weight times time", one.momentum, 0.0, 1e-11);
  record.expect_near("heat, over the heat of friction", one.heat, 0.0, 1e-10);
  record.expect_near("mechanical energy, over the kinetic energy", one.energy, 0.0, 0.01);
  const double left = value_of(one.row, "left_mass_kg"), stays = value_of(one.row, "mass_kg");
  EXPECT_GT(left, 0.1 * stays);
  EXPECT_GT(stays, 0.1 * left);
  EXPECT_GT(value_of(one.row, "left_heat_J"), 0.0);
  EXPECT_EQ(one.fields, two.fields);
  for (std::size_t k = 0; k < one.row.size(); ++k) {
    EXPECT_EQ(one.row[k].second, two.row[k].second) << one.row[k].first;
  }
}

// Runs until the run ends with an error, whose text must state the position; returns its x and y [m].
Place expect_error(Simulation<3> simulation) {
  std::string text = "it ran to its end";
  try {
    run_until(simulation, 5.0);
  } catch (const RunError& error) {
    text = error.what();
  }
  const std::regex expected(
      "the run failed at t = ([0-9.]+) s \\(step [0-9]+\\): particle [0-9]+ of body 'slide' at \\((-?[0-9.]+), "
      "(-?[0-9.]+), (-?[0-9.]+)\\) m: the terrain below it is not known: the DEM ends or has a hole there\\. .*Give a "
      "DEM that .*, or set grid\\.leaving = \"remove\" to remove such particles\\. `thawslide new` crops the DEM to "
      "the domain: create the case again with a smaller --reach-angle, which uses more of the DEM, or from a larger "
      "DEM\\.");
  std::smatch found;
  EXPECT_TRUE(std::regex_match(text, found, expected)) << text;
  return found.empty() ? Place(HUGE_VAL, HUGE_VAL) : Place(std::stod(found[2]), std::stod(found[3]));
}

// The ground is known up to the last points with data: at x = 22 m, there is a hole from 25 to 35 m.
TEST(LeavingDem, StopsAtTheEdgeAndAtAHole) {
  const Place at_edge = expect_error(run_onto(42.0, {}));
  EXPECT_GT(at_edge[0], 42.0);
  EXPECT_LT(at_edge[0], 42.2) << "as soon as the first particle is beyond";
  const auto hole = [](double x, double y) { return x > 25.0 && x < 35.0 && std::abs(y) < 10.0; };
  const Place at_hole = expect_error(run_onto(130.0, {}, hole));
  EXPECT_GT(at_hole[0], 22.0);
  EXPECT_LT(at_hole[0], 22.2);
  EXPECT_LT(std::abs(at_hole[1]), 10.0 + 4.0);
}

// Ridges and a gully across and along the path, on a slope.
double rugged(double x, double y, double slope) {
  return slope * x + 0.008 * y * y + 2.5 * std::pow(std::sin(0.12 * x), 2.0) - 4.0 * std::exp(-y * y / 60.0);
}

// With a cliff of 15 m, or one of 67 degrees over two cells, oblique to the grid.
double straight_cliff(double x, double y) { return rugged(x, y, -0.6) - 15.0 / (1.0 + std::exp(-2.0 * (x - 35.0))); }
double oblique_cliff(double x, double y) {
  return rugged(x, y, -0.5) - 12.0 * std::clamp((0.8 * x + 0.6 * y - 25.0) / 5.0, 0.0, 1.0);
}

// Maximum depth of the centre of any particle below the ground of the cells in any step [m], normal to the ground.
double deepest_in_any_step(const Height& height, double end, double& centre_x) {
  const Raster ground = raster_between(Place(-70.0, -50.0), Place(130.0, 50.0), 2.5, height);
  Simulation<3> simulation(case_on_dem(base_text("release"), slide + "grid.min=[-60,-40,-120]"),
                           site_of(ground, heap()));
  const auto& surface = *simulation.model().ground;
  double deepest = 0.0;
  while (simulation.time() < end) {
    simulation.step(simulation.next_step(end));
    const auto& particles = simulation.particles();
    const auto depth = [&](std::size_t p) {
      const Position position = particles.position.get<Position>(p);
      const Place place = position.head<2>();
      return (surface.height(place) - position[2]) * surface.slope_cosine(place, 2.5);
    };
    deepest = std::max(deepest, greatest_of(simulation, depth));
  }
  centre_x = CentreOfMass(simulation).position[0];
  return deepest;
}

TEST(RuggedDem, NoParticleGetsBelowTheGround) {
  Record record(
      "A slide over rugged ground",
      "Debris 6 m thick runs over ridges, along a gully and down a cliff, on cells of 2.5 m; checked in every step.",
      "no particle below the ground", "");
  double centre_x = 0.0;
  const double straight = deepest_in_any_step(straight_cliff, 5.0, centre_x);
  EXPECT_GT(centre_x, 45.0) << "most of the slide has fallen down the cliff";
  record.expect_near("deepest centre of a particle below the ground, in cells: cliff of 15 m along the grid",
                     straight / 2.5, 0.0, 0.05);
  const double oblique = deepest_in_any_step(oblique_cliff, 4.0, centre_x);
  EXPECT_GT(centre_x, 28.0) << "most of the slide has fallen down the cliff";
  record.expect_near("the same: cliff of 12 m, 67 degrees over two cells, oblique to the grid", oblique / 2.5, 0.0,
                     0.05);
}

}  // namespace
}  // namespace thawslide::verification
