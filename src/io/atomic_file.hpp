// Files that are whole or not there: written beside their place, then renamed onto it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace thawslide::io {

// previous: what stood there before is kept under this name. Throws WriteError with the path and the system's reason;
// nothing is left behind then.
void write_file_atomically(const std::filesystem::path& file, const void* data, std::size_t bytes,
                           const std::filesystem::path& previous = {});
void write_file_atomically(const std::filesystem::path& file, std::string_view text,
                           const std::filesystem::path& previous = {});

// Makes a folder where there is none. Throws WriteError with the path and the system's reason.
void make_folder(const std::filesystem::path& folder);

// Whether the name is that of a file beside its place, as a process writes it.
[[nodiscard]] bool is_unfinished(const std::filesystem::path& file);

// Removes what a process that was killed while it wrote has left beside its files; nothing where there is no folder.
void remove_unfinished_files(const std::filesystem::path& folder);

// A whole file. Throws UserError if it cannot be read.
std::string read_file(const std::filesystem::path& file);

}  // namespace thawslide::io
