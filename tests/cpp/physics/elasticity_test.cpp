// Elastic energy of a stress.
#include "physics/elasticity.hpp"

#include <gtest/gtest.h>

namespace thawslide::physics {
namespace {

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
