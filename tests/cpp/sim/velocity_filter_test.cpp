// The filter of velocities (FMPM): conserved components, damped components, and filter times.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "../support/base_cases.hpp"
#include "../support/fields.hpp"
#include "../support/record.hpp"
#include "base/parallel.hpp"
#include "mpm/motion.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// Particles, by id.
template <int Dim>
struct Point {
  Vector<double, Dim> position;
  double mass, half;  // half: size, in cells
};
template <int Dim>
std::vector<Point<Dim>> points_of(const Simulation<Dim>& simulation) {
  const auto& particles = simulation.particles();
  std::vector<Point<Dim>> points(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    points[static_cast<std::size_t>(particles.id(p))] = {
        particles.position.template get<Vector<double, Dim>>(p), particles.mass(p),
        simulation.model().motion.sizes.half(static_cast<std::size_t>(particles.body(p)))};
  }
  return points;
}

// Calls visit(node, weight) for the nodes of a particle, with the weights of uGIMP.
template <int Dim, class Visit>
void for_nodes(const Point<Dim>& p, double inverse_cell, const Visit& visit) {
  for (int n = 0, count = mpm::power(3, Dim); n < count; ++n) {
    std::array<int, Dim> node;
    double product = 1.0;
    for (int a = 0, rest = n; a < Dim; ++a, rest /= 3) {
      const double in_cells = p.position[a] * inverse_cell, nearest = std::floor(in_cells + 0.5);
      node[static_cast<std::size_t>(a)] = static_cast<int>(nearest) - 1 + rest % 3;
      product *= mpm::ugimp_weights(in_cells - nearest, p.half, inverse_cell).weight[rest % 3];
    }
    visit(node, product);
  }
}

// A free block with displaced particles, oblique to the grid. Velocities are filtered in its first step.
template <int Dim>
Variant unfiltered() {
  const Sets space =
      "case.dimension=3; grid.min=[0,0,0]; grid.max=[40,40,40]; body.block.min=[17.3,17.5,17.6]; "
      "body.block.max=[20.3,20.5,19.6]";
  return Variant{"free", "material.rock.youngs_modulus=1e7; body.block.max=[20.3,19.6]; initial.noise=0.4"} +
         (Dim == 3 ? space : Sets());
}
template <int Dim>
Variant block() {
  return unfiltered<Dim>() + "mechanics.transfer=fmpm; mechanics.fmpm_interval=0.002";
}

// Velocities of all particles by id, in rows.
using Velocities = Eigen::VectorXd;
template <int Dim>
Velocities velocities_of(const Simulation<Dim>& simulation) {
  const auto& particles = simulation.particles();
  Velocities all(static_cast<Eigen::Index>(Dim * particles.size()));
  for (std::size_t p = 0; p < particles.size(); ++p) {
    all.segment<Dim>(static_cast<Eigen::Index>(Dim * particles.id(p))) =
        particles.velocity.template get<Vector<double, Dim>>(p);
  }
  return all;
}
template <int Dim>
void set_velocities(Simulation<Dim>& simulation, const Velocities& all) {
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.velocity.set(p, Vector<double, Dim>(all.segment<Dim>(static_cast<Eigen::Index>(Dim * particles.id(p)))));
  }
}

Velocities random_velocities(Eigen::Index count) {
  std::mt19937 random(11);
  std::normal_distribution<double> number;
  Velocities all(count);
  for (double& one : all) {
    one = number(random);
  }
  return all;
}

// Components of the sweeps as matrices: per node, the local least squares of a rigid motion, weighted by S m.
template <int Dim>
struct Dense {
  Eigen::MatrixXd transfer;  // B
  Velocities mass;           // of each component
  Eigen::MatrixXd rigid;     // all rigid motions, a column each

  explicit Dense(const std::vector<Point<Dim>>& points) {
    const auto count = static_cast<Eigen::Index>(Dim * points.size());
    constexpr int turns = physics::rotations<Dim>, motions = Dim + turns;
    rigid = Eigen::MatrixXd::Zero(count, motions);
    mass = Velocities::Zero(count);
    std::map<std::array<int, Dim>, Eigen::VectorXd> shape;  // by node, of each particle
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto first = static_cast<Eigen::Index>(Dim * p);
      const Vector<double, Dim> from_middle = points[p].position - Vector<double, Dim>::Constant(18.5);
      for (int a = 0; a < Dim; ++a) {
        rigid(first + a, a) = 1.0;
        mass[first + a] = points[p].mass;
      }
      for (int a = 0; a < turns; ++a) {
        const Vector<double, turns> unit = Vector<double, turns>::Unit(a);
        rigid.block<Dim, 1>(first, Dim + a) = physics::turned<Dim>(unit, from_middle);
      }
      for_nodes(points[p], 1.0, [&](const auto& node, double weight) {
        auto& of_node = shape[node];
        of_node.conservativeResizeLike(Velocities::Zero(count));
        for (int a = 0; a < Dim; ++a) {
          of_node[first + a] = weight;
        }
      });
    }
    transfer = Eigen::MatrixXd::Zero(count, count);
    for (const auto& [node, weight] : shape) {
      if (weight.maxCoeff() <= 0.0) {
        continue;
      }
      const Eigen::MatrixXd weighed = weight.cwiseProduct(mass).asDiagonal() * rigid;
      const Eigen::MatrixXd normal = rigid.transpose() * weighed;
      transfer += weight.asDiagonal() * rigid *
                  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(normal).solve(weighed.transpose());
    }
  }
};

template <int Dim>
void expect_the_filter_of_matrices(int order) {
  SCOPED_TRACE(order);
  Simulation<Dim> simulation(paper_case(block<Dim>(), {fmt::format("mechanics.fmpm_order={}", order)}));
  const Dense<Dim> dense(points_of(simulation));
  const Velocities before = random_velocities(dense.mass.size());
  set_velocities(simulation, before);
  const auto start = history_row(simulation);
  simulation.step(0.002);
  const Velocities after = velocities_of(simulation);
  Velocities rest = before;
  for (int k = 0; k < order; ++k) {
    rest -= dense.transfer * rest;
  }
  EXPECT_LT((after - (before - rest)).cwiseAbs().maxCoeff(), 1e-11);
  // Momentum and angular momentum, expressed by the rigid motions; energy.
  const Eigen::VectorXd momenta = dense.rigid.transpose() * dense.mass.cwiseProduct(before);
  const Eigen::VectorXd change = dense.rigid.transpose() * dense.mass.cwiseProduct(after - before);
  EXPECT_LT(change.cwiseAbs().maxCoeff(), 1e-12 * dense.mass.sum());
  EXPECT_GT(momenta.cwiseAbs().minCoeff(), 1e-6 * dense.mass.sum()) << "the noise has some of each";
  const double lost = 0.5 * dense.mass.dot(before.cwiseAbs2() - after.cwiseAbs2());
  EXPECT_GT(lost, 0.2 * value_of(start, "kinetic_J"));
  EXPECT_NEAR(value_of(history_row(simulation), "numerical_J"), -lost, 1e-12 * lost) << "and is booked";
}

TEST(VelocityFilter, IsEqualToItsMatrixForm) {
  for (const int order : {2, 3, 4}) {
    expect_the_filter_of_matrices<2>(order);
    expect_the_filter_of_matrices<3>(order);
  }
}

// A spin passes unchanged with all shape functions; PIC would damp it.
TEST(VelocityFilter, PreservesASpin) {
  for (const char* shape : {"ugimp", "quadratic"}) {
    SCOPED_TRACE(shape);
    Simulation<2> simulation(paper_case(block<2>(), {std::string("mechanics.shape_function=") + shape}));
    const Dense<2> dense(points_of(simulation));
    const Velocities spin = dense.rigid * Eigen::Vector3d(3.0, -1.0, 2.0);
    set_velocities(simulation, spin);
    simulation.step(0.002);
    EXPECT_LT((velocities_of(simulation) - spin).cwiseAbs().maxCoeff(), 1e-11);
  }
}

// Between filters it is bitwise identical to FLIP; fixed and adaptive steps reach each multiple of the interval once.
TEST(VelocityFilter, ActsOncePerInterval) {
  for (const std::string stepping : {"fixed", "adaptive"}) {
    SCOPED_TRACE(stepping);
    const Sets sets = "mechanics.fmpm_interval=0.02; time.stepping=" + stepping;
    Simulation<2> filtered(paper_case(block<2>(), sets));
    Simulation<2> flip(paper_case(unfiltered<2>(), {"time.stepping=" + stepping}));
    set_velocities(filtered, random_velocities(velocities_of(filtered).size()));
    int times = 0;
    while (filtered.time() < 0.201) {
      const double before = filtered.time(), dt = filtered.next_step(1.0);
      for (std::size_t f = 0; f < flip.particles().fields.all().size(); ++f) {
        flip.particles().fields.all()[f]->set_bytes(filtered.particles().fields.all()[f]->bytes());
      }
      filtered.step(dt);
      flip.step(dt);
      const bool acts = fields_by_id(filtered.particles()) != fields_by_id(flip.particles());
      EXPECT_EQ(acts, std::floor(filtered.time() / 0.02 + 1e-9) > std::floor(before / 0.02 + 1e-9)) << before;
      times += acts ? 1 : 0;
    }
    EXPECT_EQ(times, 10);
  }
}

// A bar free at both ends, in its first mode: node velocities u cos(k x_i), four cells per half wave. For uGIMP with
// two particles per cell and axis, a quarter of a cell from nodes, the sums over particles transform such a mode by
//   S+ S cos(k x_i) = l cos(k x_i),  l = 5/8 + 3/8 cos(k h)
// A filter of order m therefore leaves the fraction f = 1 - (1 - l)^m of a velocity that the grid has given. Between
// filters the phase of the mode advances by a = w tau. Displacement (times w) and velocity follow from those of the
// previous interval by the matrix (cos a, sin a; -f sin a, f cos a). By its characteristic equation
//   v_n+1 = (1 + f) cos(a) v_n - f v_n-1
// the amplitude decreases by sqrt(f) per interval. FLIP has f = 1.
// Its frequency is w = (2 c/h) sin(k h/2) sqrt(l): strains follow from velocities mapped back, forces act on lumped
// masses.
constexpr int bar_cells = 4, interval_in_steps = 43;
const double bar_step = 0.03 / bar_cells / std::sqrt(1e7 / ((1.0 - 1e-6) * 2750.0 + 1e-6 * 917.0));
const Variant bar{"free",
                  "time.end=10; grid.boundary.y_min=roller; grid.boundary.y_max=roller; "
                  "material.rock.youngs_modulus=1e7; material.rock.poisson_ratio=0; body.block.min=[1,0]; "
                  "body.block.porosity=1e-6; " +
                      fmt::format("time.step={}; grid.cell={}; grid.max=[3.0, {}]; body.block.max=[2.0, {}]", bar_step,
                                  1.0 / bar_cells, 2.0 / bar_cells, 2.0 / bar_cells)};

// Determinant and trace of the matrix that advances the mode's velocity over an interval, by least squares.
struct Swing {
  double determinant, trace;
};
Swing swing(const Sets& sets) {
  Simulation<2> simulation(paper_case(bar, sets));
  const auto points = points_of(simulation);
  Velocities form = Velocities::Zero(2 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    for_nodes(points[p], bar_cells, [&](const auto& node, double weight) {
      form[static_cast<Eigen::Index>(2 * p)] += weight * std::cos(pi * (node[0] - bar_cells) / bar_cells);
    });
  }
  set_velocities(simulation, Velocities(1e-3 * form));
  std::vector<double> velocity;
  const ThreadScope alone(1);  // for so short a bar, starting other threads takes longer than a step
  for (int k = 1; k <= 40 * interval_in_steps; ++k) {
    simulation.step(bar_step);
    if (k % interval_in_steps == 0) {
      velocity.push_back(form.dot(velocities_of(simulation)) / form.squaredNorm() / 1e-3);
    }
  }
  const auto count = static_cast<Eigen::Index>(velocity.size()) - 2;
  const Eigen::Map<const Velocities> all(velocity.data(), count + 2);
  Eigen::MatrixXd before(count, 2);
  before << all.segment(1, count), -all.head(count);
  const Eigen::Vector2d found = before.colPivHouseholderQr().solve(all.tail(count));
  return {found[1], found[0]};
}

TEST(VelocityFilter, DampsAWaveByItsEigenvalue) {
  verification::Record record(
      "A bar whose velocities are filtered",
      "The first mode of an elastic bar free at both ends, four cells long. Its velocities are filtered 6 times a "
      "period "
      "(mechanics.transfer = \"fmpm\"). The matrix that takes it over an interval is fitted to 40 intervals.",
      "determinant f = 1 - (1 - l)^m with l = 5/8 + 3/8 cos(k h); trace (1 + f) cos(a), a of FLIP",
      "eigenvalue of the sums over particles; Hammerquist and Nairn 2017 for the filter");
  const Swing flip = swing({});
  record.expect_near("determinant, FLIP", flip.determinant, 1.0, 2e-5);
  const double cosine = 0.5 * flip.trace, eigenvalue = 0.625 + 0.375 * std::cos(pi / bar_cells);
  const double swung = 0.06 * std::sin(0.5 * pi / bar_cells) * std::sqrt(eigenvalue) * interval_in_steps;
  record.expect_near("frequency over that of the lumped masses, FLIP", std::acos(cosine) / swung, 1.0, 1e-3);
  for (const int order : {2, 3, 4}) {
    const Swing found = swing({"mechanics.transfer=fmpm", fmt::format("mechanics.fmpm_order={}", order),
                               fmt::format("mechanics.fmpm_interval={:.17g}", interval_in_steps * bar_step)});
    const double fraction = 1.0 - std::pow(1.0 - eigenvalue, order);
    record.expect_near(fmt::format("what an interval takes of the determinant over exact, order {}", order),
                       (1.0 - found.determinant) / (1.0 - fraction), 1.0, 1e-3);
    record.expect_near(fmt::format("trace over exact, order {}", order), found.trace / ((1.0 + fraction) * cosine), 1.0,
                       1e-3);
  }
}

}  // namespace
}  // namespace thawslide::sim
