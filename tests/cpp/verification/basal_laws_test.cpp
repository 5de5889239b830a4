// A block that slides on laws of the base with an exact end: in the material point method, and as a rigid block.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../support/case_from_text.hpp"
#include "../support/record.hpp"
#include "sim/block.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;

constexpr double speed = 10.0, length = 40.0;  // [m/s], [m]

// A frozen block of 40 m x 20 m on level ground, thrown along it.
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

// The work of friction per area of base, of the material point method and of the rigid block [J/m2].
struct Work {
  double mpm, block;
};

Work work_on(const std::string& text) {
  sim::Simulation<2, double> simulation(case_from_text(text));
  run_until(simulation, simulation.parameters().time.end);
  const auto rows = sim::run_block(case_from_text(text));
  const std::map<std::string, double> last(rows.back().begin(), rows.back().end());
  return {value_of(sim::history_row(simulation), "friction_work_J") / length, last.at("friction_work_J_m2")};
}

TEST(Bonds, CostTheirEnergyOnce) {
  constexpr double initial = 1e5, distance = 4.0;
  Record record("Bonds of ice: what breaking them costs",
                "A frozen block is thrown along level ground, on which nothing holds it but bonds of 0.1 MPa, which "
                "slip breaks over 4 m.",
                "energy lost per area = c_0 d_c, however fast", "integral of c_0 exp(-s/d_c) over the slip");
  const Work found = work_on(thrown + fmt::format("friction = \"constant\"\nfriction_angle = 0.0\ncohesion = {}\n"
                                                  "cohesion_law = \"bonds\"\nslip_distance = {}\n",
                                                  initial, distance));
  record.explain("the material point method: nodes at the ends of the block share its base to half a per cent");
  record.expect_near("energy over c_0 d_c", found.mpm / (initial * distance), 1.0, 1e-2);
  record.expect_near("the same of the rigid block", found.block / (initial * distance), 1.0, 2e-3);
}

}  // namespace
}  // namespace thawslide::verification
