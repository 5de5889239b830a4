// Figure of a case before it runs, plotted by thawslide-report --setup from JSON: terrain, grid, bodies, boundaries and
// frames.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/simulation.hpp"

namespace thawslide::app {

// setup.png, prefixed by the name of a variant, because several case files may share a folder.
[[nodiscard]] std::string picture_path(const std::filesystem::path& case_file);

// setup: from setup_json. Throws UserError if thawslide-report is not found, or fails.
void draw_setup(const nlohmann::ordered_json& setup, const std::string& picture);

// A map if the terrain is a DEM, otherwise a section along x. Heights of a DEM are thinned to the resolution of a
// figure.
template <int Dim>
nlohmann::ordered_json setup_json(const sim::Simulation<Dim>& simulation);

}  // namespace thawslide::app
