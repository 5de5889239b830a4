// Files in a folder that belong to a run and are removed with it; other files belong to the user and are kept.
#pragma once

#include <filesystem>

namespace thawslide::io {

// True if there is a run.json written by this program. Throws UserError if it cannot be read.
[[nodiscard]] bool is_run_folder(const std::filesystem::path& folder);

// True if a process that ended before writing run.json has left its lock and no results.
[[nodiscard]] bool contains_only_a_start(const std::filesystem::path& folder);

// Copies the files of a run that a resume reads or continues into an existing empty folder, run.json last. Snapshots
// are hard links if the file system allows this, because no program changes them. Throws WriteError.
void copy_files_of_run(const std::filesystem::path& from, const std::filesystem::path& to);

// Removes such a copy. It may be incomplete, and then has no run.json that lists its inputs. Throws WriteError.
void remove_copy_of_run(const std::filesystem::path& from, const std::filesystem::path& to);

// Removes the files of a run by their names, links instead of their targets, and its folders if they are then empty. In
// inputs/, these are the copies listed in run.json. run.json is removed last, because it identifies the folder as that
// of a run. Throws WriteError.
void remove_files_of_run(const std::filesystem::path& folder);

}  // namespace thawslide::io
