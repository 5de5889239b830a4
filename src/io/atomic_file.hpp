// Files that are whole or not there: written beside their place, then renamed onto it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace thawslide::io {

// previous: what stood there before is kept under this name. Throws UserError with the path and the system's reason;
// nothing is left behind then.
void write_file_atomically(const std::filesystem::path& file, const void* data, std::size_t bytes,
                           const std::filesystem::path& previous = {});
void write_file_atomically(const std::filesystem::path& file, std::string_view text,
                           const std::filesystem::path& previous = {});

// Removes what a process that was killed while it wrote has left beside its files.
void remove_unfinished_files(const std::filesystem::path& folder);

// A whole file. Throws UserError if it cannot be read.
std::string read_file(const std::filesystem::path& file);

}  // namespace thawslide::io
