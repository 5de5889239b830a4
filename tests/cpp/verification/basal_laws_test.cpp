// A block that slides on basal laws with an exact solution: with the material point method, and as a rigid block.
#include <map>

#include "sim/block/block.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double length = 40.0, height = 20.0;  // [m]

// A frozen block of 40 m x 20 m on level ground, with a horizontal initial velocity.
const Sets thrown{"time.end=4; freezing.curve=linear; body.block.temperature=-10; body.block.velocity=[10,0]"};

// Last rows of the history of the material point method and of the rigid block.
struct Last {
  std::map<std::string, double> mpm, block;
};

Last run_to_end(const Sets& sets) {
  const config::Case parameters = published_case("block", thrown + sets);
  Simulation<2> simulation(parameters);
  run_until(simulation, parameters.time.end);
  const auto row = history_row(simulation);
  const auto rows = sim::run_block(parameters);
  return {{row.begin(), row.end()}, {rows.back().begin(), rows.back().end()}};
}

TEST(Bonds, DissipateTheirEnergyOnce) {
  constexpr double initial = 1e5, distance = 4.0;
  Record record(
      "Bonds of ice: energy of breaking",
      "A frozen block is thrown along level ground. Only bonds of 0.1 MPa hold it, which slip breaks over 4 m.",
      "energy lost per area = c_0 d_c, at any speed", "integral of c_0 exp(-s/d_c) over the slip");
  const Last found = run_to_end(
      fmt::format("basal.friction_angle=0; basal.cohesion={}; basal.cohesion_law=bonds; basal.slip_distance={}",
                  initial, distance));
  record.explain("the material point method: nodes at the ends of the block share its base to half a per cent");
  record.expect_near("energy over c_0 d_c", found.mpm.at("friction_work_J") / (length * initial * distance), 1.0, 1e-2);
  record.expect_near("the same of the rigid block", found.block.at("friction_work_J_m2") / (initial * distance), 1.0,
                     2e-3);
}

// From rock onto a glacier: while a rigid block crosses the border, friction decreases in proportion to the part that
// has crossed. Friction acts at its base, below its centre of mass. Its load is therefore shifted forward, by mu h/2 on
// average (from the balance of moments), and reaches the border earlier by the same distance.
TEST(Substrates, TravelDistanceOverTwoIsExact) {
  constexpr double on_rock = 0.3, on_ice = 0.15, start = 20.0, border = 52.5;
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
  const Last found = run_to_end(
      fmt::format("basal.friction_angle={:.15g}; substrate.glacier.x_min={}; substrate.glacier.friction=coefficient; "
                  "substrate.glacier.friction_coefficient={}; body.block.velocity=[20,0]; time.end=12",
                  std::atan(on_rock) / degree, border, on_ice));
  EXPECT_LT(found.mpm.at("mean_velocity_m_s"), 1e-2) << "it still slides";
  EXPECT_LT(found.block.at("velocity_m_s"), 1e-9) << "it still slides";
  record.expect_near("distance over exact", found.mpm.at("mean_displacement_m") / of_body, 1.0, 5e-3);
  record.expect_near("of the rigid block, whose load does not lean", found.block.at("displacement_m") / of_block, 1.0,
                     1e-3);
}

}  // namespace
}  // namespace thawslide::verification
