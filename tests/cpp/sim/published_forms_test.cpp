// The published formulation and the terms that it omits, each compared with the expected effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/fields.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "physics/pressurization.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A bar without gravity.
const Variant bar{
    "bar",
    "time.end=1000; time.step=10; grid.max=[2,0.4]; material.bar.youngs_modulus=1e9; "
    "material.bar.hydraulic_conductivity=1e-9; body.bar.max=[2,0.4]; body.bar.temperature=1; mechanics.enabled=true; "
    "pressure.enabled=true"};

// With xi = 8, a pressure over 2 m diffuses like one over 0.25 m: 64 times faster.
TEST(BandScaling, RefinesTheGridForSeepage) {
  const auto seep = [&](double thickness, double step, double end) {
    Simulation<2> simulation(
        paper_case(bar + "mechanics.enabled=false; heat.enabled=false",
                   fmt::format("band.thickness={}; time.step={}; time.end={}", thickness, step, end)));
    auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.liquid_pressure(p) = particles.pore_pressure(p) = 1e5 * std::cos(pi * particles.position(p, 0));
    }
    run_until(simulation, end);
    return fields_by_id(simulation.particles()).at("pore_pressure");
  };
  const auto scaled = seep(0.0125, 0.1, 5.0), plain = seep(0.1, 6.4, 320.0);
  const double largest = *std::max_element(scaled.begin(), scaled.end());
  EXPECT_GT(largest, 1e4);
  EXPECT_LT(largest, 0.9e5);
  for (std::size_t p = 0; p < scaled.size(); ++p) {
    EXPECT_NEAR(scaled[p], plain[p], 1e-9 * 1e5);
  }
}

// A bar at -1 C, one time step after its volume has grown by a tenth and its porosity by Eq. 6: heat and masses are
// those of t = 0.
TEST(Masses, DoNotFollowVolumeAndPorosity) {
  Simulation<2> simulation(
      paper_case(bar, {"mechanics.enabled=false", "pressure.enabled=false", "body.bar.temperature=-1.0"}));
  const HistoryRow before = history_row(simulation);
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.volume(p) *= 1.1;
    particles.porosity(p) = physics::updated_porosity(simulation.model().band.phases, 0.375, std::log(1.1), 0.0);
  }
  simulation.step(10.0);
  const HistoryRow after = history_row(simulation);
  for (const char* name : {"rock_kg", "ice_kg", "water_kg", "latent_J", "sensible_J"}) {
    EXPECT_NEAR(value_of(after, name), value_of(before, name), 1e-9 * std::abs(value_of(before, name))) << name;
  }
}

// Frequency of the first mode of a bar between rollers, from the time at which its velocity vanishes.
double frequency(const Sets& sets, double* residual = nullptr) {
  const Sets between_rollers =
      "heat.enabled=false; pressure.seepage=false; time.step=4e-6; time.end=1e-3; "
      "grid.boundary={x_min='roller',x_max='roller',y_min='roller',y_max='roller'}";
  Simulation<2> simulation(paper_case(bar, sets + between_rollers));
  auto& particles = simulation.particles();
  const auto mode = [&](std::size_t p) { return std::sin(pi * particles.position(p, 0) / 2.0); };
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.velocity(p, 0) = 0.01 * mode(p);
  }
  const double kinetic = value_of(history_row(simulation), "kinetic_J");
  double before = 1.0, now = 1.0;
  while (now > 0.0) {
    simulation.step(4e-6);
    before = now;
    now = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      now += particles.mass(p) * particles.velocity(p, 0) * mode(p);
    }
  }
  if (residual != nullptr) {  // the budget began without the velocities given here
    *residual = (value_of(history_row(simulation), "mechanical_residual_J") - kinetic) / kinetic;
  }
  const double quarter = simulation.time() - 4e-6 * now / (now - before);
  return pi / 2.0 / quarter;
}

TEST(EffectiveStress, WaterStiffensAnUndrainedBar) {
  const physics::Elastic elastic = physics::Elastic::from_young_poisson(1e9, 0.3);
  const double density = 0.625 * 2750.0 + 0.375 * 1000.0;
  const double drained = pi / 2.0 * std::sqrt(elastic.p_wave_modulus() / density);
  const double undrained = pi / 2.0 * std::sqrt((elastic.p_wave_modulus() + 1e9 / 0.375) / density);
  const double total = frequency({});
  double residual = 1.0;
  const double with_water = frequency("mechanics.effective_stress=true; pressure.volumetric_term=true", &residual);
  EXPECT_NEAR(total / drained, 1.0, 0.006) << "20 cells a half wave";
  EXPECT_NEAR(frequency({"mechanics.effective_stress=true"}) / total, 1.0, 1e-12) << "P does not change by itself";
  EXPECT_NEAR(frequency({"pressure.volumetric_term=true"}) / total, 1.0, 1e-12) << "P does not act";
  EXPECT_NEAR(with_water / total, undrained / drained, 0.002 * undrained / drained);
  EXPECT_GT(undrained / drained, 1.5);
  EXPECT_NEAR(residual, 0.0, 0.01) << "the budget includes the work of the pore pressure";
}

// A melted slab at rest under its weight.
const Variant slab{
    "slab",
    "time.end=0.01; time.step=0.001; grid.max=[250,80]; material.rock.law=mohr_coulomb; "
    "material.rock.youngs_modulus=5e8; material.rock.viscosity_time=0; material.rock.friction_angle=30; "
    "material.rock.cohesion=0; material.rock.hydraulic_conductivity=1e-9; body.slab.temperature=1; mechanics.k0=0.5; "
    "basal.friction_angle=30; band.thickness="};

TEST(EffectiveStress, CarriesTheSameLoadWithLessStrength) {
  Simulation<2> total(paper_case(slab));
  Simulation<2> effective(paper_case(slab, {"mechanics.effective_stress=true"}));
  for (std::size_t p = 0; p < total.particles().size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(effective.particles().stress(p, c),
                  total.particles().stress(p, c) + total.particles().pore_pressure(p), 1e-6);
    }
  }
  total.step(0.001);
  effective.step(0.001);
  for (std::size_t p = 0; p < total.particles().size(); ++p) {
    for (int a = 0; a < 2; ++a) {
      EXPECT_NEAR(effective.particles().velocity(p, a), total.particles().velocity(p, a), 1e-12);
    }
  }
  // s1 = -N/2, s3 = -N is within the surface; after subtracting P near N/2, it is not.
  EXPECT_EQ(value_of(history_row(total), "mean_plastic_strain"), 0.0);
  EXPECT_GT(value_of(history_row(effective), "mean_plastic_strain"), 0.0);
}

// Softening of cohesion and friction reduces the strength in terms of effective stress.
TEST(EffectiveStress, SoftensLikeTotalStress) {
  Simulation<2> simulation(
      paper_case(slab,
                 "mechanics.effective_stress=true; material.rock.cohesion=2e4; "
                 "material.rock.residual_cohesion=0.0; material.rock.residual_friction_angle=20.0; "
                 "material.rock.softening_strain=1e-5"));
  auto& particles = simulation.particles();
  std::size_t yielded = 0, softened = 0, beyond_by_total_stress = 0;
  for (int step = 0; step < 10; ++step) {
    const std::vector<double> before = fields_by_id(simulation.particles()).at("plastic_strain");
    simulation.step(0.001);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double plastic_strain = before[static_cast<std::size_t>(particles.id(p))];
      if (!(particles.plastic_strain(p) > plastic_strain)) {
        continue;
      }
      const double fraction = std::exp(-plastic_strain / 1e-5), low = std::sin(pi / 9.0);
      const double sine = low + (0.5 - low) * fraction, cohesion = 2e4 * fraction;
      const auto values = physics::principal(mpm::full_tensor<2>(particles.stress, p)).values;
      const auto excess = [&](double pressure) {  // Eq. 11 for a stress with this pressure added
        return 0.5 * (values[0] - values[2]) + (0.5 * (values[0] + values[2]) + pressure) * sine -
               cohesion * std::sqrt(1.0 - sine * sine);
      };
      EXPECT_NEAR(excess(0.0), 0.0, 1e-9 * std::abs(values[2]) + 1e-6);
      ++yielded;
      softened += fraction < 0.5 ? 1 : 0;
      beyond_by_total_stress += excess(-particles.pore_pressure(p)) > -1e-3 * std::abs(values[2]) ? 1 : 0;
    }
  }
  EXPECT_GT(yielded, 100u);
  EXPECT_GT(softened, 20u);
  EXPECT_LT(beyond_by_total_stress, yielded / 10) << "the total stress is not what yields";
}

const Variant cooled =
    bar +
    "mechanics.enabled=false; pressure.enabled=false; body.bar.temperature=-0.05; heat.boundary.x_min={flux=-100}";

HistoryRow after_cooling(const std::string& update, double step) {
  const config::Case parameters =
      paper_case(cooled, fmt::format("heat.update={}; time.step={}; time.end=400000", update, step));
  Simulation<2> simulation(parameters);
  run_until(simulation, parameters.time.end);
  return history_row(simulation);
}

TEST(HeatUpdate, ApparentCapacityCreatesTheHeatOfItsColumn) {
  const HistoryRow enthalpy = after_cooling("enthalpy", 2000.0);
  const HistoryRow published = after_cooling("apparent_capacity", 2000.0);
  const HistoryRow finer = after_cooling("apparent_capacity", 1000.0);
  const double moved = 100.0 * 0.4 * 4e5;
  EXPECT_NEAR(value_of(enthalpy, "boundary_heat_J"), -moved, 1e-9 * moved);
  EXPECT_EQ(value_of(enthalpy, "capacity_heat_J"), 0.0);
  EXPECT_GT(std::abs(value_of(published, "capacity_heat_J")), 1e-3 * moved);
  // The error of the published capacity is of first order in the step.
  EXPECT_NEAR(value_of(published, "capacity_heat_J") / value_of(finer, "capacity_heat_J"), 2.0, 0.3);
  for (const HistoryRow* row : {&enthalpy, &published, &finer}) {
    EXPECT_NEAR(value_of(*row, "thermal_residual_J"), 0.0, 1e-9 * moved);
  }
}

}  // namespace
}  // namespace thawslide::sim
