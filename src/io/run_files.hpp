// Which of the files in a folder are those of a run, and go with it; what else is there is the user's, and stays.
#pragma once

#include <filesystem>

namespace thawslide::io {

// Whether there is a run.json that this program has written. Throws UserError where it cannot be read.
[[nodiscard]] bool holds_a_run(const std::filesystem::path& folder);

// Whether a process that ended before it had written run.json has left its lock, and nothing that anyone would miss.
[[nodiscard]] bool holds_no_more_than_a_start(const std::filesystem::path& folder);

// Removes the files of a run by their names, links instead of what they lead to, and its folders where nothing else is
// in them. Of inputs/ these are the copies that run.json lists. run.json is the last: until then the folder can be told
// for that of a run. Throws WriteError.
void remove_files_of_run(const std::filesystem::path& folder);

}  // namespace thawslide::io
