// What must hold of a state that a checkpoint gave back before anything is computed with it.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/state_numbers.hpp"
#include "mpm/particles.hpp"
#include "sim/model.hpp"

namespace thawslide::sim {

// Whether a place [m] lies in the domain, or not farther beyond it than `margin` [m]. extent: the domain's upper
// corner.
template <int Dim, class Real>
bool is_about_domain(const Vector<Real, Dim>& place, const Vector<Real, Dim>& extent, Real margin) {
  for (int a = 0; a < Dim; ++a) {
    if (!(place[a] >= -margin && place[a] <= extent[a] + margin)) {
      return false;
    }
  }
  return true;
}

// All of the state's numbers have been taken; particles have a place in the domain, mass and volume, a body and a
// material of the case, and an id of their own below next_id.
template <int Dim, class Real>
void require_sound(const mpm::Particles<Dim, Real>& particles, const Model<Dim, Real>& model, std::int64_t next_id,
                   const StateNumbers& state) {
  state.expect_end();
  const auto is_number_of = [](std::int32_t number, const std::vector<std::string>& names) {
    return number >= 0 && static_cast<std::size_t>(number) < names.size();
  };
  std::int64_t before = -1;  // rows stand by id
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::int64_t id = particles.id(p);
    if (!(id > before && id < next_id)) {
      state.fail(
          fmt::format("the particle in row {} has the id {}; allowed: from {} to {}", p, id, before + 1, next_id - 1));
    }
    before = id;
    const auto place = particles.position.template get<Vector<Real, Dim>>(p);
    if (!is_about_domain<Dim, Real>(place, model.constraints.extent, Real(0))) {
      state.fail(fmt::format("particle {} lies outside the domain", id));
    }
    if (!is_number_of(particles.body(p), model.body_names) ||
        !is_number_of(particles.material(p), model.material_names)) {
      state.fail(fmt::format("particle {} has the body {} and the material {}, which the case does not have", id,
                             particles.body(p), particles.material(p)));
    }
    if (!(particles.mass(p) > Real(0) && particles.volume(p) > Real(0) && std::isfinite(particles.mass(p)) &&
          std::isfinite(particles.volume(p)))) {
      state.fail(fmt::format("particle {} has a mass of {} kg and a volume of {} m3", id, particles.mass(p),
                             particles.volume(p)));
    }
  }
}

}  // namespace thawslide::sim
