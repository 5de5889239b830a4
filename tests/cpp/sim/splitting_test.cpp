// Splitting of stretched particles: what the halves keep, where they are, ids, the limit, and bitwise identical results
// for any number of threads and after a restart.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "../support/following_slides.hpp"
#include "../support/reproducible_runs.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr int steps_to_split = 10;
const Sets splits = "mechanics.split_stretched=true";
const Sets splits_none = splits + "mechanics.split_limit=1.000001";

template <int Dim>
std::unique_ptr<Simulation<Dim>> slide(const Sets& sets) {
  if constexpr (Dim == 2) {
    return slide_on_plane(30.0,
                          "heat.enabled=true; pressure.enabled=true; material.rock.hydraulic_conductivity=1e-8" + sets);
  } else {
    return slide_in_gully("heat.enabled=true; pressure.enabled=true; material.debris.hydraulic_conductivity=1e-8" +
                          sets);
  }
}

// Random velocities and stretches, by id: of most particles above the limit of 3.
template <int Dim>
void randomize(Simulation<Dim>& simulation) {
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    std::mt19937_64 numbers(static_cast<std::uint64_t>(particles.id(p)) + 1);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(numbers);
    };
    for (int a = 0; a < Dim; ++a) {
      particles.velocity(p, a) = between(-10.0, 10.0);
    }
    for (int c = 0; particles.affine_velocity.is_kept() && c < Dim * Dim; ++c) {
      particles.affine_velocity(p, c) = between(-1.0, 1.0);
    }
    particles.seeped_water(p) = between(0.0, 100.0);
    particles.slip(p) = between(0.0, 50.0);
    for (int c = 0; particles.surface_stretch.is_kept() && c < (Dim - 1) * (Dim - 1); ++c) {
      particles.surface_stretch(p, c) = Dim == 2 ? between(2.0, 4.0) : between(0.0, 2.9);
    }
  }
}

template <int Dim>
std::map<std::int64_t, std::size_t> places_by_id(const mpm::Particles<Dim>& particles) {
  std::map<std::int64_t, std::size_t> places;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_TRUE(places.emplace(particles.id(p), p).second) << "id " << particles.id(p);
  }
  return places;
}

template <int Dim>
void step_until_split(Simulation<Dim>& simulation) {
  for (int k = 0; k < steps_to_split; ++k) {
    simulation.step(1e-4);
  }
}

// Stretch of a particle along its longest axis, and that axis.
template <int Dim>
std::pair<double, Vector<double, Dim - 1>> longest_axis_of(const mpm::Particles<Dim>& particles, std::size_t p) {
  constexpr int axes = Dim - 1;
  Eigen::Matrix<double, axes, axes> stretch;
  for (int c = 0; c < axes * axes; ++c) {
    stretch(c % axes, c / axes) = particles.surface_stretch(p, c);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, axes, axes>> solved(stretch * stretch.transpose());
  return {std::sqrt(solved.eigenvalues()[axes - 1]), solved.eigenvectors().col(axes - 1)};
}

// A particle before, in a run that may not split, and its halves.
template <int Dim>
void expect_two_halves(const Simulation<Dim>& whole, std::size_t p, const Simulation<Dim>& split, std::size_t kept,
                       std::size_t added) {
  constexpr int axes = Dim - 1;
  const auto& before = whole.particles();
  const auto& after = split.particles();
  const auto [stretch, axis] = longest_axis_of<Dim>(before, p);
  const double length = stretch * 0.5 * static_cast<double>(whole.grid().cell());
  Vector<double, axes> apart;
  Vector<double, Dim> middle;
  for (int a = 0; a < Dim; ++a) {
    middle[a] = 0.5 * (after.position(kept, a) + after.position(added, a)) - before.position(p, a);
    const double momentum = after.mass(kept) * after.velocity(kept, a) + after.mass(added) * after.velocity(added, a);
    EXPECT_NEAR(momentum / before.mass(p), before.velocity(p, a), 1e-13);
  }
  for (int a = 0; a < axes; ++a) {
    apart[a] = after.position(added, a) - after.position(kept, a);
    EXPECT_NEAR(middle[a], 0.0, 1e-12 * length);
  }
  EXPECT_NEAR(apart.norm(), 0.5 * length, 1e-12 * length);
  EXPECT_NEAR(std::abs(apart.dot(axis)), apart.norm(), 1e-12 * length);
  EXPECT_EQ(after.parent_id(kept), before.parent_id(p));
  EXPECT_EQ(after.parent_id(added), before.id(p));
  Vector<double, axes> along;
  for (int a = 0; a < axes; ++a) {
    along[a] = axis[a] * stretch;
  }
  for (const std::size_t half : {kept, added}) {
    for (const auto field : {&mpm::Particles<Dim>::mass, &mpm::Particles<Dim>::volume,
                             &mpm::Particles<Dim>::initial_volume, &mpm::Particles<Dim>::seeped_water}) {
      EXPECT_EQ((after.*field)(half), 0.5 * (before.*field)(p));
    }
    const auto body = static_cast<std::size_t>(after.body(half));
    const auto above = [&](const Simulation<Dim>& simulation, std::size_t particle) {
      const auto& particles = simulation.particles();
      return particles.position(particle, axes) -
             simulation.model().ground->height(particles.position.template get<Vector<double, axes>>(particle), body);
    };
    EXPECT_NEAR(above(split, half), above(whole, p), 1e-12 * 300.0);
    for (int a = 0; a < Dim; ++a) {
      EXPECT_NEAR(after.position(half, a) - after.displacement(half, a),
                  before.position(p, a) - before.displacement(p, a), 1e-12 * 300.0);
    }
    // F F^T loses 3/4 of its part along the axis.
    Eigen::Matrix<double, axes, axes> first, second;
    for (int c = 0; c < axes * axes; ++c) {
      first(c % axes, c / axes) = before.surface_stretch(p, c);
      second(c % axes, c / axes) = after.surface_stretch(half, c);
    }
    const Eigen::Matrix<double, axes, axes> expected = first * first.transpose() - 0.75 * along * along.transpose();
    EXPECT_LT((second * second.transpose() - expected).norm(), 1e-12 * expected.norm() + 1e-12);
  }
}

// All other fields of a half are bitwise those of the particle.
template <int Dim>
void expect_other_fields_kept(const Simulation<Dim>& whole, std::size_t p, const Simulation<Dim>& split,
                              std::size_t half) {
  const std::set<std::string> changed{"id",           "parent_id",        "mass",         "volume",
                                      "position",     "velocity",         "displacement", "initial_volume",
                                      "seeped_water", "surface_stretch",  "linear_slope", "height_above_ground",
                                      "ground_slope", "step_displacement"};
  const auto& before = whole.particles().fields.all();
  const auto& after = split.particles().fields.all();
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (changed.count(before[k]->info().name) == 0) {
      std::vector<double> first, second;
      before[k]->append_values({p}, before[k]->components(), first);
      after[k]->append_values({half}, after[k]->components(), second);
      EXPECT_EQ(first, second) << before[k]->info().name;
    }
  }
}

// gains: halves have more energy than the particle, on curved ground or by the affine velocity of APIC.
template <int Dim>
void expect_exact_halves(const Sets& sets, bool gains) {
  const auto whole = slide<Dim>(sets + splits_none), split = slide<Dim>(sets + splits);
  for (auto* each : {whole.get(), split.get()}) {
    randomize(*each);
    step_until_split(*each);
  }
  const auto& before = std::as_const(*whole).particles();
  const auto& after = std::as_const(*split).particles();
  const auto places = places_by_id<Dim>(after);
  ASSERT_EQ(before.size(), whole->particles_at_start());
  std::int64_t next = static_cast<std::int64_t>(before.size());
  std::int64_t unsplit = 0;
  for (const auto& [id, p] : places_by_id<Dim>(before)) {
    const double limit = 3.0;  // 1.5 cells over the length of half a cell at t = 0
    const std::size_t kept = places.at(id);
    if (longest_axis_of<Dim>(before, p).first <= limit) {
      EXPECT_EQ(after.mass(kept), before.mass(p));
      ++unsplit;
      continue;
    }
    const std::size_t added = places.at(next++);  // the next id, in the order of the parents
    expect_two_halves<Dim>(*whole, p, *split, kept, added);
    expect_other_fields_kept<Dim>(*whole, p, *split, kept);
    expect_other_fields_kept<Dim>(*whole, p, *split, added);
  }
  EXPECT_GT(unsplit, 5);
  EXPECT_GT(split->split_count(), 50);
  EXPECT_EQ(next, static_cast<std::int64_t>(after.size()));
  const HistoryRow first = history_row(*whole), second = history_row(*split);
  const double energy = value_of(first, "kinetic_J"), mass = value_of(first, "mass_kg");
  const auto expect_same = [&](const std::string& column, double scale) {
    EXPECT_NEAR(value_of(second, column) / scale, value_of(first, column) / scale, 1e-12) << column;
  };
  expect_same("mechanical_residual_J", energy);
  expect_same("mass_residual_kg", mass);
  expect_same("seepage_residual_kg", mass);
  expect_same("thermal_residual_J", std::abs(value_of(first, "sensible_J")) + value_of(first, "latent_J"));
  for (const std::string axis : Dim == 2 ? std::vector{"x", "y"} : std::vector{"x", "y", "z"}) {
    expect_same("momentum_residual_" + axis + "_N_s", mass);
  }
  const auto mechanical = [](const HistoryRow& row) {
    return value_of(row, "kinetic_J") + value_of(row, "potential_J");
  };
  const double gained = value_of(second, "numerical_J") - value_of(first, "numerical_J");
  EXPECT_NEAR((mechanical(second) - mechanical(first)) / energy, gained / energy, 1e-12);
  EXPECT_EQ(std::abs(gained) > 1e-9 * energy, gains) << gained;
}

TEST(Splitting, HalvesKeepEveryQuantityInThePlane) {
  expect_exact_halves<2>("mechanics.transfer=flip", false);
  expect_exact_halves<2>("mechanics.transfer=apic", true);
}
TEST(Splitting, HalvesKeepEveryQuantityInSpace) {
  expect_exact_halves<3>("mechanics.transfer=flip", true);
  expect_exact_halves<3>("mechanics.transfer=apic", true);
}

// Sets a uniform extension along a horizontal axis, on an inclined plane.
void extend(Simulation<3>& simulation, const Vector<double, 2>& axis, double rate, double slope) {
  const Matrix<double, 2> gradient = rate * axis * axis.transpose();
  const auto& origin = simulation.model().origin;
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vector<double, 2> place(particles.position(p, 0) + origin[0], particles.position(p, 1) + origin[1]);
    const Vector<double, 2> velocity = gradient * place;
    particles.velocity.set(p, Vector<double, 3>(velocity[0], velocity[1], -slope * velocity[0]));
    for (int b = 0; b < 2; ++b) {
      for (int a = 0; a < 3; ++a) {
        particles.affine_velocity(p, b * 3 + a) = a < 2 ? gradient(a, b) : -slope * gradient(0, b);
      }
    }
  }
}

const Vector<double, 2> oblique(std::cos(0.6), std::sin(0.6));
constexpr double slope = 0.5;

// A box after a uniform extension along an axis: by 1.12 in each of the steps up to splitting.
std::unique_ptr<Simulation<3>> extended_box(bool is_incompressible) {
  constexpr double dt = 0.12;
  auto extended = std::make_unique<Simulation<3>>(base_case(
      "box", fmt::format("case.gravity=0; case.gravity_tilt=0; time.step={}; terrain.type=plane; terrain.elevation=20; "
                         "terrain.slope={:.17g}; grid.cell=2; grid.min=[-60,-60,-40]; grid.max=[60,60,60]; "
                         "body.box.min=[-4,-4,22]; body.box.max=[4,4,26]; material.rock.law=elastic; "
                         "material.rock.youngs_modulus=1e-9; material.rock.viscosity_time=0; mechanics.transfer=apic; "
                         "mechanics.initial_stress=none; "
                         "heat.enabled=false; pressure.enabled=false; guards.energy_growth=inf",
                         dt, std::atan(slope) * 180.0 / pi) +
                 splits));
  Simulation<3>& simulation = *extended;
  for (int k = 0; k < steps_to_split; ++k) {
    extend(simulation, oblique, 1.0, slope);
    for (std::size_t p = 0; is_incompressible && p < simulation.particle_count(); ++p) {
      simulation.particles().volume(p) = simulation.particles().initial_volume(p);
    }
    simulation.step(dt);
  }
  return extended;
}

TEST(Splitting, FollowsAUniformExtensionAlongAnObliqueAxis) {
  const double stretch = std::pow(1.12, steps_to_split);
  const auto simulation = extended_box(true);
  const std::size_t at_start = 256;
  ASSERT_GT(stretch, 3.0);
  const auto& particles = std::as_const(*simulation).particles();
  ASSERT_EQ(particles.size(), 2 * at_start);
  const auto places = places_by_id<3>(particles);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::size_t kept = places.at(particles.parent_id(p));
    const Vector<double, 2> apart(particles.position(p, 0) - particles.position(kept, 0),
                                  particles.position(p, 1) - particles.position(kept, 1));
    // The length was 1 m at t = 0.
    EXPECT_NEAR(std::abs(apart.dot(oblique)), particles.parent_id(p) == particles.id(p) ? 0.0 : 0.5 * stretch, 1e-10);
    EXPECT_NEAR(apart[0] * oblique[1] - apart[1] * oblique[0], 0.0, 1e-10);
    EXPECT_NEAR(particles.position(p, 2) - particles.position(kept, 2), -slope * apart[0], 1e-10);
  }
}

TEST(Splitting, LeavesOutWhatTensionHasTorn) {
  const auto simulation = extended_box(false);
  const auto& particles = std::as_const(*simulation).particles();
  EXPECT_EQ(particles.size(), 256U);
  EXPECT_GT(particles.volume(0), mpm::torn_volume * particles.initial_volume(0));
}

// Some particles are split in each of the checks, so that parents of the second one are halves of the first one.
template <int Dim>
std::unique_ptr<Simulation<Dim>> slide_that_splits(const Sets& sets) {
  auto simulation = slide<Dim>(splits + sets);
  auto& particles = simulation->particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.surface_stretch(p, 0) = 1.0 + 0.37 * static_cast<double>(particles.id(p) % 17);
  }
  return simulation;
}

template <int Dim>
void expect_reproducible_splitting(const Sets& sets) {
  std::set<std::int64_t> counts;
  const auto visit = [&](const Simulation<Dim>& simulation, int /*step*/) {
    expect_closed_budgets(simulation);
    counts.insert(simulation.split_count());
  };
  expect_reproducible_run<Dim>([&] { return slide_that_splits<Dim>(sets); }, 40,
                               {{2, 7, -1}, {3, 1, 15}, {2, 3, 10}, {1, 2, 9}}, visit);
  EXPECT_GT(counts.size(), 2U);
  EXPECT_GT(*counts.rbegin(), 50);
}

TEST(Splitting, ResultsAreReproducibleInThePlane) { expect_reproducible_splitting<2>("mechanics.transfer=flip"); }
TEST(Splitting, ResultsAreReproducibleInSpace) { expect_reproducible_splitting<3>("mechanics.transfer=apic"); }
TEST(Splitting, ResultsAreReproducibleWithABed) {
  expect_reproducible_splitting<2>(
      "bed.law=strength; bed.depth=2; bed.strength=100; bed.depth_per_slip=0.2; bed.porosity=0.9; "
      "bed.temperature=-0.5; bed.material=rock; body.block.velocity=[11.5,-6.6]");
}

// A held body does not deform; the other one is stretched.
TEST(Splitting, LeavesAHeldBodyAsItIs) {
  const auto simulation = slide<2>(
      "body.held.shape=polygon; body.held.material=rock; body.held.temperature=-5; body.held.porosity=0.3; "
      "body.held.vertices=[[150,-86.6025403784438],[200,-115.470053837925],[200,-75.470053837925],[150,-46."
      "6025403784438]]; "
      "body.held.release_time=15" +
      splits);
  for (int k = 0; k < 300; ++k) {
    simulation->step(simulation->next_step(100.0));
  }
  const auto& particles = std::as_const(*simulation).particles();
  double farthest = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (simulation->model().body_names[static_cast<std::size_t>(particles.body(p))] == "held") {
      EXPECT_EQ(particles.surface_stretch(p), 1.0);
      EXPECT_EQ(particles.parent_id(p), particles.id(p));
    } else {
      farthest = std::max(farthest, particles.surface_stretch(p));
    }
  }
  EXPECT_GT(farthest, 1.1);
}

TEST(Splitting, IsOffDuringSettling) {
  auto simulation =
      slide<2>("mechanics.initial_stress=settle; mechanics.settle_time=0.5; mechanics.settle_damping=2" + splits);
  auto& particles = simulation->particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.surface_stretch(p) = 5.0;
  }
  ASSERT_TRUE(simulation->settle());
  EXPECT_EQ(simulation->particle_count(), simulation->particles_at_start());
  EXPECT_EQ(std::as_const(*simulation).particles().surface_stretch(0), 1.0);
}

}  // namespace
}  // namespace thawslide::sim
