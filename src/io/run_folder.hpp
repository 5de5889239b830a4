// Run folders: their creation without replacing other results, and their files; other files belong to the user.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/run_lock.hpp"

namespace thawslide::io {

// Deepest existing part of the path, in which folders would be created.
[[nodiscard]] std::filesystem::path existing_part(const std::filesystem::path& folder);

// Throws UserError if a run cannot be written there, or would replace another run (unless `overwrite`) or other files.
void require_usable(const std::filesystem::path& folder, bool overwrite);

// Throws UserError if one of these folders of a run is a link.
void require_own_folders(const std::filesystem::path& folder, const std::vector<std::string>& names);

// Creates the folder and acquires its lock. With `overwrite`, removes the files of the run in it, but no others.
RunLock make_run_folder(const std::filesystem::path& folder, bool overwrite);

}  // namespace thawslide::io
