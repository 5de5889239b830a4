// Every field of every particle, by name and in order of id.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mpm/particles.hpp"

namespace thawslide::testing_support {

template <int Dim, class Real>
std::map<std::string, std::vector<double>> fields_by_id(const mpm::Particles<Dim, Real>& particles) {
  std::vector<std::size_t> by_id(particles.size());
  for (std::size_t p = 0; p < by_id.size(); ++p) {
    by_id[static_cast<std::size_t>(particles.id(p))] = p;
  }
  std::map<std::string, std::vector<double>> fields;
  for (const auto* field : particles.fields.all()) {
    field->append_values(by_id, field->components(), fields[field->info().name]);
  }
  return fields;
}

}  // namespace thawslide::testing_support
