// Ground at a node, computed once. The cells follow the ground: its nodes are those of layer 0.
#pragma once

#include "base/linear.hpp"

namespace thawslide::terrain {

template <int Dim>
struct GroundAtNode {
  bool candidate = false;      // the node is on the ground or below it: particles that have sunk in reach it
  int substrate = 0;           // below the node (substrates.hpp)
  Vector<double, Dim> normal;  // unit vector from the sliding mass into the ground
  double area = 0;             // of the ground over the node's hat function [m2]; 0 except in layer 0
  double bend = 1;             // chi: 1 on a plane, larger where the ground bends within reach of the node
  double plane = 0;            // of the node, x.n = c.n, times plane_scale [m]; infinite unless the node is a candidate
  double plane_scale = 0;      // factor of both sides: 0 on planes, where the height above the ground is the clearance
  double elevation = 0;        // of the node [m]
};

}  // namespace thawslide::terrain
