// Reading of text files, and limits of inputs: above the needs of slides, below what erroneous files could contain.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace thawslide::config {

inline constexpr double largest_case_file = 10e6;        // bytes
inline constexpr std::size_t most_key_parts = 50;        // of a dotted key: deeper tables overflow the stack
inline constexpr double largest_table_file = 100e6;      // bytes, for a profile
inline constexpr double most_raster_points = 4e8;        // read from one raster: 20 km x 20 km at 1 m
inline constexpr std::size_t most_features = 100000;     // of a vector file
inline constexpr std::size_t most_corners = 5000000;     // of all its polygons or lines
inline constexpr std::size_t most_letters_quoted = 200;  // of an invalid text

// Throws UserError if a file has more bytes; `advice` ends the message: "Is it the right file?"
void require_size(const std::filesystem::path& file, double max_bytes, const std::string& advice);

// Text of a file as a whole. Throws UserError with the file, and the system's reason if available.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

// Replaces control characters, but for those in `kept`, and marks that change the text direction by '?'.
[[nodiscard]] std::string printable(std::string text, std::string_view kept = "");

// Text in the form for messages: truncated, and with characters that would control a terminal replaced by '?'.
[[nodiscard]] std::string shown(const std::string& text);

// Names of the files in a folder with this ending, or of all entries; empty if it cannot be read.
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder, const std::string& ending);

// Kind of a path that is not a file: "a folder", "a pipe", "a device". Empty for a file, or nothing.
[[nodiscard]] std::string other_kind_of_file(const std::filesystem::path& path);

// True if a path lies in a folder, with the links of both resolved.
[[nodiscard]] bool lies_within(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace thawslide::config
