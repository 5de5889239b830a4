// A particle to be, at t = 0.
#pragma once

#include <vector>

#include "base/linear.hpp"

namespace thawslide::sim {

template <int Dim>
struct Seed {
  int body;
  Vector<double, Dim> place;  // absolute [m]
  double depth;               // vertical, below the body's top [m]
  double volume;              // [m3], per metre of width in 2D
};

}  // namespace thawslide::sim
