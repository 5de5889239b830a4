// The substrate at a position, and the result of its laws at a contact node.
#include "terrain/substrates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "exec/cpu.hpp"
#include "terrain/basal_law.hpp"

namespace thawslide::terrain {
namespace {

using Ring = Substrates::Ring;

Ring box(double min_x, double min_y, double max_x, double max_y) {
  return {{min_x, min_y}, {max_x, min_y}, {max_x, max_y}, {min_x, max_y}, {min_x, min_y}};
}

TEST(SubstratesOnGround, AreStripsAlongX) {
  Substrates substrates({100.0, 0.0});
  substrates.add_strip(2, -HUGE_VAL, 110.0);
  substrates.add_strip(1, 120.0, 130.0);
  for (const auto& [x, number] : {std::pair(-1e6, 2), {9.999, 2}, {10.0, 0}, {19.999, 0}, {20.0, 1}, {30.0, 0}}) {
    EXPECT_EQ(substrates.at(x, 7.0), number) << x;
  }
}

TEST(SubstratesOnGround, ExcludeHolesOfOutlines) {
  Substrates substrates({1000.0, 500.0});
  substrates.add_rings(3, {box(1000.0, 500.0, 1010.0, 510.0), box(1004.0, 504.0, 1006.0, 506.0)});
  for (int i = -2; i < 12; ++i) {
    for (int j = -2; j < 12; ++j) {
      const double x = i + 0.5, y = j + 0.5;
      const bool inside = x > 0.0 && x < 10.0 && y > 0.0 && y < 10.0;
      const bool in_hole = x > 4.0 && x < 6.0 && y > 4.0 && y < 6.0;
      EXPECT_EQ(substrates.at(x, y), inside && !in_hole ? 3 : 0) << x << ", " << y;
    }
  }
}

// Neighbours with an irregular border neither overlap nor leave gaps, also at the corners of the border.
TEST(SubstratesOnGround, AssignEachPositionToOneNeighbour) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> crooked(4.0, 6.0), anywhere(0.0, 10.0);
  Ring border;
  for (int k = 0; k <= 200; ++k) {
    border.push_back({crooked(random), 0.05 * k});
  }
  Ring left = border, right = border;
  left.insert(left.end(), {{0.0, 10.0}, {0.0, 0.0}, border.front()});
  right.insert(right.end(), {{10.0, 10.0}, {10.0, 0.0}, border.front()});
  Substrates one({0.0, 0.0}), other({0.0, 0.0});
  one.add_rings(1, {left});
  std::reverse(right.begin(), right.end());
  other.add_rings(1, {right});
  long in_left = 0;
  const auto expect_in_one = [&](double x, double y) {
    EXPECT_EQ(one.at(x, y) + other.at(x, y), 1) << x << ", " << y;
    in_left += one.at(x, y);
  };
  for (int k = 0; k < 20000; ++k) {
    expect_in_one(anywhere(random), anywhere(random));
  }
  EXPECT_NEAR(static_cast<double>(in_left) / 20000.0, 0.5, 0.02);
  for (const auto& corner : border) {
    if (corner[1] > 0.0 && corner[1] < 10.0) {
      expect_in_one(corner[0], corner[1]);
      EXPECT_EQ(one.at(corner[0] - 1e-6, corner[1]), 1);
      EXPECT_EQ(other.at(corner[0] + 1e-6, corner[1]), 1);
    }
  }
}

TEST(SubstratesOnGround, FollowTheirCodeInARaster) {
  Raster codes;
  codes.x = 105.0;
  codes.y = 205.0;
  codes.cell_x = codes.cell_y = 10.0;
  codes.columns = 3;
  codes.rows = 2;
  codes.values = {1.0, 2.0, std::nan(""), 2.0, 2.0, 4.0};
  const auto shared = std::make_shared<const Raster>(codes);
  Substrates substrates({100.0, 200.0});
  substrates.add_code(1, shared, 2.0);
  substrates.add_code(2, shared, 4.0);
  EXPECT_EQ(substrates.at(5.0, 5.0), 0) << "a code that none has";
  EXPECT_EQ(substrates.at(10.0, 0.0), 1);
  EXPECT_EQ(substrates.at(25.0, 5.0), 0) << "no data";
  EXPECT_EQ(substrates.at(19.999, 19.999), 1);
  EXPECT_EQ(substrates.at(20.0, 19.999), 2);
  EXPECT_EQ(substrates.at(-0.001, 15.0), 0) << "beyond the raster";
  EXPECT_EQ(substrates.at(30.0, 15.0), 0);
  EXPECT_EQ(substrates.at(5.0, 20.0), 0);
}

// Adjacent nodes of a block, each with the laws of the substrate below it.
TEST(BasalLaw, DependsOnTheSubstrateOfEachNode) {
  using namespace physics::basal;
  BasalLaw law;
  law.grounds = {{ConstantFriction{0.5}, ConstantCohesion{10.0}},
                 {CoefficientFriction{0.1}, ConstantCohesion{0.0}},
                 {ConstantFriction{1.0}, BondsCohesion{100.0, 2.0}},
                 {VoellmyFriction{0.2, 500.0}, ConstantCohesion{3.0}}};
  const std::array<int, 6> substrates{1, 0, 2, 1, 3, 3};
  const std::array<double, 6> pore_pressures{400.0, 400.0, 400.0, 1500.0, 400.0, 1500.0};
  exec::Cpu cpu;
  std::array<BasalNode, 6> nodes;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    nodes[k].area = 1.0;
    nodes[k].substrate = substrates[k];
    nodes[k].state.normal_pressure = 1000.0;
    nodes[k].state.pore_pressure = pore_pressures[k];
    nodes[k].state.saturation = 0.25;
    nodes[k].state.slip = 2.0;
    nodes[k].state.speed = 10.0;
    nodes[k].state.unit_weight = 20.0;
  }
  const auto strength = [&](std::size_t k) { return nodes[k].strength(law.clamp, law.cap_pressure); };
  evaluate_basal_law(cpu, law, nodes.data(), nodes.size());
  EXPECT_DOUBLE_EQ(strength(0), 100.0) << "0.1 N, independent of P";
  EXPECT_DOUBLE_EQ(strength(1), 310.0);
  EXPECT_DOUBLE_EQ(strength(2), 600.0 + 75.0 * std::exp(-1.0));
  EXPECT_DOUBLE_EQ(strength(3), 100.0);
  EXPECT_EQ(nodes[3].friction, 0.1);
  EXPECT_DOUBLE_EQ(strength(4), 0.2 * 600.0 + 20.0 * 100.0 / 500.0 + 3.0);
  EXPECT_DOUBLE_EQ(strength(5), 4.0 + 3.0) << "drag where P passes N";
  law.clamp = physics::FrictionClamp::joint;
  evaluate_basal_law(cpu, law, nodes.data(), nodes.size());
  EXPECT_DOUBLE_EQ(strength(5), 4.0) << "excess pressure cancels cohesion, not drag";
}

}  // namespace
}  // namespace thawslide::terrain
