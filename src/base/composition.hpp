// Letters with marks: programs and systems write "u" with a diaeresis as one character or as two.
#pragma once

#include <filesystem>
#include <string>

namespace thawslide {

// Text with each letter and its mark as one character (Unicode Standard, Annex 15, form C) for Latin, Greek, Cyrillic
// and kana. A text that is not UTF-8 remains as it is.
[[nodiscard]] std::string composed(const std::string& text);

// The path if it exists. Otherwise an existing one whose names differ only in the composition of their letters; the
// path if there is none.
[[nodiscard]] std::filesystem::path in_any_composition(const std::filesystem::path& path);

}  // namespace thawslide
