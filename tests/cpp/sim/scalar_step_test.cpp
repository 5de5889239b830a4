// The time step in batches compared with the same step particle by particle (tests/cpp/support/scalar_step.hpp).
#include "../support/scalar_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "../support/two_bodies.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// Maximum difference of `of` between particles, relative to its maximum.
template <int Dim, class Of>
double difference(const std::vector<Point<Dim>>& batched, const std::vector<Point<Dim>>& scalar, const Of& of) {
  double largest = 0.0, size = 0.0;
  for (std::size_t p = 0; p < batched.size(); ++p) {
    const double here = std::abs(of(batched[p]) - of(scalar[p]));
    EXPECT_TRUE(std::isfinite(here)) << p << ": " << of(batched[p]) << ", " << of(scalar[p]);
    largest = std::max(largest, here);
    size = std::max(size, std::abs(of(scalar[p])));
  }
  return size > 0.0 ? largest / size : largest;
}

// Components `first` ... of the records of the nodes selected by filled(block, node).
template <class Records, int Dim, class Filled>
void expect_same_sums(const Records& records, const ScalarStep<Dim>& scalar, const typename ScalarStep<Dim>::Sums& sums,
                      std::size_t first, const Filled& filled) {
  std::vector<double> largest(sums.begin()->second.size(), 0.0), size = largest;
  std::size_t count = 0;
  for (const auto& [node, sum] : sums) {
    const auto [b, k] = scalar.at(node);
    if (!filled(b, k)) {
      continue;
    }
    ++count;
    for (std::size_t c = 0; c < sum.size(); ++c) {
      EXPECT_TRUE(std::isfinite(records(b, k)[first + c]));
      largest[c] = std::max(largest[c], std::abs(records(b, k)[first + c] - sum[c]));
      size[c] = std::max(size[c], std::abs(sum[c]));
    }
  }
  EXPECT_GT(count, 10u);
  for (std::size_t c = 0; c < size.size(); ++c) {
    EXPECT_LE(largest[c], 1e-12 * size[c]) << "component " << c;
  }
}

// Motion of nodes and result of contact. hovers: part of the base keeps a distance from the ground.
template <int Dim>
void expect_same_nodes(const Simulation<Dim>& simulation, const ScalarStep<Dim>& scalar, bool hovers) {
  using mpm::Contact;
  const auto& nodes = simulation.nodes();
  int touching = 0, moving = 0;
  double largest_clearance = 0.0;
  std::map<std::string, std::pair<double, double>> found;  // maximum difference and magnitude
  const auto compare = [&](const char* name, double batched, double plain) {
    EXPECT_TRUE(std::isfinite(batched)) << name;
    auto& [largest, size] = found[name];
    largest = std::max(largest, std::abs(batched - plain));
    size = std::max(size, std::abs(plain));
  };
  for (const auto& [node, clearance] : scalar.contact().clearance()) {
    const auto [b, k] = scalar.at(node);
    // Gaps are differences of positions: their round-off is that of lengths.
    compare("clearance", 1.0 + nodes.near_ground(b, k)[mpm::NearGround::clearance], 1.0 + clearance);
    largest_clearance = std::max(largest_clearance, clearance);
  }
  for (const auto& [node, motion] : scalar.contact().motion()) {
    const auto [b, k] = scalar.at(node);
    const auto& contact = nodes.contact(b, k);
    EXPECT_EQ(contact[Contact::touching] > 0.0, motion.touching);
    touching += motion.touching ? 1 : 0;
    compare("slip speed", contact[Contact::slip_speed], motion.slip_speed);
    compare("friction heat", contact[Contact::friction_heat], motion.friction_heat);
    // Times the mass: nodes with almost no mass have accelerations at round-off level.
    const auto& record = nodes.momentum(b, k);
    const double mass = record[mpm::MomentumLayout<Dim>::mass];
    const auto mapped = Eigen::Map<const Vector<double, Dim>>(scalar.mapped().at(node).data());
    const Vector<double, Dim> velocity = scalar.contact().mapped_velocity(node, mapped);
    for (int a = 0; a < Dim; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const auto& moves = nodes.motion(b, k);
      compare("acceleration", mass * moves[mpm::MotionLayout<Dim>::acceleration + axis], mass * motion.acceleration[a]);
      compare("velocity at mid-step", mass * moves[mpm::MotionLayout<Dim>::middle_velocity + axis],
              mass * motion.middle_velocity[a]);
      compare("velocity mapped back", mass * nodes.velocity(b, k)[axis], mass * velocity[a]);
    }
  }
  for (const auto& [name, difference] : found) {
    EXPECT_GT(difference.second, 0.0) << name;
    EXPECT_LE(difference.first, 1e-12 * difference.second) << name;
  }
  EXPECT_TRUE(largest_clearance > 1e-6 || !hovers);
  EXPECT_GT(touching, 3);
  for (std::size_t b = 0; b < simulation.grid().blocks().size(); ++b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      moving += nodes.momentum(b, k)[mpm::MomentumLayout<Dim>::mass] > 0.0 ? 1 : 0;
    }
  }
  EXPECT_EQ(static_cast<std::size_t>(moving), scalar.contact().motion().size());
}

template <int Dim>
void expect_the_scalar_step(const config::Case& parameters, bool yields, bool hovers) {
  constexpr double tolerance = 1e-12;
  Simulation<Dim> simulation(parameters);
  for (int k = 0; k < 60; ++k) {
    simulation.step(simulation.next_step(10.0));
  }
  const double dt = simulation.next_step(10.0);
  const auto before = points_of(simulation);
  simulation.step(dt);
  const ScalarStep<Dim> scalar(simulation, dt, before);
  const auto now = points_of(simulation);
  const auto every_node = [](std::size_t /*block*/, std::size_t /*node*/) { return true; };
  expect_same_sums(simulation.nodes().momentum, scalar, scalar.momentum(), 0, every_node);
  expect_same_sums(simulation.nodes().averages, scalar, scalar.linear(), 0, every_node);
  const auto candidates = [&](std::size_t b, std::size_t k) { return simulation.ground()->block(b)[k].candidate; };
  expect_same_sums(simulation.nodes().near_ground, scalar, scalar.near_ground_by_mass(), 0, candidates);
  expect_same_sums(simulation.nodes().near_ground, scalar, scalar.near_ground_by_linear(),
                   mpm::NearGround::saturation_by_linear, candidates);
  expect_same_nodes(simulation, scalar, hovers);
  using P = Point<Dim>;
  const auto expect_same = [&](const char* name, const auto& of) {
    EXPECT_LE((difference<Dim>(now, scalar.points(), of)), tolerance) << name;
  };
  for (int a = 0; a < Dim; ++a) {
    expect_same("velocity", [a](const P& p) { return p.velocity[a]; });
    expect_same("displacement", [a](const P& p) { return p.displacement[a]; });
    expect_same("position", [a](const P& p) { return p.position[a]; });
  }
  expect_same("path", [](const P& p) { return p.path_length; });
  for (int c = 0; c < 6; ++c) {
    expect_same("stress", [c](const P& p) { return p.stress[c]; });
  }
  expect_same("plastic strain", [](const P& p) { return p.plastic_strain; });
  expect_same("volume", [](const P& p) { return p.volume; });
  expect_same("porosity", [](const P& p) { return p.porosity; });
  expect_same("temperature", [](const P& p) { return p.temperature; });
  expect_same("heat content", [](const P& p) { return p.heat_content; });
  expect_same("saturation", [](const P& p) { return p.saturation; });
  expect_same("slip", [](const P& p) { return p.slip; });
  expect_same("place in the band", [](const P& p) { return p.in_band ? 1.0 : 0.0; });
  expect_same("flow depth", [](const P& p) { return p.flow_depth; });
  expect_same("liquid pressure", [](const P& p) { return p.liquid_pressure; });
  expect_same("pore pressure", [](const P& p) { return p.pore_pressure; });
  expect_same("void", [](const P& p) { return p.pore_void; });
  expect_same("normal load", [](const P& p) { return p.normal_load; });
  expect_same("water that seeped", [](const P& p) { return p.seeped_water; });
  std::size_t yielding = 0, warmed = 0, in_band = 0, at_pressure_of_air = 0;
  for (std::size_t p = 0; p < now.size(); ++p) {
    yielding += now[p].plastic_strain > before[p].plastic_strain ? 1 : 0;
    warmed += now[p].temperature != before[p].temperature ? 1 : 0;
    in_band += now[p].in_band ? 1 : 0;
    at_pressure_of_air += now[p].pore_pressure == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(yielding > now.size() / 20, yields)
      << yielding << " of " << now.size();  // some are separated in either case
  EXPECT_GT(warmed, now.size() / 20);
  EXPECT_GT(std::min(in_band, at_pressure_of_air), now.size() / 30);
  // Tiles with changing temperatures, and tiles without, which skip the secant capacity.
  const auto& changing = simulation.nodes().marks.changing_tiles;
  const auto count = std::count(changing.begin(), changing.end(), 1);
  EXPECT_GT(count, 0);
  EXPECT_LT(static_cast<std::size_t>(count), changing.size());
}

constexpr double elastic = 1e7, yielding = 5e3;  // cohesion [Pa]

TEST(ScalarStep, AgreesWithTheBatchesInThePlaneElastic) {
  expect_the_scalar_step<2>(two_bodies<2>(elastic), false, true);
}
TEST(ScalarStep, AgreesWithTheBatchesInThePlaneYielding) {
  expect_the_scalar_step<2>(two_bodies<2>(yielding), true, false);
}
TEST(ScalarStep, AgreesWithTheBatchesInSpaceElastic) { expect_the_scalar_step<3>(two_bodies<3>(elastic), false, true); }
TEST(ScalarStep, AgreesWithTheBatchesInSpaceYielding) {
  expect_the_scalar_step<3>(two_bodies<3>(yielding), true, false);
}

// Ground oblique to the cells, under a base that partly hovers above it until it yields.
template <int Dim>
void expect_the_scalar_step_on_a_plane(double cohesion, bool yields) {
  const Sets plane = "terrain.type=plane; terrain.slope=0.5; terrain.elevation=-0.01";
  expect_the_scalar_step<Dim>(two_bodies<Dim>(cohesion, 7.0, 5.0, 0.0, plane), yields, !yields);
}
TEST(ScalarStep, AgreesWithTheBatchesOnAPlane) { expect_the_scalar_step_on_a_plane<2>(elastic, false); }
TEST(ScalarStep, AgreesWithTheBatchesInSpaceOnAPlane) { expect_the_scalar_step_on_a_plane<3>(yielding, true); }

// With all options that the step particle by particle supports.
TEST(ScalarStep, AgreesWithTheBatchesWithOtherOptions) {
  const auto of = [](const Sets& sets) {
    SCOPED_TRACE(sets[0]);
    expect_the_scalar_step<2>(two_bodies<2>(yielding, 7.0, 5.0, 0.0, sets), true, false);
    expect_the_scalar_step<3>(two_bodies<3>(yielding, 7.0, 5.0, 0.0, sets), true, false);
  };
  of("time.stepping=adaptive");
  of("band.region=first_layer");
  of("terrain.representation=rigid_points");
  of("pressure.frozen_rows=sealed");
  of("pressure.frozen_rows=vented; phases.water_expansion_law=by_temperature");
  of("pressure.frozen=none; pressure.residual_stress=2e3; pressure.skeleton_compressibility=1e-8; "
     "basal.friction_angle=5.0");
  of("pressure.melt_contraction=true; pressure.skeleton_compressibility=1e-8; heat.advection_form=conservative");
  of("material.melted.softening_strain=0.01; material.melted.residual_friction_angle=20.0");
}

}  // namespace
}  // namespace thawslide::sim
