// The folder of a run: made new, never over another's results by accident.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/run_lock.hpp"

namespace thawslide::io {

// The deepest part of the path that exists: where folders would be made.
[[nodiscard]] std::filesystem::path existing_part(const std::filesystem::path& folder);

// Throws UserError where a name of the path is longer than file systems take: before anything asks for it.
void require_possible_names(const std::filesystem::path& folder);

// Throws UserError where a run cannot go: a file of that name, a folder that holds another run (unless `overwrite`), a
// folder with other things in it, a place that cannot be written.
void require_usable(const std::filesystem::path& folder, bool overwrite);

// Throws UserError where a link stands in the place of one of these folders of a run.
void require_own_folders(const std::filesystem::path& folder, const std::vector<std::string>& names);

// Makes the folder and its parents, and takes its lock; with `overwrite` removes the files of the run it holds, and
// nothing else: not what others have put into it, or into snapshots/, inputs/, figures/ and maps/.
RunLock make_run_folder(const std::filesystem::path& folder, bool overwrite);

}  // namespace thawslide::io
