// Heat and pore pressure on the grid: scaling of the band, boundaries, and no spurious heat from a band whose thickness
// changes or from water that carries heat.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "base/error.hpp"
#include "base/portability.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A bar at rest; cells and step are set by --set.
const Variant bar{"bar", "heat.boundary.x_min={temperature=8}"};

TEST(Conduction, BandScalingRefinesTheGrid) {
  // With xi = 10, cells of 0.1 m conduct like cells of 0.01 m: the same curve over x/xi, 100 times earlier.
  const config::Case plain = paper_case(bar, {"time.step=1000.0"});
  const config::Case scaled = paper_case(bar, "time.step=10.0; time.end=4000.0; band.thickness=0.01");
  Simulation<2> slow(plain), fast(scaled);
  run_until(slow, plain.time.end);
  run_until(fast, scaled.time.end);
  for (std::size_t p = 0; p < slow.particles().size(); ++p) {
    EXPECT_NEAR(slow.particles().temperature(p), fast.particles().temperature(p), 1e-9);
  }
  EXPECT_NEAR(value_of(history_row(slow), "thermal_residual_J"), 0.0, 1e-3);
}

TEST(Conduction, StepAboveTheLimitOfALaterThinnerBandIsRefused) {
  EXPECT_THROW((Simulation<2>(paper_case(bar, "band.thickness={time=[0.0,1e5],value=[0.1,0.001]}; time.step=500.0"))),
               UserError);
}

// A column at rest; e from 0.05 m to 0.5 m and back.
const Variant column{
    "column",
    "case.gravity=0; time.end=4000; time.step=1; grid.max=[1,6]; material.soil.hydraulic_conductivity=1e-9; "
    "body.column.max=[1,5]; body.column.temperature=-10; heat.conduction=false"};
const std::string jumps = "band.thickness={time=[0.0,0.5,0.5,2.5,2.5,9.0],value=[0.05,0.05,0.5,0.5,0.05,0.05]}";

// Gives a particle another temperature [C] with the heat for it; returns that heat, without scaling [J].
double heat_to(Simulation<2>& simulation, std::size_t p, double temperature) {
  auto& particles = simulation.particles();
  const double before = particles.heat_content(p);
  simulation.model().band.with_heat_content([&](const auto& content) {
    particles.heat_content(p) = content.content(temperature, particles.initial_porosity(p));
    particles.liquid_saturation(p) = content.curve.saturation(temperature);
  });
  particles.temperature(p) = particles.previous_temperature(p) = temperature;
  return particles.initial_volume(p) * (particles.heat_content(p) - before);
}

struct Jump {
  HistoryRow before, thick, thin;
  double temperature_thick, temperature_thin, stirred;
  double hot, cold;  // heat content at the initial temperature, and at t = 0 [J/m3]
};

Jump jump(const std::string& change, double temperature) {
  Simulation<2> simulation(paper_case(column, {jumps, "band.thickness_change=" + change, "pressure.enabled=false"}));
  auto& particles = simulation.particles();
  Jump found{};
  found.cold = particles.heat_content(0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    found.stirred += heat_to(simulation, p, temperature) / particles.thermal_scaling(p);
  }
  found.hot = particles.heat_content(0);
  found.before = history_row(simulation);
  simulation.step(1.0);
  simulation.step(1.0);
  found.thick = history_row(simulation);
  found.temperature_thick = particles.temperature(3);
  simulation.step(1.0);
  simulation.step(1.0);
  found.thin = history_row(simulation);
  found.temperature_thin = particles.temperature(3);
  return found;
}

double heat(const HistoryRow& row) { return value_of(row, "sensible_J") + value_of(row, "latent_J"); }

// Volumes V/xi = V e/L_e of 5 m2: 0.5 and 5 m2.
TEST(ThicknessChange, ConservingMixesInMaterialUnchanged) {
  for (const double temperature : {400.0, 30.0, -1.0}) {
    const Jump found = jump("conserving", temperature);
    const double brought = 4.5 * found.cold;
    EXPECT_NEAR(heat(found.thick), 0.5 * found.hot + brought, 1e-9 * std::abs(found.hot));
    EXPECT_NEAR(value_of(found.thick, "band_rescale_J"), brought, 1e-9 * std::abs(brought));
    Simulation<2> simulation(paper_case(column));
    const double mixed = simulation.model().band.with_heat_content([&](const auto& content) {
      return content.temperature(0.1 * found.hot + 0.9 * found.cold, 0.375, temperature);
    });
    EXPECT_NEAR(found.temperature_thick, mixed, 1e-9);
    EXPECT_LT(mixed, temperature);
    // Material left behind by a thinner band keeps its heat.
    EXPECT_NEAR(found.temperature_thin, mixed, 1e-9);
    EXPECT_NEAR(heat(found.thin), 0.1 * heat(found.thick), 1e-9 * std::abs(heat(found.thick)));
    for (const HistoryRow* row : {&found.before, &found.thick, &found.thin}) {
      EXPECT_NEAR(value_of(*row, "thermal_residual_J") - found.stirred, 0.0, 1e-9 * std::abs(found.stirred));
    }
  }
}

TEST(ThicknessChange, PublishedCreatesTheHeatInItsColumn) {
  const Jump found = jump("as_published", 30.0);
  EXPECT_EQ(found.temperature_thick, 30.0);
  EXPECT_NEAR(value_of(found.thick, "band_rescale_J"), 4.5 * found.hot, 1e-9 * found.hot);
  EXPECT_NEAR(value_of(found.thin, "band_rescale_J"), 0.0, 1e-9 * found.hot);
  EXPECT_NEAR(value_of(found.thick, "thermal_residual_J") - found.stirred, 0.0, 1e-9 * found.stirred);
}

// Material at 400 C and under pressure, without a void, after e has grown to `thickness` [m]; rock does not expand.
struct Mixture {
  double temperature, pressure, gas_void, void_of_melt;
};
Mixture mixture(const std::string& melt_contraction, double thickness) {
  Simulation<2> simulation(
      paper_case(column, {fmt::format("band.thickness={{time=[0.0,0.5,0.5,9.0],value=[0.05,0.05,{0},{0}]}}", thickness),
                          "band.thickness_change=conserving", "phases.rock_expansion=0.0", "pressure.seepage=false",
                          "pressure.melt_contraction=" + melt_contraction}));
  auto& particles = simulation.particles();
  const bool is_kept = particles.pore_void.is_kept();
  const double all = is_kept ? particles.pore_void(3) : 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    heat_to(simulation, p, 400.0);
    particles.liquid_pressure(p) = particles.pore_pressure(p) = 5e8;
    if (is_kept) {
      particles.pore_void(p) = 0.0;
    }
  }
  simulation.step(1.0);
  simulation.step(1.0);
  return {particles.temperature(3), particles.pore_pressure(3), is_kept ? particles.pore_void(3) : 0.0, all};
}

// Water of both parts expands or contracts towards the temperature of the mixture, and the storage of both is shared.
TEST(ThicknessChange, ConservingMixesTheWaterToo) {
  constexpr double porosity = 0.375, storage = porosity / 1e9, per_kelvin = porosity * 2.75e-4, kept = 1.0 / 1.2;
  const Mixture full = mixture("false", 0.06);
  ASSERT_GT(full.temperature, 200.0);
  const double own = 5e8 * storage + per_kelvin * (full.temperature - 400.0), joins = per_kelvin * full.temperature;
  EXPECT_NEAR(full.pressure * storage, kept * own + (1.0 - kept) * joins, 1e-12);
  const Mixture contracted = mixture("true", 0.06);
  EXPECT_EQ(contracted.temperature, full.temperature);
  EXPECT_GT(contracted.void_of_melt, 0.03);
  const double surplus = kept * own + (1.0 - kept) * (joins - contracted.void_of_melt);
  EXPECT_NEAR(contracted.pressure * storage, std::max(0.0, surplus), 1e-12);
  EXPECT_NEAR(contracted.gas_void, std::max(0.0, -surplus), 1e-12);
  // Frozen by the added material: hot water contracts to the freezing point and has the complete void of the future
  // melt.
  const Mixture frozen = mixture("true", 0.5);
  ASSERT_LT(frozen.temperature, 0.0);
  const double open = std::max(0.0, 400.0 * per_kelvin - 5e8 * storage);
  EXPECT_NEAR(frozen.gas_void, 0.1 * open + 0.9 * frozen.void_of_melt, 1e-12);
}

const Sets seeping = "body.column.temperature=25.0; heat.advection_form=conservative";

// Temperature and pressure decrease towards the top; returns the heat that was mixed in [J].
double stir(Simulation<2>& simulation, double swing) {
  auto& particles = simulation.particles();
  double stirred = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double wave = std::cos(pi * particles.position(p, 1) / 5.0);
    stirred += heat_to(simulation, p, 25.0 + swing * wave);
    particles.liquid_pressure(p) = particles.pore_pressure(p) = 1e6 * (1.0 + wave);
  }
  return stirred;
}

TEST(ConservativeAdvection, CreatesNoHeat) {
  Simulation<2> simulation(paper_case(column, seeping));
  const double before = heat(history_row(simulation)) + stir(simulation, 20.0);
  run_until(simulation, 4000.0);
  const auto row = history_row(simulation);
  const double drained = value_of(row, "drained_heat_J");
  EXPECT_EQ(value_of(row, "advection_J"), 0.0);
  EXPECT_GT(drained, 0.0);
  EXPECT_NEAR((heat(row) + drained) / before, 1.0, 1e-13);
  const double of_water = drained / (value_of(row, "drained_water_kg") * 4180.0);
  EXPECT_TRUE(of_water > 4.9 && of_water < 45.0) << of_water << " C";
}

// In the first step heat moves up by rho_L C_L q_L (T - Tref): its centre by the flux over all heat.
TEST(ConservativeAdvection, CarriesTheHeatOfTheWater) {
  auto on_small_cells = seeping;
  on_small_cells.emplace_back("grid.cell=0.25");
  Simulation<2> simulation(paper_case(column, on_small_cells));
  stir(simulation, 20.0);
  const auto& particles = simulation.particles();
  const auto moment = [&] {
    double sum = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      sum += particles.initial_volume(p) * particles.heat_content(p) * particles.position(p, 1);
    }
    return sum;
  };
  const double before = moment();
  simulation.step(1.0);
  // q_L = k/gamma_w 1e6 pi/5 sin(pi y/5); the integral of q_L (25 + 20 cos(pi y/5)) over 1 m by 5 m is 50/pi times 5
  // times its amplitude.
  const double exact = 1000.0 * 4180.0 * 1e-9 / 9810.0 * 1e6 * pi / 5.0 * 25.0 * 10.0 / pi;
  const double top = 4.9375;  // of the particles that drain
  const double moved = moment() - before + value_of(history_row(simulation), "drained_heat_J") * top;
  EXPECT_NEAR(moved / exact, 1.0, 0.02);
}

// Water that leaves a body of uniform temperature keeps it uniform, also at its drained top.
TEST(ConservativeAdvection, KeepsUniformTemperature) {
  Simulation<2> simulation(paper_case(column, seeping));
  stir(simulation, 0.0);
  run_until(simulation, 4000.0);
  const auto row = history_row(simulation);
  const auto& particles = simulation.particles();
  const double drained = value_of(row, "drained_water_kg");
  EXPECT_GT(drained, 0.1);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_NEAR(particles.temperature(p), 25.0, 0.05);
  }
  EXPECT_NEAR(value_of(row, "drained_heat_J") / (drained * 4180.0 * 25.0), 1.0, 1e-3);
}

}  // namespace
}  // namespace thawslide::sim
