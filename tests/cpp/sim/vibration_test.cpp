// Vibration of a bar in its first mode, at small amplitude: orders of convergence. A square with large displacements is
// in tests/cpp/verification.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A bar of 1 m between walls, in uniaxial stress (Poisson's ratio 0): v = V sin(pi x) cos(omega t), omega = pi c/L.
constexpr double bar_speed = 1e-3;                                                      // V [m/s]
const double bar_wave_speed = std::sqrt(1e7 / ((1.0 - 1e-6) * 2750.0 + 1e-6 * 917.0));  // c [m/s]

config::Case bar(int cells, const Sets& sets) {
  const double cell = 1.0 / cells;
  const Sets refined = fmt::format("time.step={}; grid.cell={}; grid.max=[1.0, {}]; body.block.max=[1.0, {}]",
                                   0.1 * cell / bar_wave_speed, cell, 2.0 * cell, 2.0 * cell);
  const Sets between_walls =
      "grid.boundary={x_min='roller',x_max='roller',y_min='roller',y_max='roller'}; material.rock.youngs_modulus=1e7; "
      "material.rock.poisson_ratio=0; body.block.min=[0,0]; body.block.porosity=1e-6";
  return published_case("free", between_walls + refined + sets);
}

struct Mode {
  double frequency;  // over the exact one
  double amplitude;  // of the velocity in the third period, over the first one's
  double stroke;     // of the displacement, over the exact one
};

// Three periods of mode 1. The frequency follows from zeros of the modal velocity.
Mode vibrate(int cells, const Sets& sets) {
  Simulation<2> simulation(bar(cells, sets));
  auto& particles = simulation.particles();
  std::vector<double> form(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    form[static_cast<std::size_t>(particles.id(p))] = std::sin(pi * particles.position(p, 0));
    particles.velocity(p, 0) = bar_speed * std::sin(pi * particles.position(p, 0));
    if (simulation.model().motion.transfer == mpm::TransferKind::apic) {
      particles.affine_velocity(p, 0) = bar_speed * pi * std::cos(pi * particles.position(p, 0));
    }
  }
  const auto modal = [&](const auto& field) {
    double sum = 0.0, norm = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double f = form[static_cast<std::size_t>(particles.id(p))];
      sum += f * field(p, 0);
      norm += f * f;
    }
    return sum / norm;
  };
  const double omega = pi * bar_wave_speed;
  const double period = 2.0 * pi / omega;
  std::vector<double> zeros;
  double old = modal(particles.velocity), largest_late = 0.0, highest = 0.0, lowest = 0.0;
  while (simulation.time() < 3.0 * period) {
    const double dt = simulation.parameters().time.step;
    simulation.step(dt);
    const double velocity = modal(particles.velocity), displacement = modal(particles.displacement);
    if (old * velocity < 0.0) {
      zeros.push_back(simulation.time() - dt * velocity / (velocity - old));
    }
    old = velocity;
    if (simulation.time() < period) {
      highest = std::max(highest, displacement);
      lowest = std::min(lowest, displacement);
    } else if (simulation.time() > 2.25 * period) {
      largest_late = std::max(largest_late, velocity);
    }
  }
  const double measured = 2.0 * (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
  return {period / measured, largest_late / bar_speed, 0.5 * (highest - lowest) * omega / bar_speed};
}

Mode vibrate_with(const std::string& shape, const std::string& transfer, int cells) {
  Sets sets{"mechanics.shape_function=" + shape, "mechanics.transfer=" + transfer};
  if (transfer == "fmpm") {
    sets = sets + "mechanics.fmpm_order=4; mechanics.fmpm_interval=0.005";
  }
  return vibrate(cells, sets);
}

// Order of convergence of an error from `coarse` to `fine` with half the cell.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

// The frequency converges in second order of the cell, for all transfers; the amplitude converges faster.
void expect_second_order(const std::string& shape, const std::string& transfer, double error) {
  SCOPED_TRACE(shape + " " + transfer);
  verification::Record record("Vibration of a bar, " + shape + ", " + transfer,
                              "Three periods of the first mode of an elastic bar held at both ends.",
                              "frequency c/(2 L), amplitude v/omega, both kept", "one-dimensional wave equation");
  const Mode coarsest = vibrate_with(shape, transfer, 8), coarse = vibrate_with(shape, transfer, 16),
             fine = vibrate_with(shape, transfer, 32);
  record.expect_near("frequency over exact, 32 cells", fine.frequency, 1.0, error);
  record.expect_order(
      "cell over the length", {1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0}, "frequency over exact, less 1",
      {std::abs(coarsest.frequency - 1.0), std::abs(coarse.frequency - 1.0), std::abs(fine.frequency - 1.0)}, 2.0, 0.1);
  record.expect_near("amplitude after three periods over that at the start, 32 cells", fine.amplitude, 1.0, 3e-3);
  EXPECT_GT(order(coarse.amplitude - 1.0, fine.amplitude - 1.0), 2.9);
  EXPECT_NEAR(fine.stroke, 1.0, 1e-3);
}

TEST(Bar, UgimpFlip) { expect_second_order("ugimp", "flip", 1.5e-3); }
TEST(Bar, UgimpApic) { expect_second_order("ugimp", "apic", 5e-4); }
// The filter keeps long waves.
TEST(Bar, UgimpFmpm) { expect_second_order("ugimp", "fmpm", 1.5e-3); }
TEST(Bar, QuadraticFlip) { expect_second_order("quadratic", "flip", 2.7e-3); }
TEST(Bar, QuadraticApic) { expect_second_order("quadratic", "apic", 1.4e-3); }

// PIC damps by its fraction in each step: here about 1 % in each of 960 steps.
TEST(Bar, PicDamps) {
  const Mode mode = vibrate(16, "mechanics.transfer=blend; mechanics.pic_fraction=0.01");
  EXPECT_LT(mode.amplitude, 0.96);
  EXPECT_GT(mode.amplitude, 0.94);
}

}  // namespace
}  // namespace thawslide::sim
