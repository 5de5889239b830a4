// Strength that decreases with plastic strain: closed forms, and the fracture energy.
#include "physics/softening.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "../support/record.hpp"
#include "stress_return.hpp"

namespace thawslide::physics {
namespace {

using Tensor = SymmetricTensor<double>;
const Elastic elastic = Elastic::from_young_poisson(5e8, 0.2);
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pressure = 1e6;  // of the element before shearing [Pa]

double sine_of(double degrees) { return std::sin(degrees * pi / 180.0); }

// Strength: c [Pa] and sin(phi) after a plastic strain, from their definitions.
struct Softened {
  double cohesion, sine;
};
Softened softened(const Strength& strength, double plastic_strain) {
  const double fraction = std::exp(-plastic_strain / strength.softening_strain);
  const double first = sine_of(strength.friction_angle), last = sine_of(strength.residual_friction_angle);
  return {strength.residual_cohesion + (strength.cohesion - strength.residual_cohesion) * fraction,
          last + (first - last) * fraction};
}

struct Sheared {
  double largest_difference = 0;  // of the radius of Mohr's circle from the closed form, relative to the latter
  double plastic_strain = 0, work = 0;
  double first_radius = 0, last_radius = 0;  // [Pa]
};

// An element under isotropic pressure in plane strain, sheared in equal steps of shear strain (half the angle). Without
// dilation the mean of its in-plane stresses is constant, and the radius of Mohr's circle is therefore c cos(phi) + p
// sin(phi).
template <class Law>
Sheared shear(const Strength& strength, double step, int steps, Executor executor = Executor::device) {
  const auto law = Law::make(elastic, strength);
  Tensor stress;
  stress << -pressure, -pressure, -pressure, 0, 0, 0;
  Sheared result;
  for (int k = 0; k < steps; ++k) {
    Tensor strain = Tensor::Zero();
    strain[0] = 0.6 * step;  // strain axes oblique to those of the element, to test the principal axes
    strain[1] = -0.6 * step;
    strain[3] = 0.8 * step;
    const auto now =
        returned_by<2>(executor, law, {Tensor(stress + stress_increment(elastic, strain))}, result.plastic_strain)[0];
    stress = now.stress;
    const double radius = std::hypot(0.5 * (stress[0] - stress[1]), stress[3]);
    if (now.yielded) {
      const auto [cohesion, sine] = softened(strength, result.plastic_strain);
      const double exact = cohesion * std::sqrt(1.0 - sine * sine) + pressure * sine;
      result.largest_difference = std::max(result.largest_difference, std::abs(radius - exact) / exact);
      result.first_radius = result.first_radius > 0.0 ? result.first_radius : radius;
    }
    result.last_radius = radius;
    result.plastic_strain += now.equivalent_plastic_strain_increment;
    result.work += now.plastic_work_density;
  }
  return result;
}

TEST(Softening, AShearedElementHasTheStrengthOfItsPlasticStrain) {
  verification::Record record("Strength after plastic strain",
                              "An element under even pressure p in plane strain is sheared. In each step its stress is "
                              "that of the cohesion and "
                              "the friction angle which the plastic strain before the step has left.",
                              "(s1 - s3)/2 = c cos phi + p sin phi, c and sin phi by exp(-eps/eps_c)",
                              "Eq. 11 and the softening law");
  const auto expect = [&]<class Law>(const Strength& strength, Law /*law*/, double last_radius) {
    const Sheared sheared = shear<Law>(strength, 1e-5, 20000),
                  on_cpu = shear<Law>(strength, 1e-5, 20000, Executor::cpu);
    EXPECT_GT(sheared.plastic_strain, 10.0 * std::min(strength.softening_strain, 0.02));
    EXPECT_GT(sheared.first_radius, 1.1 * sheared.last_radius);
    if (strength.softening_strain < 0.1) {
      EXPECT_NEAR(sheared.last_radius, last_radius, 1e-3 * last_radius) << "broken";
    }
    record.expect_near(
        fmt::format("largest difference over the strength; eps_c {}, c {} to {} MPa, phi {} to {} degrees",
                    strength.softening_strain, strength.cohesion / 1e6, strength.residual_cohesion / 1e6,
                    strength.friction_angle, strength.residual_friction_angle),
        std::max(sheared.largest_difference, on_cpu.largest_difference), 0.0, 1e-10);
  };
  const double broken = pressure * sine_of(25.0);
  for (const double strain : {0.005, 0.02, 1.0}) {
    expect(Strength{40, 0, 1e6, 5e4, infinity, strain}, MohrCoulomb<>(),
           5e4 * std::sqrt(1.0 - sine_of(40) * sine_of(40)) + pressure * sine_of(40));
    expect(Strength{40, 0, 1e6, 0, infinity, strain, 25}, MohrCoulomb<true>(), broken);
  }
}

// Work of shearing in excess of that of the broken material: sqrt(3) eps_c times the loss of strength.
TEST(Softening, DissipatesTheEnergyOfTheLostStrength) {
  verification::Record record(
      "Energy of softening",
      "The same element; the plastic work per volume, of the cohesion's loss and of the friction's.",
      "W = sqrt(3) [R_f eps + (R_0 - R_f) eps_c (1 - exp(-eps/eps_c))], R the radius of Mohr's circle",
      "integral of the strength over the plastic shear strain, which is sqrt(3) eps");
  const auto error = [](const Sheared& sheared, double strain, double first, double last) {
    const double exact =
        std::sqrt(3.0) *
        (last * sheared.plastic_strain + (first - last) * strain * (1.0 - std::exp(-sheared.plastic_strain / strain)));
    return std::abs(sheared.work - exact) / exact;
  };
  const double cosine = std::sqrt(1.0 - sine_of(35) * sine_of(35)), strain = 0.01;
  std::vector<double> of_cohesion, of_friction;
  const std::vector<double> steps{4e-4, 2e-4, 1e-4};
  for (const double step : steps) {
    const int count = static_cast<int>(std::lround(0.04 / step));
    of_cohesion.push_back(error(shear<MohrCoulomb<>>({35, 0, 1e6, 2e4, infinity, strain}, step, count), strain,
                                1e6 * cosine + pressure * sine_of(35), 2e4 * cosine + pressure * sine_of(35)));
    of_friction.push_back(error(shear<MohrCoulomb<true>>({35, 0, 0, 0, infinity, strain, 20}, step, count), strain,
                                pressure * sine_of(35), pressure * sine_of(20)));
  }
  record.expect_near("relative error, of cohesion", of_cohesion.back(), 0.0, 0.005);
  record.expect_near("relative error, of friction", of_friction.back(), 0.0, 0.005);
  record.expect_order("strain a step", {1.0, 0.5, 0.25}, "relative error, of cohesion", of_cohesion, 1.0, 0.1);
  record.expect_order("strain a step", {1.0, 0.5, 0.25}, "relative error, of friction", of_friction, 1.0, 0.1);
  record.explain("Strength is held within a step, so that the work is of first order in the step.");
}

// A layer under shear in which one cell softens and the rest remains elastic. At a traction tau its top has moved by
// tau H/G + sqrt(3) h eps, and beyond the peak eps = eps_c ln((R_0 - R_f)/(tau - R_f)). With eps_c derived from a slip,
// the cell size cancels.
TEST(Softening, OverASlipIsIndependentOfTheCell) {
  verification::Record record("Shear layer that softens over a slip",
                              "A layer of height H under even pressure p is sheared. One cell of height h yields, the "
                              "rest is elastic. The displacement of its top after the peak, and the energy taken per "
                              "area, for h = H/2, H/4 and H/8.",
                              "u = tau H/G + s_c ln((R_0 - R_f)/(tau - R_f)), W = R_f s + (R_0 - R_f) s_c (1 - "
                              "exp(-s/s_c))",
                              "the softening law with eps_c = s_c/(sqrt(3) h); crack band, Bazant and Oh (1983)");
  constexpr double height = 40.0, slip = 0.5, step = 2e-5, cohesion = 1e6, residual = 2e4;
  const double cosine = std::sqrt(1.0 - sine_of(35) * sine_of(35));
  const double first = cohesion * cosine + pressure * sine_of(35), last = residual * cosine + pressure * sine_of(35);
  for (const double cell : {20.0, 10.0, 5.0}) {
    const double strain = softening_strain_of_slip(slip, cell);
    const int count = static_cast<int>(std::lround(3.0 * slip / (2.0 * step * cell)));  // a slip of about 3 s_c
    const Sheared sheared = shear<MohrCoulomb<>>({35, 0, cohesion, residual, infinity, strain}, step, count);
    const double slipped = std::sqrt(3.0) * cell * sheared.plastic_strain;
    const double displacement = sheared.last_radius * height / elastic.shear_modulus + slipped;
    const double exact = sheared.last_radius * height / elastic.shear_modulus +
                         slip * std::log((first - last) / (sheared.last_radius - last));
    const double energy = last * slipped + (first - last) * slip * (1.0 - std::exp(-slipped / slip));
    EXPECT_GT(slipped, 2.5 * slip);
    record.expect_near(fmt::format("displacement over the exact, h {} m", cell), displacement / exact, 1.0, 0.005);
    record.expect_near(fmt::format("energy over the exact, h {} m", cell), cell * sheared.work / energy, 1.0, 0.005);
  }
}

// In a cell as wide as the limit, the displacement still grows while the traction decreases; in a wider one it does
// not.
TEST(Softening, TheWidestCellIsTheLimitOfSnapBack) {
  constexpr double slip = 0.02;
  const double loss = (1e6 - 2e4) * std::sqrt(1.0 - sine_of(35) * sine_of(35));
  const double widest = widest_softening_cell(slip, elastic.shear_modulus, loss);
  const auto grows = [&](double cell) {
    const double strain = softening_strain_of_slip(slip, cell), few = 1e-4 * strain;
    const double fall = loss * (1.0 - std::exp(-few / strain));
    return std::sqrt(3.0) * cell * few - fall * cell / elastic.shear_modulus > 0.0;
  };
  EXPECT_TRUE(grows(0.999 * widest));
  EXPECT_FALSE(grows(1.001 * widest));
}

// If friction decreases, the return equals that of material with the remaining angle and cohesion from the start.
TEST(Softening, ReturnsWithTheRemainingStrength) {
  std::mt19937 random(31);
  std::normal_distribution<double> normal(0.0, 2e6);
  std::uniform_real_distribution<double> strains(0.0, 0.1);
  for (const Strength& strength : {Strength{40, 0, 1e6, 1e5, infinity, 0.02, 20},
                                   Strength{35, 15, 4e5, 0, 1e5, 0.03, 15}, Strength{30, 0, 2e5, 5e4, 2e5, 0.05, 0}}) {
    const auto law = MohrCoulomb<true>::make(elastic, strength);
    int yielded = 0, skipped = 0;
    for (int k = 0; k < 5000; ++k) {
      Tensor trial;
      for (int c = 0; c < 6; ++c) {
        trial[c] = normal(random) - (c < 3 ? 1e6 : 0.0);
      }
      const bool plane = k % 2 == 0;
      trial[4] *= plane ? 0.0 : 1.0;
      trial[5] *= plane ? 0.0 : 1.0;
      const double plastic_strain = k % 10 == 0 ? 0.0 : strains(random);
      const auto [cohesion, sine] = softened(strength, plastic_strain);
      const double angle = std::asin(sine) * 180.0 / pi;
      const auto left = MohrCoulomb<>::make(
          elastic, {angle, std::min(strength.dilation_angle, angle), cohesion, cohesion, strength.tension_cutoff});
      const auto found = plane ? law.update<2>(trial, plastic_strain) : law.update<3>(trial, plastic_strain);
      const auto expected = plane ? left.update<2>(trial, 0.0) : left.update<3>(trial, 0.0);
      const double size = trial.cwiseAbs().maxCoeff() + 1e6;
      EXPECT_EQ(found.yielded, expected.yielded);
      EXPECT_LT((found.stress - expected.stress).cwiseAbs().maxCoeff(), 1e-10 * size) << k;
      EXPECT_NEAR(found.opening, expected.opening, 1e-12);
      yielded += found.yielded ? 1 : 0;
      const bool may_yield = plane ? law.may_yield<2>(trial, plastic_strain) : law.may_yield<3>(trial, plastic_strain);
      EXPECT_TRUE(may_yield || !found.yielded) << k;
      skipped += may_yield ? 0 : 1;
    }
    EXPECT_GT(yielded, 1000);
    EXPECT_GT(skipped, 20) << "elastic states are detected";
  }
}

}  // namespace
}  // namespace thawslide::physics
