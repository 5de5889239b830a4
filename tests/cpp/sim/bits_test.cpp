// Results are bitwise independent of the number of threads and of the order of particles in memory, for all options.
#include "../support/reproducible_runs.hpp"
#include "../support/two_bodies.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

using State = std::map<std::string, std::vector<double>>;

// Bodies that move into new tiles, large enough that every loop of the time step is distributed to threads.
template <int Dim>
void expect_the_same_bits(double length, double height, int steps) {
  constexpr std::size_t particles_of_shared_loops = 1024 * fewest_shared_calls;  // chunk size of loops
  const auto parameters = two_bodies<Dim>(5e3, length, height, 20.0);
  int changes = 0;
  const auto visit = [&](const Simulation<Dim>& simulation, int step) {
    EXPECT_GE(simulation.grid().tiles().size(), fewest_shared_calls);
    EXPECT_GT(simulation.particle_count(), particles_of_shared_loops);
    changes += step > 0 && simulation.grid().blocks_changed() ? 1 : 0;
  };
  expect_reproducible_run<Dim>([&] { return std::make_unique<Simulation<Dim>>(parameters); }, steps,
                               {{1, 1, -1}, {2, 7, -1}, {3, 20, -1}, {4, 3, -1}}, visit);
  EXPECT_GE(changes, 5) << "in each of five runs";
}

TEST(Bits, DependNeitherOnThreadsNorOnSortingInThePlane) { expect_the_same_bits<2>(119.2, 20.0, 60); }
TEST(Bits, DependNeitherOnThreadsNorOnSortingInSpace) { expect_the_same_bits<3>(70.8, 5.0, 30); }

template <int Dim>
constexpr double length = Dim == 2 ? 30.0 : 12.0;  // of the left body [m]

const Sets plane = "terrain.type=plane; terrain.slope=0.5; terrain.elevation=-0.01";

// Options of a case, added to two bodies that move down a slope. acts: evidence that the option has an effect, if a
// state different from the one without it is not sufficient.
struct Choice {
  std::string name;
  Sets sets;
  bool (*acts)(const State&, const State& plain) = nullptr;
};

bool melts(const State& state, const State& /*plain*/) {
  bool any = false;
  for (std::size_t k = 0; k < state.at("body").size(); ++k) {
    any = any || (state.at("body")[k] == 0.0 && state.at("temperature")[k] > 0.0);
  }
  return any;
}

bool lacks_particles(const State& state, const State& plain) { return state.at("id").size() < plain.at("id").size(); }

// A box around the upper part of the left body, which drives it.
template <int Dim>
Sets frame() {
  return fmt::format(
      "frame.driver.min=[-3.0, {}2.4]; frame.driver.max=[7.5, {}20.0]; frame.driver.axis=x; frame.driver.velocity=25",
      Dim == 2 ? "" : "-4.0, ", Dim == 2 ? "" : "10.0, ");
}

template <int Dim>
std::vector<Choice> choices() {
  const auto corner = [](const char* key, double x, double across, double height) {
    return Dim == 2 ? fmt::format("grid.{}=[{}, {}]", key, x, height)
                    : fmt::format("grid.{}=[{}, {}, {}]", key, x, across, height);
  };
  const std::string near_front = corner("max", length<Dim> + 5.0, 10.0, 20.0);
  std::vector<Choice> all{
      {"a plane that cuts through cells", plane},
      {"APIC", "mechanics.transfer=apic"},
      {"APIC, quadratic", "mechanics.transfer=apic; mechanics.shape_function=quadratic"},
      {"FLIP and PIC", "mechanics.transfer=blend; mechanics.pic_fraction=0.1"},
      {"FMPM", "mechanics.transfer=fmpm; mechanics.fmpm_interval=0.005; mechanics.fmpm_order=3"},
      {"quadratic shape functions", "mechanics.shape_function=quadratic"},
      {"adaptive steps", "time.stepping=adaptive"},
      {"viscosity, gaps", "material.frozen.viscosity_time=2e-4; material.melted.gaps_close_first=true"},
      {"mass damping", "mechanics.mass_damping=2.0"},
      {"effective stress", "mechanics.effective_stress=true; pressure.volumetric_term=true; time.step=0.0005"},
      {"noise", "initial.noise=0.2"},
      {"a moving frame", frame<Dim>()},
      {"sides", {"grid.boundary.x_max=roller", "grid.boundary.x_min=fixed", near_front}},
      {"distance unchecked", "basal.distance_check=false" + plane},
      {"cohesion lost by slip",
       "basal.cohesion=1e4; basal.cohesion_law=slip; basal.slip_distance=2.0; basal.clamp=joint"},
      {"two substrates",
       "substrate.ice.x_min=8.3; substrate.ice.friction=coefficient; substrate.ice.friction_coefficient=0.1; "
       "substrate.rock.x_max=2.1; substrate.rock.friction_angle=30; substrate.rock.cohesion=1e4; "
       "substrate.rock.cohesion_law=bonds; substrate.rock.slip_distance=2"},
      {"Voellmy friction", "basal.friction=voellmy; basal.friction_coefficient=0.2; basal.turbulent_friction=100"},
      {"bodies in frictional contact", "contact.between_bodies=frictional; contact.friction_angle=20.0"},
      {"bodies in frictional contact, APIC, above a plane",
       "contact.between_bodies=frictional; contact.friction_angle=20.0; mechanics.transfer=apic" + plane},
      {"the first layer", "band.region=first_layer"},
      {"the first layer above a plane", "band.region=first_layer" + plane},
      {"a band that thickens", "band.thickness={time=[0.0,0.05],value=[0.1,0.2]}"},
      {"melting", "body.left.temperature=-1e-6", melts},
      {"freezing along a line", "freezing.curve=linear; freezing.slope=0.5"},
      {"apparent capacity", "heat.update=apparent_capacity"},
      {"heat through a side", {"heat.boundary.x_min={temperature=5.0}", corner("min", 0.0, -4.0, -4.0)}},
      {"seepage", "material.frozen.hydraulic_conductivity=1e-8; material.melted.hydraulic_conductivity=1e-8"},
      {"sealed frozen rows", "pressure.frozen_rows=sealed; body.left.temperature=-1e-6", melts},
      {"vented frozen rows", "pressure.frozen_rows=vented; body.left.temperature=-1e-6", melts},
      {"a balance of water",
       "pressure.frozen=none; pressure.residual_stress=1e3; pressure.melt_contraction=true; "
       "pressure.skeleton_compressibility=1e-8; phases.water_expansion_law=by_temperature; body.left.temperature=-1e-6",
       melts},
      {"heat that is conserved",
       "heat.advection_form=conservative; band.thickness_change=conserving; "
       "band.thickness={time=[0.0,0.05],value=[0.1,0.2]}"},
      {"frozen thickness", "pressure.thickness_update=frozen; pressure.thickness_direction=vertical"},
      {"leaving",
       {"grid.leaving=remove", near_front, Dim == 2 ? "body.right.velocity=[60,0]" : "body.right.velocity=[60,0,0]"},
       lacks_particles},
  };
  if (Dim == 3) {
    all.push_back({"a DEM", on_dem()});
    all.push_back({"a DEM, the first layer", "band.region=first_layer" + on_dem()});
  }
  return all;
}

template <int Dim>
State state_with(const Choice& choice, const Execution& by) {
  const auto make = [&] {
    return std::make_unique<Simulation<Dim>>(two_bodies<Dim>(5e3, length<Dim>, 5.0, 20.0, choice.sets), bumpy_site());
  };
  return state_after<Dim>(make, Dim == 2 ? 40 : 16, by, [](const Simulation<Dim>& simulation, int /*step*/) {
    EXPECT_GE(simulation.grid().tiles().size(), fewest_shared_calls);
  });
}

bool differs(const State& state, const State& plain) {
  return std::any_of(state.begin(), state.end(), [&](const auto& named) {
    const bool is_of_history = named.first.rfind("history: ", 0) == 0;
    return !is_of_history && (plain.count(named.first) == 0 || plain.at(named.first) != named.second);
  });
}

template <int Dim>
void expect_the_same_bits_with_every_choice() {
  const State plain = state_with<Dim>({}, {1, 0, -1});
  for (const Choice& choice : choices<Dim>()) {
    SCOPED_TRACE(choice.name);
    const State first = state_with<Dim>(choice, {1, 0, -1});
    EXPECT_TRUE(differs(first, plain) && (choice.acts == nullptr || choice.acts(first, plain)))
        << "the option has no effect";
    for (const Execution& by : {Execution{2, 7, -1}, Execution{3, 1, -1}}) {
      expect_the_same_state(first, state_with<Dim>(choice, by), fmt::format("{} threads", by.threads));
    }
  }
}

TEST(Bits, AreTheSameWithEveryOptionInThePlane) { expect_the_same_bits_with_every_choice<2>(); }
TEST(Bits, AreTheSameWithEveryOptionInSpace) { expect_the_same_bits_with_every_choice<3>(); }

}  // namespace
}  // namespace thawslide::sim
