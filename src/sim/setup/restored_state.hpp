// Validation of a state restored from a checkpoint, before it is used.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/state_numbers.hpp"
#include "mpm/particles.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

// True if a position [m] lies in the domain or within `margin` [m] of it. extent: the domain's upper corner.
template <int Dim>
bool is_about_domain(const Vector<double, Dim>& position, const Vector<double, Dim>& extent, double margin) {
  for (int a = 0; a < Dim; ++a) {
    if (!(position[a] >= -margin && position[a] <= extent[a] + margin)) {
      return false;
    }
  }
  return true;
}

// Checks that all numbers of the state were read, and that each particle has a position in the domain, mass and volume,
// a body and a material of the case, and a unique id below next_id.
template <int Dim>
void require_sound(const mpm::Particles<Dim>& particles, const Model<Dim>& model, std::int64_t next_id,
                   const StateNumbers& state) {
  state.expect_end();
  const auto is_number_of = [](std::int32_t number, const std::vector<std::string>& names) {
    return number >= 0 && static_cast<std::size_t>(number) < names.size();
  };
  std::int64_t before = -1;  // rows are sorted by id
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::int64_t id = particles.id(p);
    if (!(id > before && id < next_id)) {
      state.fail(
          fmt::format("the particle in row {} has the id {}; allowed: from {} to {}", p, id, before + 1, next_id - 1));
    }
    before = id;
    const auto position = particles.position.template get<Vector<double, Dim>>(p);
    if (!is_about_domain<Dim>(position, model.constraints.extent, 0.0)) {
      state.fail(fmt::format("particle {} lies outside the domain", id));
    }
    if (!is_number_of(particles.body(p), model.body_names) ||
        !is_number_of(particles.material(p), model.material_names)) {
      state.fail(fmt::format("particle {} has the body {} and the material {}, which the case does not have", id,
                             particles.body(p), particles.material(p)));
    }
    if (!(particles.mass(p) > 0.0 && particles.volume(p) > 0.0 && std::isfinite(particles.mass(p)) &&
          std::isfinite(particles.volume(p)))) {
      state.fail(fmt::format("particle {} has a mass of {} kg and a volume of {} m3", id, particles.mass(p),
                             particles.volume(p)));
    }
  }
}

}  // namespace thawslide::sim
