// Run folders: their creation without accidentally replacing other results, and the files in them that belong to a run
// and are removed with it. Other files belong to the user and are kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/run_lock.hpp"

namespace thawslide::io {

// Deepest existing part of the path, in which folders would be created.
[[nodiscard]] std::filesystem::path existing_part(const std::filesystem::path& folder);

// Throws UserError if a run cannot be written there: a file of that name, a folder that contains another run (unless
// `overwrite`) or other files, or a location without write permission.
void require_usable(const std::filesystem::path& folder, bool overwrite);

// Throws UserError if one of these folders of a run is a link.
void require_own_folders(const std::filesystem::path& folder, const std::vector<std::string>& names);

// Creates the folder and its parents, and acquires its lock. With `overwrite`, removes the files of the run in it, but
// no files of others there or in snapshots/, inputs/, figures/ and maps/.
RunLock make_run_folder(const std::filesystem::path& folder, bool overwrite);

}  // namespace thawslide::io
