// Random initial displacement of particles.
#include <gtest/gtest.h>

#include "../support/fields.hpp"
#include "../support/slide_on_dem.hpp"
#include "sim/setup/release_body.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using Fields = std::map<std::string, std::vector<double>>;

constexpr double spacing = 5.0;  // of particles [m]

// A wedge on flat ground, whose oblique side cuts through the lattice, next to a block.
const Variant wedge_and_block{
    "block",
    "time.step=0.002; grid.cell=10; grid.min=[-50,-50]; grid.max=[600,150]; material.rock.viscosity_time=0; "
    "body.block.min=[400,0]; body.block.max=[500,100]; body.block.temperature={depth=[0,100],value=[-10,-2]}; "
    "body.wedge.material=rock; body.wedge.shape=polygon; body.wedge.vertices=[[0,0],[400,0],[400,100]]; "
    "basal.friction=lubricated; mechanisms.pressurization=true; heat.enabled=true"};

const Variant release =
    release_on_dem({1.0, 0.002, 10.0, {-100.0, -100.0, -200.0}, {100.0, 100.0, 200.0}}, elastic_rock(0.0), 20.0) +
    "mechanics.slope_shear=false; basal.friction=lubricated; mechanisms.pressurization=true; heat.enabled=true";

Sets noise(double fraction, int seed) {
  return {fmt::format("initial.noise={}", fraction), fmt::format("initial.seed={}", seed)};
}

template <int Dim>
Fields fields_of(const Simulation<Dim>& simulation) {
  Fields fields = fields_by_id(simulation.particles());
  auto& positions = fields.at("position");  // absolute
  for (std::size_t k = 0; k < positions.size(); ++k) {
    positions[k] += simulation.model().origin[static_cast<int>(k % Dim)];
  }
  return fields;
}

Fields on_flat_ground(const Sets& sets) { return fields_of(Simulation<2>(paper_case(wedge_and_block, sets))); }

Simulation<3> on_slope(const Sets& sets) {
  const auto height = [](double x, double y) { return -0.8 * x + 6.0 * std::sin(0.1 * x) * std::cos(0.13 * y); };
  const auto thickness = [](double x, double y) { return std::max(0.0, 20.0 - 0.3 * std::hypot(x, y)); };
  return Simulation<3>(case_on_dem(release, sets),
                       site_of(raster_between(Place(-100.0, -100.0), Place(100.0, 100.0), 4.0, height),
                               thickness_between(Place(-80.0, -80.0), Place(80.0, 80.0), 2.0, thickness)));
}

// Displacement of `displaced` relative to `regular`, component after component [m].
std::vector<double> displacements(const Fields& displaced, const Fields& regular) {
  std::vector<double> differences = displaced.at("position");
  EXPECT_EQ(differences.size(), regular.at("position").size());
  for (std::size_t k = 0; k < differences.size(); ++k) {
    differences[k] -= regular.at("position")[k];
  }
  return differences;
}

TEST(StartingNoise, IsZeroByDefault) {
  const Fields fields = on_flat_ground({});
  const auto& positions = fields.at("position");
  for (std::size_t k = 0; k < positions.size(); ++k) {
    if (fields.at("body")[k / 2] != 0.0) {
      continue;  // columns of the wedge have the height of its oblique side
    }
    const double in_spacings = (positions[k] + 50.0) / spacing;
    EXPECT_NEAR(in_spacings - std::floor(in_spacings), 0.5, 1e-12) << "component " << k;
  }
}

TEST(StartingNoise, DisplacesWithinItsBoundEvenlyAndChangesNothingElse) {
  const Fields regular = on_flat_ground({}), displaced = on_flat_ground(noise(0.2, 3));
  const double bound = 0.2 * spacing;
  const std::vector<double> found = displacements(displaced, regular);
  const double count = 0.5 * static_cast<double>(found.size());
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double sum = 0.0, least = HUGE_VAL, greatest = -HUGE_VAL;
    for (std::size_t k = axis; k < found.size(); k += 2) {
      sum += found[k];
      least = std::min(least, found[k]);
      greatest = std::max(greatest, found[k]);
    }
    EXPECT_NEAR(sum / count, 0.0, 4.0 * bound / std::sqrt(3.0 * count)) << "axis " << axis;
    EXPECT_NEAR(least, -bound, 0.02 * bound) << "axis " << axis;
    EXPECT_GE(least, -bound * (1.0 + 1e-12)) << "axis " << axis;
    EXPECT_NEAR(greatest, bound, 0.02 * bound) << "axis " << axis;
    EXPECT_LE(greatest, bound * (1.0 + 1e-12)) << "axis " << axis;
  }
  for (const char* field : {"mass", "volume", "initial_volume", "temperature", "porosity", "stress", "velocity"}) {
    EXPECT_EQ(displaced.at(field), regular.at(field)) << field;
  }
}

TEST(StartingNoise, DependsOnTheSeedAndThePositionInTheBody) {
  const Fields first = on_flat_ground(noise(0.2, 3));
  EXPECT_EQ(on_flat_ground(noise(0.2, 3)).at("position"), first.at("position"));
  const Fields other = on_flat_ground(noise(0.2, 4));
  std::size_t alike = 0;
  for (std::size_t k = 0; k < first.at("position").size(); ++k) {
    alike += other.at("position")[k] == first.at("position")[k] ? 1 : 0;
  }
  EXPECT_LT(alike, first.at("position").size() / 50) << "but for particles that may not leave the wedge";
  // A wider domain and another body, later in the alphabet, have no effect.
  const Fields in_wider = on_flat_ground(
      noise(0.2, 3) + "grid.min=[-150,-70]; body.zone.material=rock; body.zone.min=[520,0]; body.zone.max=[540,20]");
  ASSERT_GT(in_wider.at("position").size(), first.at("position").size());
  for (std::size_t k = 0; k < first.at("position").size(); ++k) {
    EXPECT_NEAR(in_wider.at("position")[k], first.at("position")[k], 1e-9);
  }
}

TEST(StartingNoise, KeepsParticlesInTheirPolygon) {
  const Fields regular = on_flat_ground({}), displaced = on_flat_ground(noise(0.49, 2));
  const std::vector<double> found = displacements(displaced, regular);
  std::size_t in_wedge = 0, kept = 0;
  for (std::size_t p = 0; p < displaced.at("body").size(); ++p) {
    const double x = displaced.at("position")[2 * p], height = displaced.at("position")[2 * p + 1];
    EXPECT_GT(height, 0.0);
    if (displaced.at("body")[p] == 1.0) {
      ++in_wedge;
      EXPECT_LT(height, 0.25 * x + 1e-6) << "x = " << x;
      EXPECT_LE(x, 400.0);
      kept += found[2 * p] == 0.0 && found[2 * p + 1] == 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, in_wedge / 10);
}

TEST(StartingNoise, KeepsAReleaseBetweenTheGroundAndItsTop) {
  const auto simulation = on_slope(noise(0.49, 1));
  const Fields regular = fields_of(on_slope({})), displaced = fields_of(simulation);
  const std::vector<double> found = displacements(displaced, regular);
  const Position& origin = simulation.model().origin;
  const ReleaseBody body(simulation.site().releases, "slide", *simulation.model().ground, origin);
  const std::size_t count = displaced.at("mass").size();
  std::size_t kept = 0;
  for (std::size_t p = 0; p < count; ++p) {
    const auto& at = displaced.at("position");
    const Position place(at[3 * p], at[3 * p + 1], at[3 * p + 2]),
        displacement(found[3 * p], found[3 * p + 1], found[3 * p + 2]);
    EXPECT_LE(displacement.lpNorm<Eigen::Infinity>(), 0.49 * spacing * (1.0 + 1e-12));
    if (displacement.norm() == 0.0) {
      ++kept;
    } else {
      EXPECT_TRUE(body.contains(place)) << place.transpose();
    }
  }
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, count / 3);
  EXPECT_EQ(displaced.at("mass"), regular.at("mass"));
}

}  // namespace
}  // namespace thawslide::sim
