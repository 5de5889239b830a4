// Patch tests: uniform fields remain uniform for any position of the grid lines in the body. Linear fields are
// reproduced by FLIP if particles are at their initial positions, by APIC at any positions. Manufactured momentum
// balance: a square that vibrates along its axes, with each shape function and transfer.
#include "manufactured_vibration.hpp"
#include "physics/elasticity.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const Sets patch{"time.step=1e-4; grid.max=[20,20]; material.rock.youngs_modulus=5e8",
                 "material.rock.poisson_ratio=0.2; body.block.min=[4,4]; body.block.max=[16,16]"};

config::Case patch_case(const std::string& shape, const std::string& transfer) {
  return published_case("free",
                        patch + fmt::format("mechanics.shape_function={}; mechanics.transfer={}", shape, transfer));
}

// Moves the body by a fraction of a cell along both axes.
void shift_body(Simulation<2>& simulation, double shift) {
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.position(p, 0) += shift;
    particles.position(p, 1) += 0.7 * shift;
  }
}

// So far from the body's edges that its nodes are surrounded by material.
template <class Visit>
void for_inner_particles(const Simulation<2>& simulation, const Visit& visit) {
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    const double x = simulation.particles().position(p, 0), y = simulation.particles().position(p, 1);
    if (std::max(std::abs(x - 10.0), std::abs(y - 10.0)) < 2.5) {
      visit(p);
    }
  }
}

const std::vector<std::string> shapes{"ugimp", "quadratic"};
const std::vector<double> shifts{0.0, 0.13, 0.25, 0.371, 0.5};

TEST(Patch, UniformStressCausesNoMotion) {
  Record record("Patch test: uniform stress",
                "A body under uniform stress, cut by the grid's lines anywhere; within it nothing may accelerate.",
                "no force on inner nodes", "statics");
  for (const std::string& shape : shapes) {
    double largest = 0.0;
    for (const double shift : shifts) {
      Simulation<2> simulation(patch_case(shape, "flip"));
      shift_body(simulation, shift);
      auto& particles = simulation.particles();
      for (std::size_t p = 0; p < particles.size(); ++p) {
        particles.stress(p, 0) = -3e6;
        particles.stress(p, 1) = -1e6;
        particles.stress(p, 3) = 5e5;
      }
      simulation.step(1e-4);
      const double free = 3e6 / 2062.0 * 1e-4;  // velocity gain of a node with one-sided stress, stress/(rho h) dt
      for_inner_particles(simulation, [&](std::size_t p) {
        largest = std::max(largest, particles.velocity.template get<Vector<double, 2>>(p).norm() / free);
      });
    }
    record.expect_near("largest change of velocity over that at an edge, " + shape, largest, 0.0, 1e-11);
  }
}

// Maximum error of the first step's stress, relative to the stress, in a linear velocity field.
double linear_field_error(const std::string& shape, const std::string& transfer, double shift) {
  Simulation<2> simulation(patch_case(shape, transfer));
  shift_body(simulation, shift);
  auto& particles = simulation.particles();
  Matrix<double, 2> gradient;
  gradient << 0.3, -0.2, 0.5, -0.1;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vector<double, 2> velocity = gradient * particles.position.template get<Vector<double, 2>>(p);
    particles.velocity.set(p, velocity);
    if (transfer == "apic") {
      for (int c = 0; c < 4; ++c) {
        particles.affine_velocity(p, c) = gradient(c % 2, c / 2);
      }
    }
  }
  const double dt = 1e-8;  // so short that strain equals gradient times time to round-off
  simulation.step(dt);
  const auto elastic = physics::Elastic::from_young_poisson(5e8, 0.2);
  SymmetricTensor<double> strain = SymmetricTensor<double>::Zero();
  strain[0] = dt * gradient(0, 0);
  strain[1] = dt * gradient(1, 1);
  strain[3] = 0.5 * dt * (gradient(0, 1) + gradient(1, 0));
  const SymmetricTensor<double> stress = physics::stress_increment(elastic, strain);
  double largest = 0.0;
  for_inner_particles(simulation, [&](std::size_t p) {
    const auto found = mpm::full_tensor<2>(particles.stress, p);
    largest = std::max(largest, (found - stress).cwiseAbs().maxCoeff() / stress.cwiseAbs().maxCoeff());
  });
  return largest;
}

TEST(Patch, LinearVelocityStrainsUniformly) {
  Record record("Patch test: linear velocity",
                "The same body in a motion v = A x; one step must strain all of its interior equally.",
                "strain = sym(A) dt", "kinematics");
  for (const std::string& shape : shapes) {
    record.expect_near("error of the stress over it, FLIP, " + shape + ", particles as seeded",
                       linear_field_error(shape, "flip", 0.0), 0.0, 1e-7);
  }
  for (const std::string& shape : shapes) {
    double largest = 0.0;
    for (const double shift : shifts) {
      largest = std::max(largest, linear_field_error(shape, "apic", shift));
    }
    record.expect_near("the same, APIC, " + shape + ", cut anywhere", largest, 0.0, 1e-7);
  }
  record.explain(
      "FLIP carries velocities, not their gradients, to the nodes: it reproduces a linear field if the particles are "
      "distributed evenly about the nodes, as at the start. APIC does so everywhere.");
}

const std::vector<int> cells{8, 16, 32};
const std::vector<double> sizes{1.0 / 8, 1.0 / 16, 1.0 / 32};

TEST(Vibration, ManufacturedWithSmallDisplacements) {
  Record record("Momentum, manufactured, small displacements", problem + "A = 1e-4: no particle leaves its cell.",
                solution, source);
  for (const Choice& choice : {ugimp_flip, ugimp_apic, quadratic_flip, quadratic_apic}) {
    record.expect_order("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                        errors_of(choice, 1e-4, cells), 2.0, 0.15);
  }
  record.explain(
      "All are of order 2. The spline changes to linear shape functions at the rollers; with a node held at 0 beyond "
      "them, the order was 1.");
}

TEST(Vibration, ManufacturedWithLargeDisplacements) {
  Record record("Momentum, manufactured, large displacements",
                problem + "A = 0.02: stretches from 0.87 to 1.13, and particles cross cells.", solution, source);
  for (const Choice& choice : {ugimp_flip, ugimp_apic}) {
    record.expect_order("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                        errors_of(choice, 0.02, cells), 1.0, 0.5);
  }
  for (const Choice& choice : {quadratic_flip, quadratic_apic}) {
    record.expect_order_at_least("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                                 errors_of(choice, 0.02, cells), 1.0, 0.0);
  }
  record.explain(
      "uGIMP's undeformed squares overlap or leave gaps in proportion to the stretch: order 1. Splines are of order 2 "
      "until the particles' uneven spacing, an error of quadrature in first order (Steffen et al. 2010), dominates. "
      "The next refinement, which ./test --full runs, is nearer to 1.");
}

}  // namespace
}  // namespace thawslide::verification
