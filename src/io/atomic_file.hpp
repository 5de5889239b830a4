// Files that are complete or absent: written under a temporary name in the same folder, then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace thawslide::io {

// previous: name under which an existing file is kept. Throws WriteError with the path and the system's reason, and
// then leaves no temporary file.
void write_file_atomically(const std::filesystem::path& file, const void* data, std::size_t bytes,
                           const std::filesystem::path& previous = {});
void write_file_atomically(const std::filesystem::path& file, std::string_view text,
                           const std::filesystem::path& previous = {});

// Creates a folder if it does not exist. Throws WriteError with the path and the system's reason.
void make_folder(const std::filesystem::path& folder);

// Copies a file whose content is given. If the file system can share the blocks until one copy changes, the copy uses
// no space. Throws as write_file_atomically.
void copy_file_atomically(const std::filesystem::path& file, const std::filesystem::path& copy,
                          std::string_view content);

// True for the name of a temporary file: .NAME.PROCESS.thawslide-part, with the number of the process. No file of a
// user has such a name, because copy_inputs refuses it.
[[nodiscard]] bool is_unfinished(const std::filesystem::path& file);

// Unused name for keeping a damaged file in its folder: NAME.damaged.EXTENSION, or with a number.
[[nodiscard]] std::filesystem::path name_for_damaged(const std::filesystem::path& file);

// Removes temporary files of killed processes. Does nothing if the folder does not exist, or is a link, whose contents
// do not belong to the run. Throws WriteError.
void remove_unfinished_files(const std::filesystem::path& folder);

// Removes a file, a link or an empty folder, if it exists. Throws WriteError with the path and the system's reason.
void remove_or_throw(const std::filesystem::path& file);

// Contents of a file. Throws UserError if it cannot be read, or is not a regular file: a pipe may block forever, and a
// device may have no end.
std::string read_file(const std::filesystem::path& file);

// Throws UserError for a folder, a pipe or a device; a missing file is accepted.
void require_regular(const std::filesystem::path& file);

}  // namespace thawslide::io
