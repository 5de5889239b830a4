// The largest inputs that are taken, all of them: far above what slides need, and below what a mistake or malice may
// hand over. More is refused before it is read, or while it is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace thawslide::config {

inline constexpr double largest_case_file = 10e6;    // bytes
inline constexpr std::size_t most_case_files = 16;   // that stand on one another (case.based_on)
inline constexpr std::size_t most_key_parts = 50;    // of a dotted key: deeper tables exhaust the stack
inline constexpr double largest_table_file = 100e6;  // bytes, of a profile
inline constexpr double largest_targets_file = 1e6;  // bytes, of reported values
inline constexpr std::size_t most_profile_rows = 1000000;
inline constexpr double most_raster_points = 4e8;        // read of one raster: 20 km x 20 km at 1 m
inline constexpr std::size_t most_features = 100000;     // of a vector file
inline constexpr std::size_t most_corners = 5000000;     // of all its polygons or lines
inline constexpr std::size_t most_problems_listed = 50;  // of a case at once
inline constexpr std::size_t most_letters_quoted = 200;  // of a text that is wrong

// Throws UserError where a file has more bytes; `advice` ends the message: "Is it the right file?"
void require_size(const std::filesystem::path& file, double most_bytes, const std::string& advice);

// A text with what would steer a terminal as '?': control letters, but for those of `kept`, and marks that turn the
// direction of what is read.
[[nodiscard]] std::string printable(std::string text, std::string_view kept = "");

// A text as messages show it: without the end of a long one, and with signs that would steer a terminal as '?'.
[[nodiscard]] std::string shown(const std::string& text);

// What stands at a path where a file is wanted: "a folder", "a pipe", "a device". Empty for a file, or nothing.
[[nodiscard]] std::string what_stands_at(const std::filesystem::path& path);

// Whether a path, its links followed, lies in a folder, its own followed too.
[[nodiscard]] bool lies_within(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace thawslide::config
