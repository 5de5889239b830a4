// The case a run keeps: every default written out, its inputs beside it.
#pragma once

#include <filesystem>
#include <vector>

#include "config/case.hpp"
#include "io/provenance.hpp"

namespace thawslide::app {

// Writes case.toml and inputs/ into the folder; returns what the inputs are.
std::vector<io::InputFile> write_resolved_case(const config::Case& parameters, const std::filesystem::path& folder);

}  // namespace thawslide::app
