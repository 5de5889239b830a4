// Contact between bodies, release in stages and sections of varying width: runs on the CPU emulation of the GPU backend
// compared with runs on the CPU.
#include "run_on_device.hpp"

namespace thawslide::sim {
namespace {

const Sets contact = "contact.between_bodies=frictional; contact.friction_angle=20";

template <int Dim>
Sets left_at(const std::string& speed) {
  return "body.left.velocity=[" + speed + (Dim == 2 ? ",0]" : ",0,0]");
}
template <int Dim>
Sets left_held(double until) {
  return left_at<Dim>("0") + Sets(fmt::format("body.left.release_time={}", until));
}

// The left body is faster, and reaches the right one after some steps; or it is held, and the right one leaves it.
template <int Dim>
void expect_the_same_contact(const Sets& more, int steps) {
  const Sets held = left_held<Dim>(0.03);
  for (const Sets& sets : {contact + left_at<Dim>("6"), held, contact + held}) {
    SCOPED_TRACE(fmt::format("{}", fmt::join(sets + more, "; ")));
    EXPECT_EQ(expect_the_same_run<Dim>(sliding_bodies<Dim>(sets + more), steps), 0);
  }
}
TEST(DeviceRunOfBodies, HasTheContactAndTheStagesOfTheCpu) {
  expect_the_same_contact<2>({}, 45);
  expect_the_same_contact<2>("mechanics.transfer=apic; time.stepping=adaptive", 30);
  expect_the_same_contact<2>("mechanics.shape_function=quadratic", 25);
  expect_the_same_contact<2>("mechanics.transfer=fmpm; mechanics.fmpm_interval=0.005", 25);
  expect_the_same_contact<3>({}, 22);
}

template <int Dim>
std::vector<double> velocities_after(const Sets& sets, int steps) {
  Simulation<Dim> simulation(sliding_bodies<Dim>(sets));
  for (int k = 0; k < steps; ++k) {
    simulation.step(0.002);
  }
  return fields_by_id(simulation.particles()).at("velocity");
}
TEST(DeviceRunOfBodies, ComparesBodiesThatTouch) {
  const Sets less = "contact.friction_angle=5";
  EXPECT_NE(velocities_after<2>(contact + left_at<2>("6"), 45),
            velocities_after<2>(contact + left_at<2>("6") + less, 45));
  EXPECT_NE(velocities_after<3>(contact + left_at<3>("6"), 22),
            velocities_after<3>(contact + left_at<3>("6") + less, 22));
}

// A third body on the other two.
TEST(DeviceRunOfBodies, HasTheContactOfThreeBodies) {
  const Sets third =
      "body.top.material=melted; body.top.temperature=0.5; body.top.porosity=0.3; body.top.particles_per_axis=2; "
      "body.top.velocity=[3,-2]; body.top.min=[5,5.1]; body.top.max=[9,7]; body.right.max=[11.3,5]";
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(contact + left_at<2>("6") + third), 45), 0);
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(contact + left_held<2>(0.03) + third), 45), 0);
}

// The right body leaves the left one.
TEST(DeviceRunOfBodies, HasTheContactOfBodiesThatPart) {
  const Sets sets = contact + left_at<2>("3") + Sets("body.right.velocity=[30,0]");
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(sets), 120), 0);
}

TEST(DeviceRunOfBodies, SplitsTheParticlesOfStages) {
  const Sets splits = "mechanics.split_stretched=true; body.right.velocity=[12,0]";
  EXPECT_GT(expect_the_same_run<2>(sliding_bodies<2>(left_held<2>(0.05) + splits), 45), 0);
}

TEST(DeviceRunOfBodies, KeepsBandColumnsAndTheBedOfStages) {
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(left_held<2>(0.03) + on_columns), 45), 0);
  const Sets bed = loose_bed() + Sets("bed.law=momentum; pressure.frozen=none");
  EXPECT_GT(expect_the_same_run<2>(sliding_bodies<2>(left_held<2>(0.03) + bed), 90), 0);
}

TEST(DeviceRunOfBodies, SettlesStages) { expect_the_same_settling(left_held<2>(0.02)); }

TEST(DeviceRunOfBodies, RemovesParticlesThatLeaveAnotherBody) {
  const Sets sets = left_held<2>(0.2) + Sets("grid.leaving=remove; grid.max=[12.0,18.0]; body.right.velocity=[12,0]");
  const int first = steps_until_one_leaves(sliding_bodies<2>(sets));
  EXPECT_GT(expect_the_same_run<2>(sliding_bodies<2>(sets), first + 20), 0);
}

TEST(DeviceRunOfBodies, KeepsStagesOnADem) {
  for (const Sets& sets : {left_held<3>(0.012), left_held<3>(0.012) + contact}) {
    EXPECT_EQ(expect_the_same_run<3>(sliding_bodies<3>(on_dem() + sets), 12, bumpy_site()), 0);
  }
}

TEST(DeviceRunOfBodies, HasTheVaryingWidthOfASection) {
  const Sets width = "case.width={ x = [-2.0, 6.0, 14.0], value = [10.0, 30.0, 15.0] }";
  const Sets passed = "case.width={ x = [3.0, 6.0], value = [10.0, 30.0] }";  // the bodies extend beyond both ends
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(width), 45), 0);
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(passed + "mechanics.transfer=apic; time.stepping=adaptive"), 30),
            0);
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(passed + "material.melted.viscosity_time=1e-4"), 25), 0);
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(width + "pressure.frozen=none"), 25), 0);
  EXPECT_EQ(expect_the_same_run<2>(sliding_bodies<2>(on_columns + width), 45), 0);
}

}  // namespace
}  // namespace thawslide::sim
