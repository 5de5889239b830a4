// Every field of every particle, by name and in order of id.
#pragma once

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "mpm/particles.hpp"

namespace thawslide::testing_support {

template <int Dim, class Real>
std::map<std::string, std::vector<double>> fields_by_id(const mpm::Particles<Dim, Real>& particles) {
  std::vector<std::size_t> by_id(particles.size());
  std::iota(by_id.begin(), by_id.end(), std::size_t{0});
  std::sort(by_id.begin(), by_id.end(),
            [&](std::size_t p, std::size_t q) { return particles.id(p) < particles.id(q); });
  std::map<std::string, std::vector<double>> fields;
  for (const auto* field : particles.fields.all()) {
    field->append_values(by_id, field->components(), fields[field->info().name]);
  }
  return fields;
}

}  // namespace thawslide::testing_support
