// The substrates of a case where they lie.
#pragma once

#include <memory>

#include "config/case.hpp"
#include "config/site.hpp"
#include "terrain/substrates.hpp"

namespace thawslide::sim {

// By number in the alphabetical order of their names, from 1, relative to the domain's lower corner. Null where the
// case has none.
[[nodiscard]] std::shared_ptr<const terrain::Substrates> make_substrates(const config::Case& parameters,
                                                                         const config::Site& site);

}  // namespace thawslide::sim
