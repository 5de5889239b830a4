// Reading and removing files, folders for them, and SHA-256.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace thawslide::io {

// Creates a folder if it does not exist. Throws WriteError with the path and the system's reason.
void make_folder(const std::filesystem::path& folder);

// Unused name for keeping a damaged file in its folder: NAME.damaged.EXTENSION, or with a number.
[[nodiscard]] std::filesystem::path name_for_damaged(const std::filesystem::path& file);

// Removes temporary files of killed processes, unless the folder is a link or does not exist. Throws WriteError.
void remove_unfinished_files(const std::filesystem::path& folder);

// Removes a file, a link or an empty folder, if it exists. Throws WriteError with the path and the system's reason.
void remove_or_throw(const std::filesystem::path& file);

// Contents of a file. Throws UserError if it cannot be read, or is no regular file, such as a pipe.
std::string read_file(const std::filesystem::path& file);

// Throws UserError for a folder, a pipe or a device; a missing file is accepted.
void require_regular(const std::filesystem::path& file);

// Name of this machine.
[[nodiscard]] std::string host_name();

using Digest = std::array<unsigned char, 32>;

Digest sha256(std::string_view text);
// As 64 hexadecimal digits.
std::string sha256_hex(std::string_view text);

}  // namespace thawslide::io
