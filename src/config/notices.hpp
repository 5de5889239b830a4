// Values of a sound case that lie outside what is usual: what a user should know before a run, and no mistake.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Each says where the value was written, what it is, what is usual and what follows.
std::vector<std::string> notices(const Case& parameters);

}  // namespace thawslide::config
