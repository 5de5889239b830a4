// Kernels as a device runs them, a group of threads a tile in phases between barriers (mpm/group_pass.hpp), against the
// lanes of the processor: the same bits whatever the order of the threads, and others where a barrier is left out.

// Eigen adds up small vectors of numbers in registers of its own, with contracted products: not here, while its types
// keep the alignment that they have elsewhere.
#define EIGEN_DONT_VECTORIZE
#ifdef __AVX512F__
#define EIGEN_MAX_STATIC_ALIGN_BYTES 64
#else
#define EIGEN_MAX_STATIC_ALIGN_BYTES 32
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <typeinfo>

#include "../support/fields.hpp"
#include "../support/two_bodies.hpp"
#include "band/averages_kernel.hpp"
#include "band/heat_kernels.hpp"
#include "band/pore_pressure_of_tile.hpp"
#include "mpm/filter_kernels.hpp"
#include "mpm/group_pass.hpp"
#include "mpm/motion_kernels.hpp"
#include "mpm/position_kernel.hpp"
#include "mpm/stress_kernel.hpp"
#include "sim/simulation.hpp"
#include "terrain/band_marks_kernel.hpp"
#include "terrain/nodes_on_ground.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using mpm::HostGroup, mpm::ThreadOrder;

// What a pass refuses to compile: a record that is read and added to, under one name or two.
using mpm::are_disjoint, mpm::RecordList;
static_assert(are_disjoint<RecordList<mpm::Motion, mpm::NodalState>, RecordList<mpm::Velocity, mpm::HeatRates>>);
static_assert(are_disjoint<RecordList<>, RecordList<mpm::Velocity>>);
static_assert(!are_disjoint<RecordList<mpm::Motion, mpm::Velocity>, RecordList<mpm::HeatRates, mpm::Velocity>>);
static_assert(!are_disjoint<RecordList<mpm::Velocity>, RecordList<mpm::AffineVelocity>>);
static_assert(!are_disjoint<RecordList<mpm::AffineMotion>, RecordList<mpm::Motion>>);
// Two ways to add to the same components of a record, and patches of two records in the same room.
static_assert(mpm::all_apart<RecordList<mpm::NearGround, mpm::NearGroundByLinear, mpm::Clearance>, 3>);
static_assert(!mpm::all_apart<RecordList<mpm::Momentum, mpm::AffineMomentum>, 3>);
static_assert(!mpm::all_apart<RecordList<mpm::AffineVelocity, mpm::Velocity>, 2>);
static_assert(mpm::one_record<RecordList<mpm::NearGround, mpm::Clearance>>);
static_assert(!mpm::one_record<RecordList<mpm::Velocity, mpm::HeatRates>>);

// Particles of a run of two bodies, copied, on a grid of their own, with nodes that hold any numbers, and the ground.
template <int Dim>
class Scene {
 public:
  explicit Scene(const Simulation<Dim, double>& simulation)
      : model(simulation.model()), grid(simulation.grid().cell()) {
    copy(simulation.particles(), particles);
    grid.update(particles, 64);
    particles.affine_velocity.keep(true);
    particles.viscous_stress.keep(true);
    std::mt19937 random(7);
    particles.affine_velocity.resize(particles.size());
    particles.viscous_stress.resize(particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p) {
      for (int c = 0; c < Dim * Dim; ++c) {
        particles.affine_velocity(p, c) = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
      }
      // Most hover, so that what they read of the distance matters.
      particles.contact_offset(p) = std::uniform_real_distribution<double>(-1.0, 0.1)(random);
      particles.pore_void(p) = std::uniform_real_distribution<double>(-1e-4, 1e-4)(random);
      particles.normal_load(p) = std::uniform_real_distribution<double>(0.0, 1e5)(random);
      particles.load_change(p) = std::uniform_real_distribution<double>(-1e3, 1e3)(random);
    }
    ground.update(*model.ground, grid);
    fill<mpm::NodalState>({1.0, 1e5, 0.1, 1e3}, random);
    fill<mpm::Velocity>({1.0, 2.0, 0.5}, random);
    fill<mpm::Motion>({10.0, 5.0, 8.0, 1.0, 2.0, 3.0}, random);
    fill<mpm::FilterIncrement>({1.0, 2.0, 0.5, 0.2, 0.1, 0.3}, random);
    fill<mpm::FilterTotal>({10.0, 5.0, 2.0, 0.4, 0.3, 0.1}, random);
    fill<mpm::OrphanHeat>({2.0}, random);
    fill<mpm::Contact>({1.0, 1.0, 3.0, 1e3}, random);
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
        auto& contact = nodes.contact.of_block(b)[k];
        const bool candidate = ground.block(b)[k].candidate;
        const double touching = candidate && contact[mpm::Contact::touching] > 0.0 ? 1.0 : 0.0;
        contact[mpm::Contact::candidate] = candidate ? 1.0 : 0.0;
        contact[mpm::Contact::touching] = touching;
        contact[mpm::Contact::slip_speed] *= touching;
      }
    }
  }

  static void copy(const mpm::Particles<Dim, double>& from, mpm::Particles<Dim, double>& to) {
    to.resize(from.size());
    for (std::size_t f = 0; f < from.fields.all().size(); ++f) {
      to.fields.all()[f]->set_bytes(from.fields.all()[f]->bytes());
    }
  }

  template <class Name>
  void fill(const std::vector<double>& sizes, std::mt19937& random) {
    auto& records = nodes.template of<Name>();
    if constexpr (requires { records.holds(0); }) {
      records.hold(grid.blocks().size(), [](std::size_t /*block*/) { return true; });
    } else {
      records.resize(grid.blocks().size());
    }
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
        auto& record = records.of_block(b)[k];
        record.fill(0.0);
        for (std::size_t c = 0; c < static_cast<std::size_t>(mpm::components_of<Name, Dim>); ++c) {
          record[c] = std::uniform_real_distribution<double>(-sizes[c], sizes[c])(random);
        }
      }
    }
  }

  Model<Dim, double> model;
  mpm::SparseGrid<Dim, double> grid;
  mpm::Particles<Dim, double> particles;
  mpm::Nodes<Dim, double> nodes;
  terrain::GroundOnGrid<Dim, double> ground;
};

// What a pass needs beside weights and kernels: its records, what of tiles it takes, and whether its sums are asked for
// at what the ground knows of a node.
template <class Records, class Takes, class Asked>
struct Pass {
  std::string name;
  Records& records;
  Takes takes;
  Asked asked;
};
constexpr auto everywhere = [](const auto& /*ground*/) { return true; };

// Every bit that a pass leaves: in fields, in the patches that it adds to, and its sums.
using Bits = std::map<std::string, std::vector<double>>;

template <class Name, int Dim, class Asked>
void take_patches_of(Scene<Dim>& scene, const Asked& asked, Bits& bits) {
  auto& of_name = bits[typeid(Name).name()];
  const auto patches = scene.nodes.template of<Name>().patches(scene.grid.tiles().size());
  for (std::size_t t = 0; t < patches.size(); ++t) {
    const std::int32_t* blocks = scene.grid.blocks_about_tile(t);
    mpm::for_each_direction<Dim>([&](auto d) {
      const auto& block = scene.ground.block(static_cast<std::size_t>(blocks[d]));
      mpm::for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
        const auto& record = patches[t].records[in_patch];
        if (asked(block[in_block])) {
          of_name.insert(of_name.end(), record.begin(), record.end());
        }
      });
    });
  }
}

bool are_same(const Bits& a, const Bits& b) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const auto& item) {
           const auto& other = b.at(item.first);
           return item.second.size() == other.size() &&
                  std::memcmp(item.second.data(), other.data(), other.size() * sizeof(double)) == 0;
         });
}

template <class Adds>
struct PatchesOf;
template <class... Names>
struct PatchesOf<mpm::RecordList<Names...>> {
  template <int Dim>
  static void clear([[maybe_unused]] Scene<Dim>& scene) {
    [[maybe_unused]] const auto clear_one = [&](auto patches) {
      for (auto& patch : patches) {
        patch.clear();
      }
    };
    (clear_one(scene.nodes.template of<Names>().patches(scene.grid.tiles().size())), ...);
  }
  template <int Dim, class Asked>
  static void take([[maybe_unused]] Scene<Dim>& scene, [[maybe_unused]] const Asked& asked,
                   [[maybe_unused]] Bits& bits) {
    (take_patches_of<Names>(scene, asked, bits), ...);
  }
  static constexpr int count = sizeof...(Names);
};

// Runs a pass by run(particles) on a copy of the scene's particles.
template <class Adds, int Dim, class Asked, class Run>
Bits bits_of(Scene<Dim>& scene, const Asked& asked, const Run& run) {
  mpm::Particles<Dim, double> particles;
  particles.affine_velocity.keep(true);
  particles.viscous_stress.keep(true);
  Scene<Dim>::copy(scene.particles, particles);
  PatchesOf<Adds>::clear(scene);
  run(particles);
  Bits bits = fields_by_id(particles);
  PatchesOf<Adds>::take(scene, asked, bits);
  return bits;
}

// The pass of some kernels by lanes and by groups.
template <int Dim, class Records, class Takes, class Asked, class Weights, class... Kernels>
void expect_the_bits_of_lanes(const Pass<Records, Takes, Asked>& pass, Scene<Dim>& scene, const Weights& weights,
                              const Kernels&... kernels) {
  const std::string& name = pass.name;
  using Adds = mpm::AllOf<typename Kernels::Adds...>;
  using Reads = mpm::AllOf<typename Kernels::Reads...>;
  Bits before = fields_by_id(scene.particles);
  PatchesOf<Adds>::clear(scene);
  PatchesOf<Adds>::take(scene, pass.asked, before);
  const Bits by_lanes = bits_of<Adds>(scene, pass.asked, [&](auto& particles) {
    mpm::particle_pass(scene.grid, weights, particles, pass.records, pass.takes, kernels...);
  });
  const auto by_group = [&](HostGroup group) {
    return bits_of<Adds>(scene, pass.asked, [&](auto& particles) {
      mpm::group_pass(group, scene.grid, weights, particles, pass.records, pass.takes, kernels...);
    });
  };
  EXPECT_FALSE(are_same(by_lanes, before)) << name;
  for (const auto& [field, numbers] : by_lanes) {
    EXPECT_TRUE(std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        << name << field;
  }
  for (const ThreadOrder order : {ThreadOrder::forward, ThreadOrder::backward, ThreadOrder::shuffled}) {
    for (const std::size_t threads : {std::size_t{32}, std::size_t{7}}) {
      const Bits found = by_group({threads, order});
      for (const auto& [field, numbers] : by_lanes) {
        EXPECT_EQ(std::memcmp(found.at(field).data(), numbers.data(), numbers.size() * sizeof(double)), 0)
            << name << ": " << field << ", " << threads << " threads, order " << static_cast<int>(order);
      }
    }
  }
  constexpr bool reads = !std::is_same_v<Reads, mpm::RecordList<>>;
  constexpr int added = PatchesOf<Adds>::count, first = reads ? 0 : 1, last = added > 0 ? 1 + added : 0;
  for (int barrier = first; barrier <= last; ++barrier) {
    EXPECT_FALSE(are_same(by_lanes, by_group({7, ThreadOrder::shuffled, barrier}))) << name << ", barrier " << barrier;
  }
}
template <int Dim, class Weights, class... Kernels>
void expect_the_bits_of_lanes(const std::string& name, Scene<Dim>& scene, const Weights& weights,
                              const Kernels&... kernels) {
  const Pass<mpm::Nodes<Dim, double>, decltype(mpm::every_tile), decltype(everywhere)> pass{
      name, scene.nodes, mpm::every_tile, everywhere};
  expect_the_bits_of_lanes(pass, scene, weights, kernels...);
}

// What is near the ground: what the nodes that are no candidates hold is not asked for.
template <int Dim, class Weights>
void expect_the_bits_near_the_ground(Scene<Dim>& scene, const Weights& weights, double dt) {
  const terrain::SeesCandidates<Dim, double> sees_candidates{scene.ground};
  terrain::NodesOnGround<Dim, double> on_ground{scene.nodes, scene.ground};
  const auto candidates = [](const auto& ground) { return ground.candidate; };
  const auto& motion = scene.model.motion;
  const Pass<decltype(on_ground), decltype(sees_candidates), decltype(candidates)> near_ground{
      "near ground", on_ground, sees_candidates, candidates};
  expect_the_bits_of_lanes(near_ground, scene, weights,
                           terrain::AddNearGround<Dim, double>{motion.phases, motion.lubrication});
  mpm::for_particles_in_memory(scene.particles, terrain::LeaveBand<Dim, double>{});
  const auto in_band = fields_by_id(scene.particles).at("in_band");
  EXPECT_EQ(std::count(in_band.begin(), in_band.end(), 0.0), static_cast<std::ptrdiff_t>(in_band.size()));
  const Pass<mpm::Nodes<Dim, double>, decltype(sees_candidates), decltype(everywhere)> band{
      "band", scene.nodes, sees_candidates, everywhere};
  expect_the_bits_of_lanes(band, scene, mpm::LinearWeights{}, terrain::MarkBand<Dim, double>{dt});
  // In one pass with what needs nothing of it, of which all particles take part.
  expect_the_bits_of_lanes("move and band", scene, weights, mpm::Move<Dim, double>{0.1, dt},
                           terrain::MarkBand<Dim, double>{dt});
}

// New positions by tiles, in memory and by groups; some particles would leave the domain.
template <int Dim>
void expect_the_same_positions(Scene<Dim>& scene) {
  Vector<double, Dim> lower = Vector<double, Dim>::Constant(-1e3), upper = -lower;
  upper[0] = scene.particles.position(scene.particles.size() / 2, 0);
  const mpm::TakePosition<Dim, double> kernel{lower, upper};
  std::vector<mpm::BadParticle> bad;
  const auto bits = [&](const auto& run) {
    return bits_of<mpm::RecordList<>>(scene, everywhere, [&](auto& particles) { bad.push_back(run(particles)); });
  };
  const Bits by_tiles = bits([&](auto& particles) {
    return std::get<0>(
        mpm::particle_pass(scene.grid, mpm::LinearWeights{}, particles, scene.nodes, mpm::every_tile, kernel));
  });
  const Bits in_memory = bits([&](auto& particles) { return mpm::for_particles_in_memory(particles, kernel); });
  const Bits by_groups = bits([&](auto& particles) {
    HostGroup group(7, ThreadOrder::shuffled);
    return std::get<0>(
        mpm::group_pass(group, scene.grid, mpm::LinearWeights{}, particles, scene.nodes, mpm::every_tile, kernel));
  });
  EXPECT_TRUE(are_same(by_tiles, in_memory));
  EXPECT_TRUE(are_same(by_tiles, by_groups));
  EXPECT_NE(by_tiles.at("position"), fields_by_id(scene.particles).at("position"));
  for (const mpm::BadParticle& found : bad) {
    EXPECT_EQ(found.fault, mpm::Fault::left_domain);
    EXPECT_EQ(found.id, bad.front().id);
  }
}

template <int Dim>
void expect_all_kernels_agree() {
  Simulation<Dim, double> simulation(two_bodies<Dim>(2e4, 3.0, 3.0));
  for (int k = 0; k < 60; ++k) {
    simulation.step(0.002);
  }
  Scene<Dim> scene(simulation);
  constexpr double dt = 0.002;
  auto& motion = scene.model.motion;
  const auto& band = scene.model.band;
  const mpm::MomentumWeights<mpm::Ugimp<double>, Dim, double> ugimp{motion.sizes, motion.sides};
  const mpm::MomentumWeights<mpm::Quadratic<double>, Dim, double> quadratic{motion.sizes, motion.sides};
  const mpm::MomentumWeights<mpm::Linear<double>, Dim, double> linear{motion.sizes, motion.sides};
  const mpm::AffineWeights<mpm::Ugimp<double>, Dim, double> affine{{motion.sizes, motion.sides}};
  const mpm::LinearWeights by_linear;
  const mpm::AddMomentum<Dim, double> momentum{motion.gravity, motion.effective_stress, motion.viscous()};
  const mpm::UpdateStress<Dim, double> stress{motion.materials.data(), motion.phases, motion.effective_stress, dt};
  expect_the_bits_of_lanes("averages", scene, by_linear, band::AddAverages<Dim, double>{});
  expect_the_bits_of_lanes("momentum", scene, ugimp, momentum);
  expect_the_bits_of_lanes("momentum, quadratic", scene, quadratic, momentum);
  expect_the_bits_of_lanes("momentum, affine", scene, affine, mpm::AddAffineMomentum<Dim, double>{});
  expect_the_bits_of_lanes("move", scene, ugimp, mpm::Move<Dim, double>{0.1, dt});
  expect_the_bits_of_lanes("move, linear", scene, linear, mpm::Move<Dim, double>{0.1, dt});
  expect_the_bits_of_lanes("move, affine", scene, affine, mpm::MoveAffine<Dim, double>{dt});
  expect_the_bits_of_lanes("moments", scene, ugimp, mpm::AddFilterMoments<Dim, double>{});
  expect_the_bits_of_lanes("momentum to filter", scene, ugimp, mpm::AddFilterMomentum<Dim, double>{});
  expect_the_bits_of_lanes("sweep", scene, quadratic, mpm::SweepFilter<Dim, double>{});
  expect_the_bits_of_lanes("filtered", scene, ugimp, mpm::TakeFiltered<Dim, double>{});
  expect_the_bits_near_the_ground(scene, ugimp, dt);
  expect_the_bits_near_the_ground(scene, quadratic, dt);
  expect_the_bits_of_lanes("stress", scene, ugimp, stress);
  expect_the_bits_of_lanes("seepage", scene, by_linear,
                           band::SeepageFlows<Dim, double>{band, band.hydraulic(), dt, scene.grid.inverse_cell()});
  band::FlowDepth<Dim, double> depth;
  depth.update(scene.grid, band, {}, scene.particles);
  expect_the_bits_of_lanes("pressure", scene, by_linear,
                           band::UpdatePorePressure<Dim, double, true, false>{scene.grid, band, depth});
  expect_the_bits_of_lanes("pressure without seepage", scene, by_linear,
                           band::UpdatePorePressure<Dim, double, false, false>{scene.grid, band, depth});
  auto balanced = band;
  balanced.frozen_rows = band::FrozenRows::sealed;
  balanced.ice_presses = false;
  balanced.skeleton_compressibility = 1e-8;
  balanced.water.law = physics::WaterExpansionLaw::by_temperature;
  balanced.conservative_advection = true;
  expect_the_bits_of_lanes("seeping water", scene, by_linear,
                           band::AddSeepingWater<Dim, double>{balanced, balanced.hydraulic()});
  expect_the_bits_of_lanes(
      "seepage between sealed rows", scene, by_linear,
      band::SeepageFlows<Dim, double>{balanced, balanced.hydraulic(), dt, scene.grid.inverse_cell()});
  expect_the_bits_of_lanes("pressure by the balance of water", scene, by_linear,
                           band::UpdatePorePressure<Dim, double, true, true>{scene.grid, balanced, depth});
  expect_the_bits_of_lanes("orphan heat", scene, ugimp, band::TakeOrphanHeat<Dim, double>{dt});
  band::with_particle_heat(band, [&](const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    const band::HeatFlows<Dim, double, Law> flows{band, band.hydraulic(), law, dt, scene.grid.inverse_cell(), true};
    expect_the_bits_of_lanes("heat flows", scene, by_linear, flows);
    const band::HeatFlows<Dim, double, Law> conserving{balanced, balanced.hydraulic(),      law,
                                                       dt,       scene.grid.inverse_cell(), true};
    expect_the_bits_of_lanes("heat flows with the water's heat", scene, by_linear, conserving);
    expect_the_bits_of_lanes("secant capacity", scene, by_linear, band::SecantCapacity<Dim, double, Law>{law, dt});
    expect_the_bits_of_lanes("heat", scene, by_linear, band::TakeHeat<Dim, double, Law>{band, law, dt});
    expect_the_bits_of_lanes("heat as printed", scene, by_linear,
                             band::TakeHeatAsPrinted<Dim, double, Law>{band, law, dt});
  });
  expect_the_same_positions(scene);
}

TEST(Group, RunsTheKernelsOfTheStepWithTheBitsOfLanesInThePlane) { expect_all_kernels_agree<2>(); }

TEST(Group, RunsTheKernelsOfTheStepWithTheBitsOfLanesInSpace) { expect_all_kernels_agree<3>(); }

}  // namespace
}  // namespace thawslide::sim
