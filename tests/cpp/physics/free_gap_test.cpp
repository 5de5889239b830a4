// Reason for the step limit with the density of the closed gap: the stress of torn material does not change with strain
// before its gap has closed, and its volume is then that of t = 0.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "physics/elasticity.hpp"
#include "physics/kinematics.hpp"
#include "physics/mohr_coulomb.hpp"
#include "physics/tension_gap.hpp"

namespace thawslide::physics {
namespace {

using Tensor = SymmetricTensor<double>;
using Square = Matrix<double, 3>;

constexpr double infinity = std::numeric_limits<double>::infinity();
const auto elastic = Elastic::from_young_poisson(5e8, 0.2);

// A cube of unit mass and volume that is torn apart and then strained at random.
template <bool friction_falls>
class Element {
 public:
  explicit Element(const Strength& strength) : law_(MohrCoulomb<friction_falls>::make(elastic, strength)) {}

  // Same update as in mpm/stress_kernel.hpp.
  void strain(const Square& gradient) {
    const auto increment = strain_increment<double, 3>(gradient);
    const double closing = closing_strain(gap, increment.strain[0] + increment.strain[1] + increment.strain[2]);
    const Tensor trial = stress + stress_increment(elastic, borne_strain(increment.strain, closing));
    const auto result = law_.update(trial, plastic_strain_);
    stress = result.stress;
    gap += result.opening - closing;
    plastic_strain_ += result.equivalent_plastic_strain_increment;
    volume *= increment.volume_ratio;
  }

  Tensor stress = Tensor::Zero();
  double gap = 0.0, volume = 1.0;

 private:
  MohrCoulomb<friction_falls> law_;
  double plastic_strain_ = 0.0;
};

struct Seen {
  double largest_change = 0.0, largest_volume_error = 0.0, largest_gap = 0.0;  // stress [Pa]
};

// Strains the softened material with its gap open. The change of stress is that since the gap was opened.
template <bool friction_falls>
Seen strained_at_random(const Strength& strength) {
  Element<friction_falls> element(strength);
  for (int k = 0; k < 100; ++k) {
    element.strain(Square::Identity() * 0.002);
  }
  const Tensor before = element.stress;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1e-3, 1e-3);
  Seen seen;
  for (int k = 0; k < 20000; ++k) {
    Square gradient;
    for (int i = 0; i < 9; ++i) {
      gradient(i / 3, i % 3) = part(random);
    }
    element.strain(gradient);
    if (element.gap > 0.01) {
      seen.largest_change = std::max(seen.largest_change, (element.stress - before).cwiseAbs().maxCoeff());
    }
    const double closed = 1.0 / density_with_gap_closed(1.0 / element.volume, element.gap);
    seen.largest_volume_error = std::max(seen.largest_volume_error, std::abs(closed - 1.0));
    seen.largest_gap = std::max(seen.largest_gap, element.gap);
  }
  return seen;
}

TEST(FreeGap, TornMaterialIsStressFreeWithoutDilationAndCutoff) {
  for (const auto& [strength, falls] : {std::pair(Strength{35.0, 0.0, 1e6, 1e6, infinity}, false),
                                        std::pair(Strength{35.0, 0.0, 0.0, 0.0, infinity}, false),
                                        std::pair(Strength{35.0, 0.0, 1e6, 5e3, infinity, 0.01}, false),
                                        std::pair(Strength{35.0, 0.0, 1e6, 5e3, infinity, 0.01, 30.0}, true)}) {
    ASSERT_TRUE(gap_is_free(strength));
    const Seen seen = falls ? strained_at_random<true>(strength) : strained_at_random<false>(strength);
    EXPECT_GT(seen.largest_gap, 0.5);
    EXPECT_LT(seen.largest_change, 1e-3) << "change of stress [Pa]; an elastic strain of 1e-3 gives 5e5";
    EXPECT_LT(seen.largest_volume_error, 0.01) << "elastic strain and round-off";
  }
}

TEST(FreeGap, DilationAndACutoffLetTornMaterialBearStress) {
  for (const auto& strength : {Strength{35.0, 10.0, 1e6, 1e6, infinity}, Strength{35.0, 0.0, 1e6, 1e6, 1e5}}) {
    EXPECT_FALSE(gap_is_free(strength));
    EXPECT_GT(strained_at_random<false>(strength).largest_change, 1e4);
  }
  const Strength apex_that_moves_away{35.0, 0.0, 1e6, 1e6, infinity, 0.3, 20.0};
  EXPECT_FALSE(gap_is_free(apex_that_moves_away));
  EXPECT_GT(strained_at_random<true>(apex_that_moves_away).largest_change, 1e4);
  const Strength apex_that_moves_away_and_back{40.0, 0.0, 1e6, 4.3e5, infinity, 0.3, 20.0};
  EXPECT_LT(4.3e5 / std::tan(20.0 * pi / 180.0), 1e6 / std::tan(40.0 * pi / 180.0));
  EXPECT_FALSE(gap_is_free(apex_that_moves_away_and_back));
}

}  // namespace
}  // namespace thawslide::physics
