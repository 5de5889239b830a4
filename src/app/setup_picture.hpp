// The picture of a case before it runs, which thawslide-report draws.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace thawslide::app {

// setup.png, of a variant its name before it: several case files may share a folder.
[[nodiscard]] std::string picture_path(const std::filesystem::path& case_file);

// setup: as setup_json tells it. Throws UserError where thawslide-report is not found, or fails.
void draw_setup(const nlohmann::ordered_json& setup, const std::string& picture);

}  // namespace thawslide::app
