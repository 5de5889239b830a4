// View of all particle fields for kernels on a device.
#pragma once

#include <cstdint>

#include "mpm/field_view.hpp"
#include "mpm/particle_fields.hpp"

namespace thawslide::mpm {

// Fields that are not stored must not be accessed.
template <int Dim>
struct ParticleView {
#define THAWSLIDE_FIELD(Type, Components, name, ...) FieldView<Type, Components> name;
  THAWSLIDE_PARTICLE_FIELDS(THAWSLIDE_FIELD)
#undef THAWSLIDE_FIELD
};

// Calls visit(field of a, field of b) for each field, in order. a, b: views, or particles.
template <class A, class B, class Visit>
void for_fields_of(A& a, B& b, const Visit& visit) {
#define THAWSLIDE_FIELD(Type, Components, name, ...) visit(a.name, b.name);
  THAWSLIDE_PARTICLE_FIELDS(THAWSLIDE_FIELD)
#undef THAWSLIDE_FIELD
}

// Valid until the number of particles changes.
template <int Dim, template <int> class Particles>
ParticleView<Dim> view_of(Particles<Dim>& particles) {
  ParticleView<Dim> view{};
  for_fields_of(view, particles, [](auto& of_view, auto& field) { of_view = field.view(); });
  return view;
}

}  // namespace thawslide::mpm
