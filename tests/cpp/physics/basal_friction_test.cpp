// Friction and cohesion of the ground, and contact at a node.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "physics/basal/laws.hpp"
#include "physics/contact.hpp"

namespace thawslide::physics {
namespace {

using namespace basal;
using Node = ContactNode;

// A law with parameters by key.
template <class Law>
Law law_from(const std::map<std::string, double>& numbers) {
  return Law::from([&](const Parameter& number) {
    const auto found = numbers.find(number.key);
    return found == numbers.end() ? number.initial : found->second;
  });
}

template <class Laws>
void expect_words_and_keys_to_be_unique() {
  std::set<std::string> words;
  std::map<std::string, const Parameter*> numbers;
  for_each_law<Laws>([&]<class Law>(OfType<Law>) {
    EXPECT_TRUE(words.insert(Law::keyword).second) << Law::keyword;
    EXPECT_FALSE(std::string(Law::text).empty()) << Law::keyword;
    for (const Parameter* number : Law::parameters) {
      EXPECT_EQ(numbers.emplace(number->key, number).first->second, number) << Law::keyword << " " << number->key;
      EXPECT_FALSE(std::string(number->text).empty()) << number->key;
      EXPECT_TRUE(number->is_needed ||
                  (number->low_open ? number->initial > number->low
                                    : number->initial >= number->low && number->initial <= number->high))
          << number->key << ": the default is outside its range";
    }
  });
  EXPECT_EQ(words.size(), std::variant_size_v<Laws>);
}

TEST(BasalLaws, KeywordsAndKeysAreUnique) {
  expect_words_and_keys_to_be_unique<FrictionLaw>();
  expect_words_and_keys_to_be_unique<CohesionLaw>();
}

TEST(LubricatedFriction, IsEquation25) {
  // Frozen at a porosity of 0.375 (n_e = 0.75): 1 - (1 - 0.875)^2 = 0.984375, times tan 40 degrees = 0.826 as in
  // Sec. 3.3.
  const auto at = [](double solid_fraction, double exponent) {
    return LubricatedFriction{1.0, exponent, 0.05, 0.85}.coefficient(Node{.solid_fraction = solid_fraction});
  };
  EXPECT_NEAR(at(0.75, 2.0), 0.984375, 1e-14);
  EXPECT_EQ(at(0.04, 2.0), 0.0);
  EXPECT_EQ(at(0.90, 2.0), 1.0);
  EXPECT_NEAR(at(0.45, 1.5), 1.0 - std::pow(0.5, 1.5), 1e-14);
  const auto of_the_paper = law_from<LubricatedFriction>({{"friction_angle", 40.0}});
  EXPECT_NEAR(of_the_paper.coefficient(Node{.solid_fraction = 0.75}), 0.826, 5e-4);
}

TEST(ConstantFriction, IsTheTangent) {
  EXPECT_DOUBLE_EQ(law_from<ConstantFriction>({{"friction_angle", 45.0}}).coefficient(Node{}), 1.0);
}

TEST(VoellmyFriction, AddsADragIndependentOfTheLoad) {
  const auto law = law_from<VoellmyFriction>({{"friction_coefficient", 0.155}, {"turbulent_friction", 4000.0}});
  EXPECT_EQ(law.coefficient(Node{.normal_pressure = 1e5, .speed = 50.0}), 0.155);
  // Snow of 200 kg/m3 at 40 m/s: 200 9.81 1600/4000 = 784.8 Pa.
  EXPECT_DOUBLE_EQ(law.drag(Node{.speed = 40.0, .unit_weight = 200.0 * 9.81}), 784.8);
  EXPECT_EQ(law.drag(Node{.normal_pressure = 1e5, .unit_weight = 2e4}), 0.0) << "none at rest";
  const Node node{.normal_pressure = 1e5, .pore_pressure = 5e4, .speed = 7.0, .unit_weight = 2e4};
  EXPECT_DOUBLE_EQ(law.drag(node), law.drag(Node{.speed = 7.0, .unit_weight = 2e4})) << "independent of N and P";
  EXPECT_DOUBLE_EQ(drag_of(law, node), law.drag(node));
  EXPECT_EQ(drag_of(ConstantFriction{0.5}, node), 0.0);
}

// For any speed, xi, step and depth per area of base, friction at most stops the node.
TEST(VoellmyFriction, NeverReversesTheSlip) {
  constexpr double density = 2000.0, gravity = 9.81;
  for (const double turbulence : {1e-3, 1.0, 100.0, 5000.0}) {
    const VoellmyFriction law{0.2, turbulence};
    for (const double speed : {1e-6, 0.1, 10.0, 300.0}) {
      for (const double dt : {1e-4, 1e-2, 1.0}) {
        for (const double depth : {1e-3, 1.0, 50.0}) {
          const double load = density * gravity * depth, momentum = density * depth * speed;
          const double strength = sliding_strength(0.2, load, 0.0, 0.0, FrictionClamp::keep_cohesion, false) +
                                  law.drag(Node{.speed = speed, .unit_weight = density * gravity});
          const auto impulse = contact_impulse(load * dt, momentum, 1.0, dt, strength);
          EXPECT_LE(impulse.tangential, momentum);
          EXPECT_GT(impulse.tangential, 0.0);
          EXPECT_EQ(impulse.slides, strength * dt < momentum);
        }
      }
    }
  }
}

TEST(SlidingStrength, TheTwoClampsDifferOnlyIfPressureExceedsN) {
  using enum FrictionClamp;
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 4.0, 2.0, keep_cohesion, false), 5.0);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 4.0, 2.0, joint, false), 5.0);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 13.0, 2.0, keep_cohesion, false), 2.0);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 13.0, 2.0, joint, false), 0.5);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 15.0, 2.0, joint, false), 0.0) << "never negative";
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 15.0, 2.0, joint, true), 2.0) << "P capped at N";
}

TEST(Cohesion, Laws) {
  const std::map<std::string, double> numbers{
      {"cohesion", 6e5}, {"residual_cohesion", 1e5}, {"slip_distance", 400.0}, {"cohesion_loss_time", 10.0}};
  EXPECT_EQ(law_from<ConstantCohesion>(numbers).cohesion(Node{.slip = 1e9, .time = 1e9}), 6e5);
  const auto slip = law_from<SlipCohesion>(numbers);
  EXPECT_DOUBLE_EQ(slip.cohesion(Node{.slip = 0.0}), 6e5);
  EXPECT_NEAR(slip.cohesion(Node{.slip = 400.0}), 1e5 + 5e5 * std::exp(-1.0), 1e-6);
  EXPECT_DOUBLE_EQ(law_from<IceCohesion>(numbers).cohesion(Node{.saturation = 0.25}), 4.5e5);
  const auto time = law_from<TimeCohesion>(numbers);
  EXPECT_DOUBLE_EQ(time.cohesion(Node{.time = 9.99}), 6e5);
  EXPECT_DOUBLE_EQ(time.cohesion(Node{.time = 10.0}), 1e5);
}

// Simpson's rule over the slip: the energy dissipated by sliding, while all is frozen, is c_0 d_c.
TEST(Cohesion, BondsDissipateTheirEnergyOnce) {
  const double initial = 1.9e5, distance = 20.0;
  const auto bonds = law_from<BondsCohesion>({{"cohesion", initial}, {"slip_distance", distance}});
  const int parts = 4000;
  const double slip = 50.0 * distance, part = slip / parts;
  double energy = 0.0;
  for (int k = 0; k <= parts; ++k) {
    energy += (k == 0 || k == parts ? 1.0
               : k % 2 == 1         ? 4.0
                                    : 2.0) *
              part / 3.0 * bonds.cohesion(Node{.slip = k * part});
  }
  EXPECT_NEAR(energy / (initial * distance), 1.0, 1e-9);
  EXPECT_EQ(bonds.cohesion(Node{}), initial);
  EXPECT_DOUBLE_EQ(bonds.cohesion(Node{.saturation = 0.75, .slip = distance}), 0.25 * initial * std::exp(-1.0));
  EXPECT_EQ(bonds.cohesion(Node{.saturation = 1.0}), 0.0);
}

TEST(Contact, SticksBelowTheStrengthAndSlidesAboveIt) {
  const auto sticks = contact_impulse(8.0, 3.0, 2.0, 0.5, 3.0);
  EXPECT_FALSE(sticks.slides);
  EXPECT_EQ(sticks.tangential, 3.0);
  const auto slides = contact_impulse(8.0, 3.1, 2.0, 0.5, 3.0);
  EXPECT_TRUE(slides.slides);
  EXPECT_EQ(slides.tangential, 3.0);
  EXPECT_EQ(slides.normal, 8.0);
}

// Contact of two bodies at a node: conservation and onset.
constexpr double mass = 3.0, other_mass = 5.0, dt = 0.01;

TEST(BodyContact, ActsOnApproachingBodiesOnly) {
  for (const double closing : {-4.0, -1e-9, 0.0}) {
    const auto impulse = body_impulse(mass, other_mass, closing, 2.0, 0.0, dt, 0.5);
    EXPECT_EQ(impulse.normal, 0.0);
    EXPECT_EQ(impulse.tangential, 0.0) << "friction needs a load";
  }
}

TEST(BodyContact, ActsAfterTheGapHasClosed) {
  // In 0.01 s, bodies that approach at 2 m/s get 0.02 m closer.
  EXPECT_EQ(body_impulse(mass, other_mass, 2.0, 0.0, 0.02, dt, 0.0).normal, 0.0);
  EXPECT_EQ(body_impulse(mass, other_mass, 2.0, 0.0, 0.5, dt, 0.0).normal, 0.0);
  for (const double gap : {0.0, 0.005, 0.015}) {
    const double normal = body_impulse(mass, other_mass, 2.0, 0.0, gap, dt, 0.0).normal;
    const double closing_after = 2.0 - normal * (1.0 / mass + 1.0 / other_mass);
    EXPECT_NEAR(closing_after * dt, gap, 1e-15) << "the step ends with the bodies edge to edge";
  }
  EXPECT_EQ(body_impulse(mass, other_mass, 2.0, 0.0, -0.3, dt, 0.0).normal,
            body_impulse(mass, other_mass, 2.0, 0.0, 0.0, dt, 0.0).normal)
      << "bodies that overlap are not pushed apart";
}

TEST(BodyContact, SticksUpToCoulombsLimit) {
  const double slip = 1.5, reduced = mass * other_mass / (mass + other_mass);
  for (const double friction : {0.0, 0.2, 0.74}) {  // 0.75 stops the sliding
    const auto slides = body_impulse(mass, other_mass, 2.0, slip, 0.0, dt, friction);
    EXPECT_DOUBLE_EQ(slides.tangential, friction * slides.normal);
    EXPECT_LT(slides.tangential, reduced * slip);
  }
  const auto sticks = body_impulse(mass, other_mass, 2.0, slip, 0.0, dt, 0.76);
  EXPECT_DOUBLE_EQ(sticks.tangential, reduced * slip);
  EXPECT_NEAR(slip - sticks.tangential * (1.0 / mass + 1.0 / other_mass), 0.0, 1e-15);
}

TEST(BodyContact, IsTheSameForEitherBody) {
  const auto one = body_impulse(mass, other_mass, 2.0, 1.5, 0.003, dt, 0.3);
  const auto other = body_impulse(other_mass, mass, 2.0, 1.5, 0.003, dt, 0.3);
  EXPECT_EQ(one.normal, other.normal);
  EXPECT_EQ(one.tangential, other.tangential);
}

// A fixed body is one of infinite mass.
TEST(BodyContact, StopsABodyAtAFixedOne) {
  for (const double friction : {0.0, 0.3, 1e300}) {
    const auto fixed = impulse_on_fixed_body(mass, 2.0, 1.5, 0.003, dt, friction);
    const auto heavy = body_impulse(mass, 1e18, 2.0, 1.5, 0.003, dt, friction);
    EXPECT_DOUBLE_EQ(fixed.normal, heavy.normal);
    EXPECT_DOUBLE_EQ(fixed.tangential, heavy.tangential);
  }
  EXPECT_EQ(impulse_on_fixed_body(mass, 2.0, 1.5, 0.0, dt, 1e300).normal, 2.0 * mass);
  EXPECT_EQ(impulse_on_fixed_body(mass, 2.0, 1.5, 0.0, dt, 1e300).tangential, 1.5 * mass) << "it sticks";
  EXPECT_EQ(impulse_on_fixed_body(mass, -2.0, 1.5, 0.0, dt, 1e300).tangential, 0.0);
}

}  // namespace
}  // namespace thawslide::physics
