// Erodible bed of a case.
#pragma once

#include <optional>

#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/model.hpp"
#include "terrain/bed.hpp"

namespace thawslide::sim {

// Empty if the case has no bed.
template <int Dim>
std::optional<terrain::Bed<Dim>> make_bed(const config::Case& parameters, const config::Site& site,
                                          const Model<Dim>& model);

}  // namespace thawslide::sim
