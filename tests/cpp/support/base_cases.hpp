// Named base cases of tests. A test changes a few keys of one of them:
//   base_case("block", "time.end=2; body.block.velocity=[2,0]")
//
//   block       elastic block on flat ground in 2D; only Coulomb friction acts, without heat and pore pressure
//   free        elastic block without gravity, ground, initial stress, heat and pore pressure, in 2D
//   slab        elastic slab on flat ground in 2D, with a shear band, heat and pore pressure
//   columns     elastic slab on a frictional incline in 2D, with band columns
//   bar         bar that conducts heat; no gravity, motion or pore pressure
//   column      thawed soil column in which heat is conducted and water seeps; no motion
//   sand        column of dry sand on flat ground next to a smooth wall (see the comment in base_cases.cpp)
//   release     release on a DEM in 3D (files dem.tif, thickness.tif); only Coulomb friction acts
//   profile     elastic slide on a profile in 2D (file profile.csv); only Coulomb friction acts
//   two_bodies  frozen body behind a melted body on a slope in 2D, with every mechanism and different particles
//   box         small 3D slide: box of warm ice on an incline
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "case_from_text.hpp"

namespace thawslide::testing_support {

// Texts of `--set`: KEY=VALUE, or several of them separated by semicolons. Bodies, materials and frames can be added if
// all keys that they need are given; KEY= without a value removes a key of the base case and of earlier sets. Paths are
// relative to the working directory, unlike those of the base cases.
class Sets : public std::vector<std::string> {
 public:
  Sets() = default;
  Sets(const char* text) : Sets(std::string(text)) {}
  Sets(const std::string& text);
  Sets(std::initializer_list<std::string> texts);
  Sets(const std::vector<std::string>& texts);

  // A later value of the same key replaces an earlier one.
  friend Sets operator+(Sets first, const Sets& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
  }
};

// TOML text of a base case.
const std::string& base_text(const std::string& name);

// Case that differs from a base case in some keys.
struct Variant {
  std::string base;
  Sets sets;

  friend Variant operator+(const Variant& variant, const Sets& more) { return {variant.base, variant.sets + more}; }
};

// Case with the present defaults, and with the published formulation for each key that is not given (paper_case()).
config::Case case_from_text(const Variant& variant, const Sets& sets = {});
config::Case paper_case(const Variant& variant, const Sets& sets = {});
inline config::Case base_case(const std::string& name, const Sets& sets = {}) {
  return case_from_text(Variant{name, sets});
}
inline config::Case published_case(const std::string& name, const Sets& sets = {}) {
  return paper_case(Variant{name, sets});
}

// Small 3D slide: a box of 6 x 4 x 3 m of warm ice on a plane of 25 degrees that falls towards +x, on a grid of 1 m.
inline config::Case slide_in_space(const Sets& sets = {}) { return published_case("box", sets); }

// Place of a case in 2D or 3D, as TOML: x along the slope, y across it, z upwards [m].
template <int Dim>
std::string place_in(double x, double y, double z) {
  return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, y, z);
}

}  // namespace thawslide::testing_support
