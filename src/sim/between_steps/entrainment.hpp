// Erodible bed of a case.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/between_steps/new_particles.hpp"
#include "sim/setup/model.hpp"
#include "sim/solver/budget.hpp"
#include "sim/solver/slide.hpp"
#include "sim/solver/solver.hpp"
#include "terrain/bed.hpp"

namespace thawslide::sim {

// Empty if the case has no bed.
template <int Dim>
std::optional<terrain::Bed<Dim>> make_bed(const config::Case& parameters, const config::Site& site,
                                          const Model<Dim>& model);

// Steps between two additions of particles; each addition rebuilds the grid around the new ones.
inline constexpr std::int64_t joining_interval = 8;

// Takes loose material off the bed that joins the slide, and adds its terms to the budget. The particles of the slide
// are updated in host memory if any joins.
template <int Dim>
[[nodiscard]] std::vector<NewParticle<Dim>> loose_particles(const Setup<Dim>& setup, const Solver<Dim>& solver,
                                                            const Slide<Dim>& slide, terrain::Bed<Dim>& bed,
                                                            Budget<Dim>& budget);

}  // namespace thawslide::sim
