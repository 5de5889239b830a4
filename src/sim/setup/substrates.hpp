// Substrates of a case and their extent.
#pragma once

#include <memory>

#include "config/case.hpp"
#include "config/site.hpp"
#include "terrain/substrates.hpp"

namespace thawslide::sim {

// Numbered from 1 in the alphabetical order of their names, relative to the domain's lower corner. Null if the case has
// none.
[[nodiscard]] std::shared_ptr<const terrain::Substrates> make_substrates(const config::Case& parameters,
                                                                         const config::Site& site);

}  // namespace thawslide::sim
