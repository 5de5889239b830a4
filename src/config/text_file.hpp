// Text file as a whole.
#pragma once

#include <filesystem>
#include <string>

namespace thawslide::config {

// Throws UserError with the file, and the system's reason if available.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

}  // namespace thawslide::config
