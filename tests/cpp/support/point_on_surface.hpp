// Point mass sliding with Coulomb friction on a surface z = f(x, y) under gravity g, for comparison with small blocks
// on DEMs. With W = sqrt(1 + f_x^2 + f_y^2), the unit normal n = (-f_x, -f_y, 1)/W and the velocity v = (u, w, f_x u +
// f_y w), the constraint z = f(x, y) differentiated twice gives the normal acceleration, which is the second
// fundamental form of the velocity,
//    a.n = II(v, v) = (f_xx u^2 + 2 f_xy u w + f_yy w^2)/W
// Newton's law a = -g e_z + N n - mu N v/|v| therefore has the normal force per mass N = II(v, v) + g/W. (do Carmo
// 1976, Differential geometry of curves and surfaces, Section 3.3)
#pragma once

#include <functional>
#include <stdexcept>

#include "base/linear.hpp"

namespace thawslide::testing_support {

class PointOnSurface {
 public:
  using Place = Vector<double, 2>;
  using Height = std::function<double(double x, double y)>;

  // Starts at rest at a position [m] on a surface of given height [m]; friction coefficient, gravity [m/s2].
  PointOnSurface(Height height, const Place& start, double friction, double gravity)
      : height_(std::move(height)), friction_(friction), gravity_(gravity) {
    state_ << start, 0.0, 0.0;
  }

  [[nodiscard]] Place place() const { return state_.head<2>(); }
  // [m/s], in 3D.
  [[nodiscard]] Vector<double, 3> velocity() const {
    const Place flat = state_.tail<2>();
    return {flat[0], flat[1], slopes(place()).first.dot(flat)};
  }

  // Advances by dt [s] with the classical Runge-Kutta method.
  void step(double dt) {
    const State k1 = rate(state_);
    const State k2 = rate(state_ + 0.5 * dt * k1);
    const State k3 = rate(state_ + 0.5 * dt * k2);
    const State k4 = rate(state_ + dt * k3);
    state_ += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }

 private:
  using State = Vector<double, 4>;  // x, y, u, w
  struct Slopes {
    Place first;
    Matrix<double, 2> second;
  };

  // Central differences.
  [[nodiscard]] Slopes slopes(const Place& place) const {
    constexpr double h = 0.01;  // m
    const auto at = [&](int i, int j) { return height_(place[0] + i * h, place[1] + j * h); };
    const double mixed = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4.0 * h * h);
    Slopes slopes;
    slopes.first << (at(1, 0) - at(-1, 0)) / (2.0 * h), (at(0, 1) - at(0, -1)) / (2.0 * h);
    slopes.second << (at(1, 0) - 2.0 * at(0, 0) + at(-1, 0)) / (h * h), mixed, mixed,
        (at(0, 1) - 2.0 * at(0, 0) + at(0, -1)) / (h * h);
    return slopes;
  }

  [[nodiscard]] State rate(const State& state) const {
    const Place flat = state.tail<2>();
    const Slopes f = slopes(state.head<2>());
    const double w = std::sqrt(1.0 + f.first.squaredNorm());
    const Vector<double, 3> normal = Vector<double, 3>(-f.first[0], -f.first[1], 1.0) / w;
    const Vector<double, 3> velocity(flat[0], flat[1], f.first.dot(flat));
    const Vector<double, 3> weight(0.0, 0.0, -gravity_);
    const double pressing = flat.dot(f.second * flat) / w + gravity_ / w;
    if (pressing < 0.0) {
      throw std::logic_error("the point leaves the surface");
    }
    // Friction opposes the motion or, at rest, the weight.
    const Vector<double, 3> driven = velocity.norm() > 0.0 ? velocity : weight - weight.dot(normal) * normal;
    const Vector<double, 3> acceleration = weight + pressing * (normal - friction_ * driven.normalized());
    State rate;
    rate << flat, acceleration.head<2>();
    return rate;
  }

  Height height_;
  double friction_, gravity_;
  State state_;
};

}  // namespace thawslide::testing_support
