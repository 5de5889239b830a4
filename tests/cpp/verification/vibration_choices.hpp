// Shape functions and transfers of the manufactured vibration.
#pragma once

#include <string>
#include <vector>

#include "manufactured_vibration.hpp"

namespace thawslide::verification {

struct Choice {
  std::string name;
  mpm::ShapeFunction shape;
  mpm::TransferKind transfer;
};
const Choice ugimp_flip{"uGIMP, FLIP", mpm::ShapeFunction::ugimp, mpm::TransferKind::flip_pic};
const Choice ugimp_apic{"uGIMP, APIC", mpm::ShapeFunction::ugimp, mpm::TransferKind::apic};
const Choice quadratic_flip{"quadratic, FLIP", mpm::ShapeFunction::quadratic, mpm::TransferKind::flip_pic};
const Choice quadratic_apic{"quadratic, APIC", mpm::ShapeFunction::quadratic, mpm::TransferKind::apic};

// Errors of the maximum displacements, at a quarter of the period, where u = A; relative to A. They contain dt (v(0) -
// v)/2 from Eq. 14, and the step is therefore reduced with the square of the cell.
inline std::vector<double> errors_of(const Choice& choice, double amplitude, const std::vector<int>& cells_per_side) {
  std::vector<double> errors;
  for (const int cells : cells_per_side) {
    sim::ManufacturedVibration square(cells, amplitude, choice.shape, choice.transfer, 0.0);
    square.run(sim::ManufacturedVibration::period() / 4.0, 0.8 / cells * square.wave_step());
    errors.push_back(square.error() / amplitude);
  }
  return errors;
}

const std::string problem = "A unit square between rollers vibrates along its axes, 4 particles per cell, ";
const std::string solution = "u1 = A sin(2 pi X) sin(c pi t), u2 = -A sin(2 pi Y) sin(c pi t), body force to match";
const std::string source = "Wallstedt and Guilkey 2008, for log-strain elasticity";

}  // namespace thawslide::verification
