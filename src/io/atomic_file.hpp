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

// A copy of a file, whose content is given; where the file system can share it until one of them changes, it takes no
// room. Throws as write_file_atomically.
void copy_file_atomically(const std::filesystem::path& file, const std::filesystem::path& copy,
                          std::string_view content);

// Whether the name is that of a file beside its place, as a process writes it: .NAME.PROCESS.thawslide-part, with the
// number of that process. No file of a user is called so: copy_inputs refuses it.
[[nodiscard]] bool is_unfinished(const std::filesystem::path& file);

// A name beside a damaged file that is free to keep it under: NAME.damaged.EXTENSION, or with a number.
[[nodiscard]] std::filesystem::path name_for_damaged(const std::filesystem::path& file);

// Removes what a process that was killed while it wrote has left beside its files; nothing where there is no
// folder, or a link to one: what is there is not of this run. Throws WriteError.
void remove_unfinished_files(const std::filesystem::path& folder);

// Removes a file, a link or an empty folder, if it is there. Throws WriteError with the path and the system's reason.
void remove_or_throw(const std::filesystem::path& file);

// A whole file. Throws UserError if it cannot be read, or is no regular file: a pipe may keep a reader waiting for
// ever, and a device may have no end.
std::string read_file(const std::filesystem::path& file);

// Throws UserError where a folder, a pipe or a device stands; what is not there is no such.
void require_regular(const std::filesystem::path& file);

}  // namespace thawslide::io
