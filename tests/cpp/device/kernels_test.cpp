// Kernels on a device, with a group of threads per tile in phases between barriers (device/particle_pass.hpp), are
// bitwise identical to CPU lanes for any order of threads, and differ if a barrier is omitted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/two_bodies.hpp"
#include "band/averages_kernel.hpp"
#include "band/heat_kernels.hpp"
#include "band/pore_pressure.hpp"
#include "lanes_and_device.hpp"
#include "mpm/filter_kernels.hpp"
#include "mpm/motion_kernels.hpp"
#include "mpm/position_kernel.hpp"
#include "scene.hpp"
#include "terrain/band_marks_kernel.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A pass does not compile if a record is both read and added to, under one name or two.
using mpm::are_disjoint, mpm::RecordList;
static_assert(are_disjoint<RecordList<mpm::Motion, mpm::NodalState>, RecordList<mpm::Velocity, mpm::HeatRates>>);
static_assert(are_disjoint<RecordList<>, RecordList<mpm::Velocity>>);
static_assert(!are_disjoint<RecordList<mpm::Motion, mpm::Velocity>, RecordList<mpm::HeatRates, mpm::Velocity>>);
static_assert(!are_disjoint<RecordList<mpm::Velocity>, RecordList<mpm::AffineVelocity>>);
static_assert(!are_disjoint<RecordList<mpm::AffineMotion>, RecordList<mpm::Motion>>);
// Two additions to the same components of a record, and patches of two records in the same memory.
static_assert(mpm::all_apart<RecordList<mpm::NearGround, mpm::NearGroundByLinear, mpm::Clearance>, 3>);
static_assert(!mpm::all_apart<RecordList<mpm::Momentum, mpm::AffineMomentum>, 3>);
static_assert(!mpm::all_apart<RecordList<mpm::AffineVelocity, mpm::Velocity>, 2>);
static_assert(mpm::one_record<RecordList<mpm::NearGround, mpm::Clearance>>);
static_assert(!mpm::one_record<RecordList<mpm::Velocity, mpm::HeatRates>>);

// Kernels near the ground; values of nodes that are not candidates are not compared.
template <int Dim, class Weights>
void expect_identical_near_the_ground(Scene<Dim>& scene, const Weights& weights, double dt) {
  const terrain::SeesCandidates<Dim> sees_candidates{scene.ground};
  terrain::NodesOnGround<Dim> on_ground{scene.nodes, scene.ground};
  const auto candidates = [](const auto& ground) { return ground.candidate; };
  const auto& motion = scene.model.motion;
  const Pass<decltype(on_ground), decltype(sees_candidates), decltype(candidates)> near_ground{
      "near ground", on_ground, sees_candidates, candidates};
  expect_identical_to_lanes(near_ground, scene, weights,
                            terrain::AddNearGround<Dim>{motion.phases, motion.lubrication});
  mpm::for_particles_in_memory(scene.particles, terrain::LeaveBand<Dim>{});
  const auto in_band = fields_by_id(scene.particles).at("in_band");
  EXPECT_EQ(std::count(in_band.begin(), in_band.end(), 0.0), static_cast<std::ptrdiff_t>(in_band.size()));
  const Pass<mpm::Nodes<Dim>, decltype(sees_candidates), decltype(everywhere)> band{"band", scene.nodes,
                                                                                    sees_candidates, everywhere};
  expect_identical_to_lanes(band, scene, mpm::LinearWeights{}, terrain::MarkBand<Dim>{dt});
  // In one pass with an independent kernel that processes all particles.
  expect_identical_to_lanes("move and band", scene, weights, mpm::Move<Dim>{0.1, dt}, terrain::MarkBand<Dim>{dt});
}

// New positions by tiles and in memory; some particles leave the domain.
template <int Dim>
void expect_the_same_positions(Scene<Dim>& scene) {
  Vector<double, Dim> lower = Vector<double, Dim>::Constant(-1e3), upper = -lower;
  upper[0] = scene.particles.position(scene.particles.size() / 2, 0);
  const mpm::UpdatePosition<Dim> kernel{lower, upper};
  std::vector<mpm::InvalidParticle> invalid;
  const auto bits = [&](const auto& run) {
    return bits_of<mpm::RecordList<>>(scene, everywhere, [&](auto& particles, auto& /*sums*/) {
      invalid.push_back(run(particles));
      return std::vector<double>{};
    });
  };
  const Bits by_tiles = bits([&](auto& particles) {
    return std::get<0>(
        mpm::particle_pass(scene.grid, mpm::LinearWeights{}, particles, scene.nodes, mpm::every_tile, kernel));
  });
  const Bits in_memory = bits([&](auto& particles) { return mpm::for_particles_in_memory(particles, kernel); });
  EXPECT_TRUE(are_identical(by_tiles, in_memory));
  EXPECT_NE(by_tiles.at("position"), fields_by_id(scene.particles).at("position"));
  const Pass<mpm::Nodes<Dim>, decltype(mpm::every_tile), decltype(everywhere)> pass{
      "positions", scene.nodes, mpm::every_tile, everywhere,
      false};  // the invalid particle with the smallest id may be in a later chunk
  expect_identical_to_lanes(pass, scene, mpm::LinearWeights{}, kernel);
  for (const mpm::InvalidParticle& found : invalid) {
    EXPECT_EQ(found.fault, mpm::Fault::left_domain);
    EXPECT_EQ(found.id, invalid.front().id);
  }
}

template <int Dim>
void expect_all_kernels_agree() {
  Simulation<Dim> simulation(two_bodies<Dim>(2e4, 3.0, 3.0));
  for (int k = 0; k < 60; ++k) {
    simulation.step(0.002);
  }
  Scene<Dim> scene(simulation);
  constexpr double dt = 0.002;
  auto& motion = scene.model.motion;
  const auto& band = scene.model.band;
  const mpm::MomentumWeights<mpm::Ugimp, Dim> ugimp{motion.sizes, motion.sides};
  const mpm::MomentumWeights<mpm::Quadratic, Dim> quadratic{motion.sizes, motion.sides};
  const mpm::AffineWeights<mpm::Ugimp, Dim> affine{{motion.sizes, motion.sides}};
  const mpm::LinearWeights by_linear;
  const mpm::AddMomentum<Dim> momentum{motion.gravity, motion.effective_stress, motion.viscous()};
  const mpm::UpdateStress<Dim> stress{motion.materials.data(), motion.phases, motion.effective_stress, dt};
  expect_identical_to_lanes("averages", scene, by_linear, band::AddAverages<Dim>{});
  expect_identical_to_lanes("momentum", scene, ugimp, momentum);
  expect_identical_to_lanes("momentum, quadratic", scene, quadratic, momentum);
  expect_identical_to_lanes("momentum, affine", scene, affine, mpm::AddAffineMomentum<Dim>{});
  expect_identical_to_lanes("move", scene, ugimp, mpm::Move<Dim>{0.1, dt});
  expect_identical_to_lanes("move, affine", scene, affine, mpm::MoveAffine<Dim>{dt});
  expect_identical_to_lanes("moments", scene, ugimp, mpm::AddFilterMoments<Dim>{});
  expect_identical_to_lanes("momentum to filter", scene, ugimp, mpm::AddFilterMomentum<Dim>{});
  expect_identical_to_lanes("sweep", scene, quadratic, mpm::SweepFilter<Dim>{});
  expect_identical_to_lanes("filtered", scene, ugimp, mpm::ApplyFiltered<Dim>{});
  expect_identical_near_the_ground(scene, ugimp, dt);
  expect_identical_near_the_ground(scene, quadratic, dt);
  expect_identical_to_lanes("stress", scene, ugimp, stress);
  expect_identical_to_lanes("seepage", scene, by_linear,
                            band::SeepageFlows<Dim>{band, band.hydraulic(), dt, scene.grid.inverse_cell()});
  band::FlowDepth<Dim> depth;
  depth.update(scene.grid, band, {}, scene.particles);
  expect_identical_to_lanes("pressure", scene, by_linear,
                            band::UpdatePorePressure<Dim, true, false>{scene.grid, band, depth});
  expect_identical_to_lanes("pressure without seepage", scene, by_linear,
                            band::UpdatePorePressure<Dim, false, false>{scene.grid, band, depth});
  auto balanced = band;
  balanced.frozen_rows = band::FrozenRows::sealed;
  balanced.ice_presses = false;
  balanced.skeleton_compressibility = 1e-8;
  balanced.water.law = physics::WaterExpansionLaw::by_temperature;
  balanced.conservative_advection = true;
  expect_identical_to_lanes("seeping water", scene, by_linear,
                            band::AddSeepingWater<Dim>{balanced, balanced.hydraulic()});
  expect_identical_to_lanes("seepage between sealed rows", scene, by_linear,
                            band::SeepageFlows<Dim>{balanced, balanced.hydraulic(), dt, scene.grid.inverse_cell()});
  expect_identical_to_lanes("pressure by the balance of water", scene, by_linear,
                            band::UpdatePorePressure<Dim, true, true>{scene.grid, balanced, depth});
  expect_identical_to_lanes("orphan heat", scene, ugimp, band::RedistributeUnreachedHeat<Dim>{dt});
  band::with_particle_heat(band, [&](const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    const band::HeatFlows<Dim, Law> flows{band, band.hydraulic(), law, dt, scene.grid.inverse_cell(), true};
    expect_identical_to_lanes("heat flows", scene, by_linear, flows);
    const band::HeatFlows<Dim, Law> conserving{balanced, balanced.hydraulic(),      law,
                                               dt,       scene.grid.inverse_cell(), true};
    expect_identical_to_lanes("heat flows with the water's heat", scene, by_linear, conserving);
    expect_identical_to_lanes("secant capacity", scene, by_linear, band::SecantCapacity<Dim, Law>{law, dt});
    expect_identical_to_lanes("heat", scene, by_linear, band::UpdateHeat<Dim, Law>{band, law, dt});
    expect_identical_to_lanes("heat as published", scene, by_linear,
                              band::UpdateHeatApparentCapacity<Dim, Law>{band, law, dt});
  });
  expect_the_same_positions(scene);
}

TEST(Device, KernelsAreBitwiseIdenticalToLanesInThePlane) { expect_all_kernels_agree<2>(); }

TEST(Device, KernelsAreBitwiseIdenticalToLanesInSpace) { expect_all_kernels_agree<3>(); }

}  // namespace
}  // namespace thawslide::sim
