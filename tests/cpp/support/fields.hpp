// State of a run: every field of every particle, by name and in order of id, for bitwise comparison.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "mpm/particles.hpp"

namespace thawslide::testing_support {

// Without the place above the ground, which follows from the position whenever a step needs it.
template <int Dim>
std::map<std::string, std::vector<double>> fields_by_id(const mpm::Particles<Dim>& particles) {
  std::vector<std::size_t> by_id(particles.size());
  std::iota(by_id.begin(), by_id.end(), std::size_t{0});
  std::sort(by_id.begin(), by_id.end(),
            [&](std::size_t p, std::size_t q) { return particles.id(p) < particles.id(q); });
  std::map<std::string, std::vector<double>> fields;
  const std::set<std::string> of_ground{"height_above_ground", "ground_slope", "linear_slope"};
  for (const auto* field : particles.fields.all()) {
    if (of_ground.count(field->info().name) != 0) {
      continue;
    }
    field->append_values(by_id, field->components(), fields[field->info().name]);
  }
  return fields;
}

// Includes the scalars of the run.
template <class Simulation>
std::map<std::string, std::vector<double>> state_of(const Simulation& simulation) {
  auto state = fields_by_id(simulation.particles());
  state["scalars"] = simulation.scalars();
  return state;
}

// == would equate 0 and -0, and NaN would differ from itself.
inline void expect_the_same_state(const std::map<std::string, std::vector<double>>& a,
                                  const std::map<std::string, std::vector<double>>& b, const std::string& when) {
  for (const auto& [name, numbers] : a) {
    ASSERT_EQ(b.at(name).size(), numbers.size()) << name << ", " << when;
    EXPECT_EQ(std::memcmp(b.at(name).data(), numbers.data(), numbers.size() * sizeof(double)), 0)
        << name << ", " << when;
  }
}

}  // namespace thawslide::testing_support
