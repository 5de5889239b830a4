#include "physics/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace thawslide::physics {
namespace {

constexpr double least_square = 1e-8;

template <int Dim>
struct Point {
  double mass;
  Vector<double, Dim> position, velocity;
};

template <int Dim>
MassPoints<Dim> sums_of(const std::vector<Point<Dim>>& points) {
  MassPoints<Dim> sums{};
  sums.first.setZero();
  sums.second.setZero();
  sums.momentum.setZero();
  sums.moment.setZero();
  for (const auto& point : points) {
    sums.mass += point.mass;
    sums.first += point.mass * point.position;
    sums.second += point.mass * squares_of<Dim>(point.position);
    sums.momentum += point.mass * point.velocity;
    sums.moment += point.mass * moment_of<Dim>(point.position, point.velocity);
  }
  return sums;
}

template <int Dim>
Vector<double, Dim> at(const RigidMotion<Dim>& motion, const Vector<double, Dim>& position) {
  return motion.at_origin + turned<Dim>(motion.rotation, position);
}

template <int Dim>
std::vector<Point<Dim>> random_points(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<Point<Dim>> points(static_cast<std::size_t>(count));
  for (auto& point : points) {
    point.mass = 1.5 + number(random);
    for (int a = 0; a < Dim; ++a) {
      point.position[a] = 5.0 + number(random);
      point.velocity[a] = number(random);
    }
  }
  return points;
}

// It has the momentum and angular momentum of the points, and any other rigid motion is farther from them.
template <int Dim>
void expect_the_nearest() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-0.1, 0.1);
  for (int k = 0; k < 200; ++k) {
    const auto points = random_points<Dim>(7, random);
    const MassPoints<Dim> sums = sums_of(points);
    const RigidMotion<Dim> motion = nearest_rigid_motion(sums, least_square);
    const auto distance = [&](const RigidMotion<Dim>& other) {
      double sum = 0.0;
      for (const auto& point : points) {
        sum += point.mass * (point.velocity - at(other, point.position)).squaredNorm();
      }
      return sum;
    };
    auto rigid = points;
    for (auto& point : rigid) {
      point.velocity = at(motion, point.position);
    }
    EXPECT_LT((sums_of(rigid).momentum - sums.momentum).norm(), 1e-12);
    EXPECT_LT((sums_of(rigid).moment - sums.moment).norm(), 1e-11);
    const RigidMotion<Dim> again = nearest_rigid_motion(sums_of(rigid), least_square);
    EXPECT_LT((again.rotation - motion.rotation).norm(), 1e-11);
    RigidMotion<Dim> other = motion;
    for (int a = 0; a < rotations<Dim>; ++a) {
      other.rotation[a] += number(random);
    }
    EXPECT_GT(distance(other), distance(motion));
  }
}
TEST(RigidMotion, IsTheNearestInThePlane) { expect_the_nearest<2>(); }
TEST(RigidMotion, IsTheNearestInSpace) { expect_the_nearest<3>(); }

// One point has no rotation, and a line of points has no rotation about itself.
TEST(RigidMotion, DoesNotTurnAboutAnAxisWithoutInertia) {
  const Vector<double, 2> position(3.0, 4.0), velocity(1.0, -2.0);
  const auto of_one = nearest_rigid_motion(sums_of<2>({{2.0, position, velocity}}), least_square);
  EXPECT_EQ(of_one.rotation[0], 0.0);
  EXPECT_LT((at(of_one, position) - velocity).norm(), 1e-14);
  const Vector<double, 3> along = Vector<double, 3>(1.0, 2.0, 2.0) / 3.0, turn(0.3, -0.2, 0.1);
  std::vector<Point<3>> line;
  for (const double s : {0.0, 0.5, 2.0}) {
    const Vector<double, 3> on_line = s * along;
    line.push_back({1.0, on_line, turned<3>(turn, on_line)});
  }
  const auto motion = nearest_rigid_motion(sums_of<3>(line), least_square);
  EXPECT_NEAR(motion.rotation.dot(along), 0.0, 1e-12);
  for (const auto& point : line) {
    EXPECT_LT((at(motion, point.position) - point.velocity).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace thawslide::physics
