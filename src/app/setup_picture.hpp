// Figure of a case before it runs, plotted by thawslide-report.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace thawslide::app {

// setup.png, prefixed by the name of a variant, because several case files may share a folder.
[[nodiscard]] std::string picture_path(const std::filesystem::path& case_file);

// setup: from setup_json. Throws UserError if thawslide-report is not found, or fails.
void draw_setup(const nlohmann::ordered_json& setup, const std::string& picture);

}  // namespace thawslide::app
