// A block that slides on basal laws with an exact solution: with the material point method, and as a rigid block.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../support/case_from_text.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "sim/block.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;

constexpr double length = 40.0, height = 20.0;  // [m]

// A frozen block of 40 m x 20 m on level ground, with a horizontal initial velocity.
const std::string thrown = R"(
[time]
end = 4.0
step = 0.001
[grid]
cell = 5.0
min = [-20.0, -10.0]
max = [200.0, 40.0]
[terrain]
type = "flat"
elevation = 0.0
[freezing]
curve = "linear"
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
viscosity_time = 0.02
[body.block]
material = "rock"
shape = "box"
min = [0.0, 0.0]
max = [40.0, 20.0]
temperature = -10.0
velocity = [10.0, 0.0]
[mechanisms]
pressurization = false
[heat]
enabled = false
[pressure]
enabled = false
[basal]
)";

// Work of friction per area of base, with the material point method and for the rigid block [J/m2].
struct Work {
  double mpm, block;
};

Work work_on(const std::string& text) {
  sim::Simulation<2> simulation(paper_case(text));
  run_until(simulation, simulation.parameters().time.end);
  const auto rows = sim::run_block(paper_case(text));
  const std::map<std::string, double> last(rows.back().begin(), rows.back().end());
  return {value_of(sim::history_row(simulation), "friction_work_J") / length, last.at("friction_work_J_m2")};
}

TEST(Bonds, CostTheirEnergyOnce) {
  constexpr double initial = 1e5, distance = 4.0;
  Record record(
      "Bonds of ice: energy of breaking",
      "A frozen block is thrown along level ground. Only bonds of 0.1 MPa hold it, which slip breaks over 4 m.",
      "energy lost per area = c_0 d_c, at any speed", "integral of c_0 exp(-s/d_c) over the slip");
  const Work found = work_on(thrown + fmt::format("friction = \"constant\"\nfriction_angle = 0.0\ncohesion = {}\n"
                                                  "cohesion_law = \"bonds\"\nslip_distance = {}\n",
                                                  initial, distance));
  record.explain("the material point method: nodes at the ends of the block share its base to half a per cent");
  record.expect_near("energy over c_0 d_c", found.mpm / (initial * distance), 1.0, 1e-2);
  record.expect_near("the same of the rigid block", found.block / (initial * distance), 1.0, 2e-3);
}

struct Distance {
  double mpm, block;
};

Distance distance_on(const std::string& text, const std::vector<std::string>& sets) {
  sim::Simulation<2> simulation(paper_case(text, sets));
  run_until(simulation, simulation.parameters().time.end);
  const auto row = sim::history_row(simulation);
  EXPECT_LT(value_of(row, "mean_velocity_m_s"), 1e-2) << "it still slides";
  const auto rows = sim::run_block(paper_case(text, sets));
  const std::map<std::string, double> last(rows.back().begin(), rows.back().end());
  EXPECT_LT(last.at("velocity_m_s"), 1e-9) << "it still slides";
  return {value_of(row, "mean_displacement_m"), last.at("displacement_m")};
}

// From rock onto a glacier: while a rigid block crosses the border, friction decreases in proportion to the part that
// has crossed. Friction acts at its base, below its centre of mass. Its load is therefore shifted forward, by mu h/2 on
// average (from the balance of moments), and reaches the border earlier by the same distance.
TEST(Substrates, SlidingDistanceOverTwo) {
  constexpr double on_rock = 0.3, on_ice = 0.15, start = 20.0, border = 52.5, gravity = 9.81;
  const double to_border = border - length, mean = 0.5 * (on_rock + on_ice);
  const double rest = start * start / (2.0 * gravity) - on_rock * to_border - mean * length;  // m, of v^2/2g
  const double of_block = to_border + length + rest / on_ice;
  const double of_body = of_block + (on_rock / on_ice - 1.0) * mean * 0.5 * height;
  Record record("Sliding distance over two substrates",
                "A block of 40 m x 20 m is thrown along level ground, at first on rock with friction 0.3. A glacier "
                "with friction 0.15 begins 12.5 m before its front. The block comes to rest on the glacier.",
                "v^2/(2 g) = mu_1 b + (mu_1 + mu_2) L/2 + mu_2 (d - b - L). If the load is shifted forward by mu h/2, "
                "d is longer by (mu_1/mu_2 - 1) (mu_1 + mu_2) h/4",
                "energy of a rigid block, balance of its moments");
  const std::string text =
      thrown + fmt::format(
                   "friction = \"constant\"\nfriction_angle = {:.15g}\n[substrate.glacier]\nx_min = {}\n"
                   "friction = \"coefficient\"\nfriction_coefficient = {}\n",
                   std::atan(on_rock) * 180.0 / pi, border, on_ice);
  const std::vector<std::string> sets{"body.block.velocity=[20.0,0.0]", "time.end=12.0"};
  const Distance found = distance_on(text, sets);
  record.expect_near("distance over exact", found.mpm / of_body, 1.0, 5e-3);
  record.expect_near("of the rigid block, whose load does not lean", found.block / of_block, 1.0, 1e-3);
}

}  // namespace
}  // namespace thawslide::verification
