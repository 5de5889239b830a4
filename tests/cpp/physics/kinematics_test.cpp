#include "physics/kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "physics/elasticity.hpp"

namespace thawslide::physics {
namespace {

TEST(Kinematics, RigidRotationGivesNoStrainAndAnExactRotation) {
  for (const double angle : {1e-3, 0.1, 1.0, 2.5}) {
    Matrix<double, 2> turn;
    turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    const auto increment = strain_increment<double, 2>(turn - Matrix<double, 2>::Identity());
    EXPECT_LT(increment.strain.norm(), 1e-14);
    EXPECT_LT((increment.rotation - turn).norm(), 1e-13) << angle;
    EXPECT_NEAR(increment.volume_ratio, 1.0, 1e-14);
  }
}

TEST(Kinematics, StressTurnsWithTheBody) {
  // A full turn in 360 steps restores a stress; principal values never change.
  const double angle = 2.0 * pi / 360.0;
  Matrix<double, 3> turn;
  turn << std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1;
  SymmetricTensor<double> start;
  start << 3e5, -1e5, 2e5, 4e4, -3e4, 6e4;
  SymmetricTensor<double> stress = start;
  for (int k = 0; k < 360; ++k) {
    stress = rotate<double, 3>(stress, strain_increment<double, 3>(turn - Matrix<double, 3>::Identity()).rotation);
  }
  EXPECT_LT((stress - start).norm(), 1e-6);
}

TEST(Kinematics, StretchIsTheLogarithmToThirdOrder) {
  double previous = 0.0;
  for (const double stretch : {0.1, 0.05, 0.025}) {
    Matrix<double, 2> gradient = Matrix<double, 2>::Zero();
    gradient(0, 0) = stretch;
    const double error = std::abs(strain_increment<double, 2>(gradient).strain[0] - std::log1p(stretch));
    if (previous > 0.0) {
      EXPECT_GT(std::log2(previous / error), 2.8);
    }
    previous = error;
  }
}

TEST(Kinematics, PlaneIsThreeDimensionsWithoutTheThird) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(-0.2, 0.2);
  for (int k = 0; k < 100; ++k) {
    Matrix<double, 2> plane;
    plane << value(random), value(random), value(random), value(random);
    Matrix<double, 3> full = Matrix<double, 3>::Zero();
    full.topLeftCorner<2, 2>() = plane;
    const auto a = strain_increment<double, 2>(plane);
    const auto b = strain_increment<double, 3>(full);
    EXPECT_LT((a.strain - b.strain).norm(), 1e-15);
    EXPECT_NEAR(a.volume_ratio, b.volume_ratio, 1e-15);
  }
}

TEST(Elasticity, ModuliAndUniaxialStrain) {
  const auto elastic = Elastic::from_young_poisson(1e7, 0.3);
  SymmetricTensor<double> strain = SymmetricTensor<double>::Zero();
  strain[0] = 1e-3;
  strain[3] = 2e-3;
  const auto stress = stress_increment(elastic, strain);
  EXPECT_NEAR(stress[0], 1e7 * 0.7 / (1.3 * 0.4) * 1e-3, 1e-6);
  EXPECT_NEAR(stress[1] / stress[0], 0.3 / 0.7, 1e-12);
  EXPECT_NEAR(stress[3], 2.0 * 1e7 / 2.6 * 2e-3, 1e-6);
  EXPECT_NEAR(elastic.p_wave_modulus(), stress[0] / 1e-3, 1e-3);
}

TEST(ElasticEnergy, IsThatOfOneModulusInSimpleStates) {
  constexpr double young = 5e8, poisson = 0.2, stress = -3e6;
  const auto elastic = Elastic::from_young_poisson(young, poisson);
  SymmetricTensor<double> along_x = SymmetricTensor<double>::Zero(), shear = along_x, all_round = along_x;
  along_x[0] = stress;
  shear[3] = stress;
  all_round[0] = all_round[1] = all_round[2] = stress;
  const double bulk = young / (3.0 * (1.0 - 2.0 * poisson));
  EXPECT_DOUBLE_EQ(elastic_energy_density(elastic, along_x), stress * stress / (2.0 * young));
  EXPECT_DOUBLE_EQ(elastic_energy_density(elastic, shear), stress * stress / (2.0 * elastic.shear_modulus));
  EXPECT_NEAR(elastic_energy_density(elastic, all_round), stress * stress / (2.0 * bulk),
              1e-9 * stress * stress / bulk);
}

// Half of stress times strain, for any strain.
TEST(ElasticEnergy, IsTheWorkDoneByTheStress) {
  const auto elastic = Elastic::from_young_poisson(2e9, 0.3);
  SymmetricTensor<double> strain;
  strain << 1e-3, -2e-3, 5e-4, 3e-4, -7e-4, 1e-4;
  const SymmetricTensor<double> stress = stress_increment(elastic, strain);
  double work = 0.0;
  for (int c = 0; c < 6; ++c) {
    work += 0.5 * (c < 3 ? 1.0 : 2.0) * stress[c] * strain[c];
  }
  EXPECT_NEAR(elastic_energy_density(elastic, stress), work, 1e-12 * work);
}

}  // namespace
}  // namespace thawslide::physics
