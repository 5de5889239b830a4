#include "physics/mohr_coulomb.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "../support/record.hpp"
#include "physics/tension_gap.hpp"
#include "stress_return.hpp"

namespace thawslide::physics {
namespace {

using Tensor = SymmetricTensor<double>;
const Elastic elastic = Elastic::from_young_poisson(5e8, 0.2);
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Set {
  double friction, dilation, cohesion, cutoff;
};
const Set sets[] = {{35, 0, 1e6, infinity}, {35, 35, 1e6, infinity}, {30, 10, 2e5, 5e4}, {35, 35, 1e6, 3e5},
                    {0, 0, 1e5, infinity},  {40, 5, 0.0, infinity},  {20, 20, 1e5, 0.0}};

MohrCoulomb<> law_of(const Set& set) {
  return MohrCoulomb<>::make(elastic, {set.friction, set.dilation, set.cohesion, set.cohesion, set.cutoff});
}

// F of Eq. 11 or the excess over the cut-off, whichever is larger; from sines and cosines as in the paper.
double excess(const Set& set, const Tensor& stress) {
  const auto values = principal(stress).values;
  const double phi = set.friction * pi / 180.0;
  const double shear =
      0.5 * (values[0] - values[2]) + 0.5 * (values[0] + values[2]) * std::sin(phi) - set.cohesion * std::cos(phi);
  return std::max(shear, values[0] - set.cutoff);
}

Tensor random_stress(std::mt19937& random, bool plane) {
  std::normal_distribution<double> normal(0.0, 2e6);
  Tensor stress;
  for (int k = 0; k < 6; ++k) {
    stress[k] = normal(random) - (k < 3 ? 1e6 : 0.0);
  }
  if (plane) {
    stress[4] = stress[5] = 0.0;
  }
  return stress;
}

double size(const Tensor& stress) { return stress.cwiseAbs().maxCoeff(); }

// Returns the principal state.
auto expect_rebuilt(const Tensor& stress, double allowed) {
  const auto state = principal(stress);
  EXPECT_LE((from_principal(state) - stress).cwiseAbs().maxCoeff(), allowed * size(stress));
  EXPECT_LT((state.axes.transpose() * state.axes - Matrix<double, 3>::Identity()).norm(), 1e-13);
  return state;
}

TEST(Principal, RebuildsTheTensor) {
  std::mt19937 random(1);
  for (int k = 0; k < 2000; ++k) {
    const auto state = expect_rebuilt(random_stress(random, k % 2 == 0), 1e-13);
    EXPECT_GE(state.values[0], state.values[1]);
    EXPECT_GE(state.values[1], state.values[2]);
  }
}

// At the apex, for example: the values differ by round-off only, and the deviator may have a trace.
TEST(Principal, RebuildsTensorsThatAreIsotropicToRoundOff) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-3e6, 3e6);
  std::uniform_int_distribution<int> last_digits(-2, 2);
  for (int k = 0; k < 20000; ++k) {
    const double pressure = number(random), digit = std::abs(pressure) * std::numeric_limits<double>::epsilon();
    Tensor stress;
    for (int c = 0; c < 6; ++c) {
      stress[c] = (c < 3 ? pressure : 0.0) + (c < 3 || k % 2 == 0 ? digit * last_digits(random) : 0.0);
    }
    expect_rebuilt(stress, 1e-14);
  }
  for (int k = 0; k < 1000; ++k) {  // the products vanish for some of these
    const double size = number(random);
    const Vector<double, 3> axis =
        detail::isolated_axis(Matrix<double, 3>(Vector<double, 3>(size, size, 0.0).asDiagonal()));
    EXPECT_NEAR(axis.norm(), 1.0, 1e-13) << size;
  }
}

// Plane stresses in 2D; faces, edges, apex and cut-off in one batch of the CPU.
template <int Dim>
void expect_admissible_returns(const Set& set, Executor executor) {
  const auto law = law_of(set);
  std::mt19937 random(5);
  std::vector<Tensor> trials(10000);
  for (std::size_t k = 0; k < trials.size(); ++k) {
    trials[k] = (k % 3 == 0 ? 0.1 : 1.0) * random_stress(random, Dim == 2);
  }
  const auto results = returned_by<Dim>(executor, law, trials);
  int yielded = 0;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const Tensor& trial = trials[k];
    const auto& result = results[k];
    const double scale = size(trial) + set.cohesion;
    if (!result.yielded) {
      EXPECT_EQ(result.stress, trial);
      EXPECT_LE(excess(set, trial), 1e-9 * scale);
      continue;
    }
    ++yielded;
    EXPECT_GT(excess(set, trial), 0.0);
    EXPECT_TRUE(law.template may_yield<Dim>(trial, 0.0));
    EXPECT_NEAR(excess(set, result.stress), 0.0, 1e-9 * scale) << "friction " << set.friction << " k " << k;
    EXPECT_GE(result.plastic_work_density, -1e-9 * scale * scale / 5e8);
    const auto again = law.update(result.stress, 0.0);
    EXPECT_LT((again.stress - result.stress).cwiseAbs().maxCoeff(), 1e-8 * scale);
  }
  EXPECT_GT(yielded, 500);
}
TEST(MohrCoulomb, ReturnsAreAdmissibleOnTheSurfaceAndIdempotent) {
  for (const Set& set : sets) {
    for (const Executor executor : {Executor::device, Executor::cpu}) {
      expect_admissible_returns<2>(set, executor);
      expect_admissible_returns<3>(set, executor);
    }
  }
}

// Every stress that solves the return, found by trying all sets of up to three active conditions, over all orders of
// the principal stresses: trial - s = D sum lambda_c m_c, lambda_c >= 0, no condition violated, active conditions
// satisfied with equality. For associated flow that is the closest admissible stress in the energy norm (one solution);
// without association it is a complementarity problem. This search uses neither faces nor edges.
std::vector<Vector<double, 3>> solutions_of_return(const Set& set, const Vector<double, 3>& trial) {
  const auto ratio = [](double degrees) {
    const double sine = std::sin(degrees * pi / 180.0);
    return (1 + sine) / (1 - sine);
  };
  const double k = ratio(set.friction), m = ratio(set.dilation);
  std::vector<Vector<double, 3>> normals, flows;
  std::vector<double> limits;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i != j) {
        normals.push_back(k * Vector<double, 3>::Unit(i) - Vector<double, 3>::Unit(j));
        flows.push_back(m * Vector<double, 3>::Unit(i) - Vector<double, 3>::Unit(j));
        limits.push_back(2.0 * set.cohesion * std::sqrt(k));
      }
    }
    if (std::isfinite(set.cutoff)) {
      normals.push_back(Vector<double, 3>::Unit(i));
      flows.push_back(Vector<double, 3>::Unit(i));
      limits.push_back(set.cutoff);
    }
  }
  const Matrix<double, 3> stiffness =
      2.0 * elastic.shear_modulus * Matrix<double, 3>::Identity() + elastic.lame_lambda * Matrix<double, 3>::Ones();
  const double allowed = 1e-9 * (trial.norm() + set.cohesion);
  std::vector<Vector<double, 3>> found;
  for (unsigned active = 1; active < 1u << normals.size(); ++active) {
    std::vector<std::size_t> chosen;
    for (std::size_t c = 0; c < normals.size(); ++c) {
      if ((active >> c & 1u) != 0) {
        chosen.push_back(c);
      }
    }
    if (chosen.size() > 3) {
      continue;
    }
    const auto count = static_cast<Eigen::Index>(chosen.size());
    Eigen::MatrixXd system(count, count);
    Eigen::VectorXd violation(count);
    for (Eigen::Index r = 0; r < count; ++r) {
      const auto& normal = normals[chosen[static_cast<std::size_t>(r)]];
      violation[r] = normal.dot(trial) - limits[chosen[static_cast<std::size_t>(r)]];
      for (Eigen::Index c = 0; c < count; ++c) {
        system(r, c) = normal.dot(stiffness * flows[chosen[static_cast<std::size_t>(c)]]);
      }
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> solver(system);
    if (!solver.isInvertible()) {
      continue;
    }
    const Eigen::VectorXd multipliers = solver.solve(violation);
    Vector<double, 3> stress = trial;
    for (Eigen::Index c = 0; c < count; ++c) {
      stress -= multipliers[c] * (stiffness * flows[chosen[static_cast<std::size_t>(c)]]);
    }
    bool solves = multipliers.minCoeff() >= -1e-12 * multipliers.cwiseAbs().maxCoeff();
    for (std::size_t c = 0; c < normals.size(); ++c) {
      solves = solves && normals[c].dot(stress) - limits[c] <= allowed;
    }
    if (solves) {
      found.push_back(stress);
    }
  }
  return found;
}

TEST(MohrCoulomb, ReturnSolvesTheConstrainedProgramme) {
  verification::Record record(
      "Mohr-Coulomb return mapping",
      "Random trial stresses, returned by faces, edges, apex and cut-off, against all solutions of the return found by "
      "trying every set of active conditions. Seven sets of friction, dilation, cohesion and cut-off, with and without "
      "associated flow.",
      "trial - s = D sum lambda m, lambda >= 0, s admissible", "Clausen et al. 2006; complementarity by enumeration");
  for (const Set& set : sets) {
    const auto law = law_of(set);
    std::mt19937 random(17);
    std::vector<Tensor> trials(300);
    for (std::size_t k = 0; k < trials.size(); ++k) {
      trials[k] = random_stress(random, k % 2 == 0);
    }
    const auto on_device = returned_by<3>(Executor::device, law, trials),
               on_cpu = returned_by<3>(Executor::cpu, law, trials);
    double largest = 0.0;
    int yielded = 0;
    for (std::size_t k = 0; k < 2 * trials.size(); ++k) {
      const auto values = principal(trials[k / 2]).values;
      const auto& result = (k % 2 == 0 ? on_device : on_cpu)[k / 2];
      if (!result.yielded) {
        continue;
      }
      ++yielded;
      const auto returned = principal(result.stress).values;
      const double scale = values.norm() + set.cohesion;
      const auto solutions = solutions_of_return(set, values);
      if (solutions.empty()) {  // flow without dilation cannot lower the mean tension: only the apex remains
        EXPECT_EQ(set.dilation, 0.0);
        EXPECT_NEAR(returned[0], set.cohesion / std::tan(set.friction * pi / 180.0), 1e-9 * scale);
        EXPECT_NEAR(returned[0], returned[2], 1e-9 * scale);
        continue;
      }
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& solution : solutions) {
        nearest = std::min(nearest, (returned - solution).norm() / scale);
      }
      largest = std::max(largest, nearest);
    }
    EXPECT_GT(yielded, 20);
    record.expect_near(
        fmt::format("largest difference over the trial stress; friction {}, dilation {} degrees, cohesion "
                    "{} MPa, cut-off {} MPa",
                    set.friction, set.dilation, set.cohesion / 1e6, set.cutoff / 1e6),
        largest, 0.0, 1e-9);
  }
}

TEST(MohrCoulomb, OpensGapsAtTheApexAndTheCutoffOnly) {
  Tensor tension, shear;
  tension << 9e6, 9e6, 9e6, 0, 0, 0;
  shear << 1e6, -20e6, -3e6, 5e6, 0, 0;
  const double bulk_modulus = 5e8 / (3.0 * (1.0 - 2.0 * 0.2)), apex = 1e6 / std::tan(35.0 * pi / 180.0);
  EXPECT_NEAR(law_of({35, 0, 1e6, infinity}).update(tension, 0.0).opening, (9e6 - apex) / bulk_modulus, 1e-12);
  EXPECT_NEAR(law_of({35, 0, 1e6, 2e5}).update(tension, 0.0).opening, (9e6 - 2e5) / bulk_modulus, 1e-12);
  EXPECT_EQ(law_of({35, 20, 1e6, infinity}).update(shear, 0.0).opening, 0.0) << "dilation opens none";
}

TEST(TensionGap, ClosesBeforeStressIsBorne) {
  EXPECT_EQ(closing_strain(0.3, 0.1), 0.0) << "no closing while it opens further";
  EXPECT_EQ(closing_strain(0.3, -0.1), 0.1);
  EXPECT_EQ(closing_strain(0.3, -0.4), 0.3) << "no more than the gap";
  Tensor strain;
  strain << -0.2, 0.1, 0.0, 0.05, 0.01, 0.02;
  const Tensor borne = borne_strain(strain, 0.1);
  EXPECT_NEAR(borne.head<3>().sum(), 0.0, 1e-15);
  EXPECT_EQ(borne.tail<3>(), strain.tail<3>());
}

TEST(MohrCoulomb, CohesionSoftensWithPlasticStrain) {
  const auto law = MohrCoulomb<>::make(elastic, {35.0, 0.0, 1e6, 1e5, infinity});
  EXPECT_DOUBLE_EQ(law.cohesion(0.0), 1e6);
  EXPECT_NEAR(law.cohesion(1.0), 1e5 + 9e5 * std::exp(-1.0), 1e-6);
  Tensor trial;
  trial << 0, -20e6, 0, 5e6, 0, 0;
  EXPECT_LT(size(law.update(trial, 2.0).stress), size(law.update(trial, 0.0).stress));
}

TEST(MohrCoulomb, PlasticStrainAndWorkAreThoseOfTheStressDrop) {
  const auto law = law_of({35, 0, 1e6, infinity});
  Tensor trial;
  trial << 1e6, -20e6, -3e6, 5e6, 0, 0;
  const auto result = law.update(trial, 0.0);
  // Plastic strain from the stress drop with the compliance in E and nu.
  const Tensor drop = trial - result.stress;
  const double youngs_modulus = 5e8, poisson = 0.2;
  Tensor strain = drop * (1 + poisson) / youngs_modulus;
  for (int k = 0; k < 3; ++k) {
    strain[k] -= poisson / youngs_modulus * (drop[0] + drop[1] + drop[2]);
  }
  const double contraction = strain.head<3>().squaredNorm() + 2.0 * strain.tail<3>().squaredNorm();
  EXPECT_NEAR(result.equivalent_plastic_strain_increment, std::sqrt(2.0 / 3.0 * contraction), 1e-12);
  const double work =
      result.stress.head<3>().dot(strain.head<3>()) + 2.0 * result.stress.tail<3>().dot(strain.tail<3>());
  EXPECT_NEAR(result.plastic_work_density, work, 1e-9 * work);
}

}  // namespace
}  // namespace thawslide::physics
