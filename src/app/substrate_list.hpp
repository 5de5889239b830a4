// What `thawslide check` says of the substrates of a case.
#pragma once

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::app {

// What each covers, how it holds the slide, and what is left to [basal]. Prints nothing for a case without any.
void print_substrates(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::app
