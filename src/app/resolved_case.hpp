// Resolved case of a run, with all defaults written out and copies of its inputs.
#pragma once

#include <filesystem>
#include <vector>

#include "config/case.hpp"
#include "io/provenance.hpp"

namespace thawslide::app {

// Writes case.toml and inputs/ into the folder; returns the list of inputs.
std::vector<io::InputFile> write_resolved_case(const config::Case& parameters, const std::filesystem::path& folder);

}  // namespace thawslide::app
