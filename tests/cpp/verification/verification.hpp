// Headers and names that all verification tests share.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
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

// of(size) for each size, such as the error on cells of that size.
template <class Size, class Of>
std::vector<double> each_of(const std::vector<Size>& sizes, const Of& of) {
  std::vector<double> found;
  std::transform(sizes.begin(), sizes.end(), std::back_inserter(found), of);
  return found;
}

// Errors of error_on(cell, curve) on each cell; draws the curve of one of the cells.
template <class ErrorOn>
std::vector<double> errors_with_curve(Record& record, const std::vector<double>& cells, double drawn, Curve curve,
                                      const ErrorOn& error_on) {
  const std::vector<double> errors =
      each_of(cells, [&](double cell) { return error_on(cell, cell == drawn ? &curve : nullptr); });
  record.draw(curve);
  return errors;
}

// of(p) for each particle p; below, the greatest of them and their mass average.
template <class Run, class Of>
std::vector<double> of_particles(const Run& run, const Of& of) {
  std::vector<double> found(run.particles().size());
  for (std::size_t p = 0; p < found.size(); ++p) {
    found[p] = of(p);
  }
  return found;
}
template <class Run, class Of>
double greatest_of(const Run& run, const Of& of) {
  const std::vector<double> found = of_particles(run, of);
  return *std::max_element(found.begin(), found.end());
}
// 0 without particles.
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

// Value of the history at present.
template <class Run>
double history_value(const Run& run, const std::string& column) {
  return value_of(sim::history_row(run), column);
}

// Calls visit(pressure [Pa], x [m] in the local frame) for each node that touches the ground.
template <class Visit>
void for_contacts(const Simulation<2>& simulation, const Visit& visit) {
  const auto& contacts = simulation.nodes().contact;
  for (std::size_t b = 0; b < simulation.grid().blocks().size(); ++b) {
    for (std::size_t k = 0; contacts.contains(b) && k < contacts.nodes; ++k) {
      const auto& contact = contacts(b, k);
      if (contact[mpm::Contact::touching] > 0.0) {
        visit(contact[mpm::Contact::normal_force] / contact[mpm::Contact::area],
              mpm::node_position(simulation.grid(), b, k)[0]);
      }
    }
  }
}

// Takes steps, unless the run ends before.
template <class Run>
void take_steps(Run& run, int count, double end) {
  for (int k = 0; k < count; ++k) {
    run.step(run.next_step(end));
  }
}

// TOML of a point in a plane or in space: z is up in both.
inline std::string point_text(int dimension, double x, double y, double z) {
  return dimension == 3 ? fmt::format("[{}, {}, {}]", x, y, z) : fmt::format("[{}, {}]", x, z);
}

// TOML of vertices.
inline std::string list_of(const std::vector<Vector<double, 2>>& vertices) {
  std::string text;
  for (const auto& vertex : vertices) {
    text += fmt::format("{}[{:.9f},{:.9f}]", text.empty() ? "" : ",", vertex[0], vertex[1]);
  }
  return "[" + text + "]";
}

// profile.csv in the folder of the test, from points of x, height of the ground and, if there is a body, its surface.
inline std::string write_profile(const std::vector<std::vector<double>>& points) {
  const auto file = folder_of_this_test() / "profile.csv";
  std::ofstream csv(file);
  csv << "distance_m,terrain_elevation_m" << (points.at(0).size() == 3 ? ",surface_elevation_m\n" : "\n");
  for (const auto& point : points) {
    csv << fmt::format("{:.17g}\n", fmt::join(point, ","));
  }
  return file.string();
}

}  // namespace thawslide::verification
