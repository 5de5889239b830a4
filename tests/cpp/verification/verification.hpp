// Headers and names that all verification tests share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/base_cases.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {

using namespace testing_support;
using sim::Simulation;

inline constexpr double degree = pi / 180.0, gravity = 9.81;  // [rad], [m/s2]

inline void add_point(Curve& curve, double x, double computed, double exact) {
  curve.x.push_back(x);
  curve.computed.push_back(computed);
  curve.exact.push_back(exact);
}

// Mass average of of(p) over the particles p; 0 without particles.
template <class Run, class Of>
double mass_mean(const Run& run, const Of& of) {
  const auto& particles = run.particles();
  double mass = 0.0, sum = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    mass += particles.mass(p);
    sum += particles.mass(p) * of(p);
  }
  return mass > 0.0 ? sum / mass : 0.0;
}

}  // namespace thawslide::verification
